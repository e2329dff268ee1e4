#pragma once
/// Functions near a point as polynomials of a few variables. EQUATIONS.md, section 11, "Starts".
#include "spatial.hpp"

namespace counterflex::kernel {

/// What a solution is a function of: the position of the tip (m), its rotation vector against the centre (rad) and
/// the load (N, N m).
struct Variables {
  bool turns = false;  ///< the rotation vector is a variable: the machine controls an orientation
  bool loads = false;  ///< the load is one

  constexpr int count() const { return 3 + (turns ? 3 : 0) + (loads ? 6 : 0); }
  constexpr int first_load() const { return turns ? 6 : 3; }
  /// The variables, and their products in pairs: of a start.
  constexpr int start_terms() const { return count() + count() * (count() + 1) / 2; }
  /// And the products of a squared position with each variable.
  constexpr int terms() const { return start_terms() + 3 * count(); }
};

inline constexpr int most_variables = Variables{true, true}.count();
inline constexpr int most_terms = Variables{true, true}.terms();
inline constexpr int most_start_terms = Variables{true, true}.start_terms();

/// The terms of a start at x: x_i; x_i x_j, j >= i. Returns the end.
template <class T>
COUNTERFLEX_INLINE T* fill_start_terms(int variables, const T* x, T* terms) {
  for (int i = 0; i < variables; ++i) *terms++ = x[i];
  for (int i = 0; i < variables; ++i)
    for (int j = i; j < variables; ++j) *terms++ = x[i] * x[j];
  return terms;
}

/// All terms at x: those of a start; x_i^2 x_j, i a position.
inline void fill_terms(int variables, const double* x, double* terms) {
  terms = fill_start_terms(variables, x, terms);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < variables; ++j) *terms++ = x[i] * x[i] * x[j];
}

/// Values are computed six at a time. The coefficients of six values: by term, six numbers.
inline constexpr int block = 6;

template <class T>
struct Block {
  T value[block];
};

/// Six values: `number(i)` is coefficient i in every lane.
template <class T, class Number>
COUNTERFLEX_INLINE Block<T> sum_terms(int terms, const T* x, const Number& number) {
  Block<T> sum{};
  for (int k = 0; k < terms; ++k) {
    COUNTERFLEX_UNROLL
    for (int i = 0; i < block; ++i) sum.value[i] += number(block * k + i) * x[k];
  }
  return sum;
}

}  // namespace counterflex::kernel
