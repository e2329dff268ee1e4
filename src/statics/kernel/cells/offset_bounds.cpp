#include "statics/kernel/cells/offset_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/types.hpp"

namespace counterflex::kernel {
namespace {

enum Group { position, turn, load };

Group group_of(int variable, const Variables& variables) {
  return variable < 3 ? position : variable < variables.first_load() ? turn : load;
}

/// What a variable is multiplied with to be m, rad or N.
double unit_of(int variable, const Variables& variables, double length) {
  return variable >= variables.first_load() + 3 ? length : 1;
}

/// Bounds of the second derivatives of one component in a cell: the centre's, and by how much third
/// derivatives change them.
Eigen::MatrixXd second_derivatives(const StartCell& cell, int row, double half_edge, double largest_load,
                                   double length) {
  const Variables& variables = cell.variables;
  const int n = variables.count();
  const auto extent = [&](int k) {
    return group_of(k, variables) == position ? half_edge
           : group_of(k, variables) == turn   ? 0
                                              : largest_load / unit_of(k, variables, length);
  };
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  const std::vector<Term>& terms = cell.offset_changes.terms;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const auto [i, j, k] = terms[t].of;
    const double size = std::abs(cell.offset_changes.coefficient(0, t, row));
    if (j == no_variable) continue;
    if (k == no_variable) {
      D(i, j) += size * (i == j ? 2 : 1);
      if (i != j) D(j, i) += size;
      continue;
    }
    // x_i x_j x_k has three factors, each of which is the one that is not differentiated by.
    for (const auto& [a, b, c] : {std::array{i, j, k}, std::array{j, k, i}, std::array{k, i, j}}) {
      D(a, b) += size * extent(c);
      D(b, a) += size * extent(c);
    }
  }
  return D;
}

}  // namespace

OffsetBounds offset_bounds(const StartCell& cell, double half_edge, double load, double length) {
  const Variables& variables = cell.variables;
  const int n = variables.count();
  OffsetBounds bounds;
  bounds.half_edge = half_edge, bounds.load = load;
  for (int row = 0; row < 6; ++row) {
    const Eigen::MatrixXd D = second_derivatives(cell, row, half_edge, load, length);
    auto& first = at(bounds.first, row / 3);
    auto& second = at(bounds.second, row / 3);
    const std::vector<Term>& terms = cell.offset_changes.terms;
    for (std::size_t t = 0; t < terms.size(); ++t)
      if (const int i = terms[t].of[0]; terms[t].of[1] == no_variable)
        first[static_cast<std::size_t>(group_of(i, variables))] +=
            std::pow(cell.offset_changes.coefficient(0, t, row) * unit_of(i, variables, length), 2);
    for (int i = 0; i < n; ++i) {
      const auto v = static_cast<std::size_t>(group_of(i, variables));
      for (int j = 0; j < n; ++j)
        second[v][static_cast<std::size_t>(group_of(j, variables))] +=
            std::pow(D(i, j) * unit_of(i, variables, length) * unit_of(j, variables, length), 2);
    }
  }
  for (auto& first : bounds.first)
    for (double& x : first) x = std::sqrt(x);
  for (auto& second : bounds.second)
    for (auto& of : second)
      for (double& x : of) x = std::sqrt(x);
  return bounds;
}

//     |o(u) - (1 - u) o(0) - u o(1)| <= |D2 o| |step|^2 / 8 + |D_F o| kink + what the remainder bends
ChordBounds chord_bounds(const OffsetBounds& bounds, const LineSizes& line) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (bounds.remainder[0] == infinity) return {infinity, infinity};
  const double excess = std::max(1.0, line.load / bounds.load);
  // The first derivatives anywhere in the cell, under the load.
  const auto first = [&](int r, int v) {
    const auto& second = at(at(bounds.second, r), v);
    return at(at(bounds.first, r), v) +
           excess * (std::sqrt(3.0) * bounds.half_edge * second[position] + line.load * second[load]);
  };
  const double turn_follows = 1 - first(1, turn);
  if (!(turn_follows > 0)) return {infinity, infinity};
  const std::array<double, 3> step{
      line.way, (first(1, position) * line.way + first(1, load) * line.load_change) / turn_follows,
      line.load_change};
  // A polynomial of fourth order that is at most 1 over a half edge bends by at most 80 (Markov); in one cell
  // it is never further than 2 off its chord.
  const double share = line.way / bounds.half_edge + (line.load_change + line.kink) / bounds.load;
  const double missed = std::pow(excess, 3) * std::min(line.crosses ? infinity : 2.0, 10 * share * share);
  std::array<double, 2> off{};
  for (int r = 0; r < 2; ++r) {
    double curved = 0;
    for (int v = 0; v < 3; ++v)
      for (int w = 0; w < 3; ++w) curved += at(at(at(bounds.second, r), v), w) * at(step, v) * at(step, w);
    at(off, r) = excess * curved / 8 + first(r, load) * line.kink + missed * at(bounds.remainder, r);
  }
  const double by_turn = first(0, turn) / turn_follows;
  const double follows = 1 - first(0, position) - by_turn * first(1, position);
  if (!(follows > 0)) return {infinity, infinity};
  return {off[0] + by_turn * off[1], 1 / follows};
}

}  // namespace counterflex::kernel
