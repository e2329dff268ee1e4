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

// Bounds of one condensed series: norm of the inverse of everything inside it, and of what its end's motion does to it.
struct Bounds {
  double matrix = 1, inverse = 0, sensitivity = 0;
};

//     M = [ B  C ; C'  D ], S the Schur complement of B:    |M^-1| <= |B^-1| + (1 + |B^-1 C|)^2 |S^-1|
Bounds bounds(const Series& series, const SeriesWork& work, const Units& units) {
  Bounds inner;
  for (std::size_t g = 0; g < series.groups.size(); ++g)
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b) {
      const Bounds branch = bounds(series.groups[g].branches[b], work.groups[g][b], units);
      inner.matrix = std::max(inner.matrix, branch.matrix);
      inner.inverse = std::max(inner.inverse, branch.inverse);
      inner.sensitivity = std::max(inner.sensitivity, branch.sensitivity);
    }
  const double spread = 1 + inner.sensitivity;
  Bounds result;
  result.matrix = std::max(inner.matrix, work.bordered.norm()) + 1;
  result.inverse = inner.inverse + spread * spread * work.lu.inverse().norm();
  result.sensitivity = spread * (work.solution.middleCols<6>(1) * units.of_pose().asDiagonal()).norm();
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
  Bounds inner;
  Matrix6 K = -load_tangent;
  for (std::size_t i = 0; i < works.size(); ++i) {
    if (!condense(mechanism.chains[i], units, false, works[i])) return false;
    const Bounds chain = bounds(mechanism.chains[i], works[i], units);
    inner.matrix = std::max(inner.matrix, chain.matrix);
    inner.inverse = std::max(inner.inverse, chain.inverse);
    inner.sensitivity = std::max(inner.sensitivity, chain.sensitivity);
    K += works[i].K;
  }
  K = units.of_pose().asDiagonal() * K * units.of_pose().asDiagonal() / units.energy();
  const double spread = 1 + inner.sensitivity;
  const double bound = inner.inverse + spread * spread * Matrix6(K.inverse()).norm();
  return std::isfinite(bound) && bound * (inner.matrix + static_cast<double>(works.size())) < limit;
}

}  // namespace counterflex
