// Cheap proofs, from the condensed matrices, that a configuration is stable and well conditioned. They can only say yes;
// where they do not, the whole system decides. EQUATIONS.md, section 7.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "newton.hpp"

namespace counterflex {
namespace {

// Symmetric stiffness of a series at its end, if its inside is positive definite with the end held.
//     A + rho J'J > 0  =>  A > 0 on the null space of J;      K = (J (A + rho J'J)^-1 J')^-1 - rho
std::optional<Matrix6> symmetric_end_stiffness(const Series& series, const SeriesWork& work, const Units& units) {
  const auto n = static_cast<Eigen::Index>(series.free.size());
  if (n == 0) return std::nullopt;  // a rigid bar
  Eigen::MatrixXd A(n, n), J(6, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int c = series.free[i];
    const double scale = units.of_column(series.angular[c]);
    J.col(i) << work.v.col(c), work.w.col(c);
    J.col(i) = scale * J.col(i).cwiseQuotient(units.of_pose());
    for (Eigen::Index j = 0; j < n; ++j) {
      const int d = series.free[j];
      A(i, j) = 0.5 * scale * units.of_column(series.angular[d]) / units.energy() * (work.A(c, d) + work.A(d, c));
    }
  }
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto first = std::find(series.free.begin(), series.free.end(), part.column) - series.free.begin();
    for (std::size_t b = 0; b < series.groups[part.group].branches.size(); ++b) {
      const auto K = symmetric_end_stiffness(series.groups[part.group].branches[b], work.groups[part.group][b], units);
      if (!K) return std::nullopt;
      A.block<6, 6>(first, first) += *K;
    }
  }
  const double rho = std::max(1.0, 10 * A.cwiseAbs().maxCoeff());
  if (rho > 1e4) return std::nullopt;  // the difference below would lose its digits
  const Eigen::LLT<Eigen::MatrixXd> llt(A + rho * J.transpose() * J);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const Matrix6 compliance = J * llt.solve(J.transpose());
  const Eigen::LLT<Matrix6> inverse(compliance);
  if (inverse.info() != Eigen::Success || inverse.matrixLLT().diagonal().minCoeff() < 1e-7) return std::nullopt;
  return Matrix6(inverse.solve(Matrix6::Identity()) - rho * Matrix6::Identity());
}

// Bounds of one condensed series: norms of everything inside it and of its inverse; and R'R, where R is what its end's
// motion does to everything inside it.
struct Bounds {
  double matrix = 1, inverse = 0;
  Matrix6 response = Matrix6::Zero();

  void add(const Bounds& other) {
    matrix = std::max(matrix, other.matrix);
    inverse = std::max(inverse, other.inverse);
    response += other.response;
  }
};

Matrix6 in_units(const Matrix6& K, const Units& units) {
  return units.of_pose().asDiagonal() * K * units.of_pose().asDiagonal() / units.energy();
}

Matrix6 response_factor(const Matrix6& response) { return Matrix6(Matrix6::Identity() + response).llt().matrixL(); }

//     M = [ B  C ; C'  D ], S the Schur complement of B:    M^-1 = [ B^-1  0 ; 0  0 ] + Z S^-1 Z',   Z = [ -B^-1 C ; I ]
//
// B is what lies inside groups, Z moves with their six rows, Z'Z = I + response there, = L L':   |Z S^-1 Z'| = |L' S^-1 L|.
Bounds bounds(const Series& series, const SeriesWork& work, const Units& units) {
  Bounds result;
  const Eigen::MatrixXd end = work.solution.middleCols<6>(1) * units.of_pose().asDiagonal();
  Matrix6 response = end.transpose() * end;
  Eigen::MatrixXd inverse = work.lu.inverse();
  double matrix = work.bordered.norm();
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group) continue;
    const auto first = 6 + (std::find(series.free.begin(), series.free.end(), part.column) - series.free.begin());
    Bounds inside;
    for (std::size_t b = 0; b < series.groups[part.group].branches.size(); ++b) {
      const SeriesWork& branch = work.groups[part.group][b];
      inside.add(bounds(series.groups[part.group].branches[b], branch, units));
      matrix += 1 + in_units(branch.K, units).norm();  // what condensing has put into the bordered matrix
    }
    const Matrix6 L = response_factor(inside.response);
    inverse.middleRows<6>(first) = (L.transpose() * inverse.middleRows<6>(first)).eval();
    inverse.middleCols<6>(first) = (inverse.middleCols<6>(first) * L).eval();
    response += end.middleRows<6>(first).transpose() * inside.response * end.middleRows<6>(first);
    inside.response.setZero();
    result.add(inside);
  }
  result.matrix = std::max(result.matrix, matrix) + 1;
  result.inverse += inverse.norm();
  result.response = response;
  return result;
}

}  // namespace

bool surely_stable(const Mechanism& mechanism, const std::vector<SeriesWork>& works, const Matrix6& load_tangent,
                   const Units& units) {
  Matrix6 K = units.of_pose().asDiagonal() * (-0.5 * (load_tangent + load_tangent.transpose())) *
              units.of_pose().asDiagonal() / units.energy();
  for (std::size_t i = 0; i < works.size(); ++i) {
    const auto K_chain = symmetric_end_stiffness(mechanism.chains[i], works[i], units);
    if (!K_chain) return false;
    K += *K_chain;
  }
  // A margin far above the rounding of the differences that made K.
  const Eigen::LLT<Matrix6> llt(K - 1e-7 * K.cwiseAbs().maxCoeff() * Matrix6::Identity());
  return llt.info() == Eigen::Success;
}

bool surely_well_conditioned(const Mechanism& mechanism, std::vector<SeriesWork>& works, const Matrix6& load_tangent,
                             const Units& units, double limit) {
  Bounds inside;
  Matrix6 K = -load_tangent;
  const double platform = in_units(load_tangent, units).norm();
  for (std::size_t i = 0; i < works.size(); ++i) {
    if (!condense(mechanism.chains[i], units, false, works[i])) return false;
    inside.add(bounds(mechanism.chains[i], works[i], units));
    K += works[i].K;
  }
  const Matrix6 L = response_factor(inside.response);
  const double bound = inside.inverse + Matrix6(L.transpose() * in_units(K, units).inverse() * L).norm();
  return std::isfinite(bound) && bound * (inside.matrix + platform + static_cast<double>(works.size())) < limit;
}

}  // namespace counterflex
