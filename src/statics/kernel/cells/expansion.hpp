#pragma once
/// Functions near a point as polynomials of a few variables. EQUATIONS.md, section 11, "Starts".
#include <vector>

#include "statics/kernel/equations/spatial.hpp"

namespace counterflex::kernel {

/// What a solution is a function of: the position of the tip (m), its rotation vector against the centre
/// (rad) and the load (N, N m).
struct Variables {
  bool turns = false;  ///< the rotation vector is a variable: the machine controls an orientation
  bool loads = false;  ///< the load is one

  constexpr int count() const { return 3 + (turns ? 3 : 0) + (loads ? 6 : 0); }
  constexpr int first_load() const { return turns ? 6 : 3; }
  bool is_position(int variable) const { return variable < 3; }
  bool is_load(int variable) const { return variable >= first_load(); }
  bool is_turn(int variable) const { return !is_position(variable) && !is_load(variable); }
};

inline constexpr int most_variables = Variables{true, true}.count();
inline constexpr int most_terms =
    most_variables + most_variables * (most_variables + 1) / 2 + 3 * most_variables + 1 + 3 * 6;
inline constexpr int no_variable = most_variables;  ///< a factor of 1

/// A product of up to three variables.
struct Term {
  int number = 0;  ///< among all terms
  int of[3]{no_variable, no_variable, no_variable};
};

/// All terms: x_i; x_i x_j, j >= i; x_i^2 x_j, i a position; x y z; of two positions and a load.
inline std::vector<Term> terms_of(const Variables& variables) {
  std::vector<Term> terms;
  const auto add = [&](int i, int j = no_variable, int k = no_variable) {
    terms.push_back({static_cast<int>(terms.size()), {i, j, k}});
  };
  const int n = variables.count();
  for (int i = 0; i < n; ++i) add(i);
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) add(i, j);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < n; ++j) add(i, i, j);
  add(0, 1, 2);
  for (int k = variables.first_load(); k < n; ++k) add(0, 1, k), add(0, 2, k), add(1, 2, k);
  return terms;
}

/// A point of polynomials, and the factor 1.
template <class T>
struct Point {
  T x[most_variables + 1]{};
  Point() { x[no_variable] += 1.0; }
  COUNTERFLEX_INLINE T& operator[](int i) { return x[i]; }
  COUNTERFLEX_INLINE T value_of(const Term& term) const {
    return x[term.of[0]] * x[term.of[1]] * x[term.of[2]];
  }
};

/// Values are computed six at a time.
inline constexpr int block = 6;

template <class T>
struct Block {
  T value[block];
};

/// The load at a place. Terms with a load, or with a moment, are zero without it.
enum class Acting { nothing, force, moment };  ///< a moment: with a force or without

/// Polynomials in blocks of six, of the same terms.
struct Polynomials {
  std::vector<Term> terms;           ///< those without a load first, those with a moment last
  std::vector<double> coefficients;  ///< by block and term, six numbers

  std::size_t unloaded = 0, without_moment = 0;  ///< how many terms have no load, and no moment

  /// How many of the terms may differ from zero.
  std::size_t count(Acting acting) const {
    return acting == Acting::nothing ? unloaded : acting == Acting::force ? without_moment : terms.size();
  }
  double coefficient(int block_number, std::size_t term, int row) const {
    return coefficients[block * (static_cast<std::size_t>(block_number) * terms.size() + term) +
                        static_cast<std::size_t>(row)];
  }
};

}  // namespace counterflex::kernel
