#include "machine/definiteness.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "counterflex/geometry/spectrum.hpp"

namespace counterflex {
namespace {

/// 1/sqrt of the diagonal; 1 where it is zero.
Vector6 scaling(const Matrix6& A) {
  return A.diagonal().unaryExpr([](double a) { return a > 0 ? 1 / std::sqrt(a) : 1.0; });
}

std::optional<BadEntry> find_bad_diagonal(const Matrix6& A, bool semidefinite) {
  for (int i = 0; i < 6; ++i) {
    if (A(i, i) > 0 || (semidefinite && A(i, i) == 0)) continue;
    return BadEntry{i, i,
                    fmt::format("is {}; on the diagonal it must {}", A(i, i),
                                semidefinite ? "not be negative" : "be positive")};
  }
  return std::nullopt;
}

/// An entry larger than its two diagonals allow: A_ij² ≤ A_ii A_jj.
std::optional<BadEntry> find_large_coupling(const Matrix6& scaled, const Matrix6& A, double most) {
  for (int i = 0; i < 6; ++i)
    for (int j = i + 1; j < 6; ++j) {
      if (std::abs(scaled(i, j)) <= most && (A(i, i) > 0 || A(i, j) == 0) && (A(j, j) > 0 || A(i, j) == 0))
        continue;
      return BadEntry{
          i, j,
          fmt::format("is {}; its size must be {} {:.6g}, the geometric mean of its diagonals {} and {}",
                      A(i, j), most < 1 ? "below" : "at most", std::sqrt(A(i, i)) * std::sqrt(A(j, j)),
                      A(i, i), A(j, j))};
    }
  return std::nullopt;
}

}  // namespace

std::optional<BadEntry> find_asymmetry(const Matrix6& A) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) {
      const double difference = std::abs(A(i, j) - A(j, i));
      const double noise = 1e-9 * std::sqrt(std::abs(A(i, i))) * std::sqrt(std::abs(A(j, j)));
      if (difference <= std::max(noise, 1e-6 * std::max(std::abs(A(i, j)), std::abs(A(j, i))))) continue;
      return BadEntry{i, j,
                      fmt::format("is {}, but [{}][{}] is {}; the matrix must be symmetric to 1e-6", A(i, j),
                                  j + 1, i + 1, A(j, i))};
    }
  return std::nullopt;
}

std::optional<BadEntry> find_indefiniteness(const Matrix6& A, bool semidefinite) {
  if (const auto bad = find_bad_diagonal(A, semidefinite)) return bad;
  const Vector6 d = scaling(A);
  const Matrix6 scaled = d.asDiagonal() * A * d.asDiagonal();
  constexpr double rounding = 1e-9;
  constexpr double distinct = 1e-12;
  const double least = semidefinite ? -rounding : distinct;
  if (const auto bad = find_large_coupling(scaled, A, 1 - least)) return bad;
  // The smallest eigenvalue of the leading blocks decreases with their size. The last row of the first bad
  // block is reported.
  for (int k = 0; k < 6; ++k) {
    const double smallest = eigenvalues(scaled.topLeftCorner(k + 1, k + 1))[0];
    if (smallest >= least) continue;
    return BadEntry{
        k, k,
        fmt::format("is {}, too small for its couplings: the matrix must be positive {}, and with this "
                    "row its smallest eigenvalue is {:.3g} (unit diagonal)",
                    A(k, k), semidefinite ? "semidefinite" : "definite", smallest)};
  }
  return std::nullopt;
}

Matrix6 symmetric_inverse(const Matrix6& A) {
  const Vector6 d = scaling(A);
  const Matrix6 scaled = d.asDiagonal() * A * d.asDiagonal();
  const Matrix6 inverse = d.asDiagonal() * scaled.llt().solve(Matrix6::Identity()) * d.asDiagonal();
  return 0.5 * (inverse + inverse.transpose());
}

}  // namespace counterflex
