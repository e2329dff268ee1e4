// A cheap proof, from the condensed matrices, that a configuration is stable. It can only say yes; where it does not, the
// whole system decides. EQUATIONS.md, section 7.
#include <algorithm>
#include <optional>

#include "statics/solve/newton.hpp"

namespace counterflex {
namespace {

constexpr double smallest_pivot = 1e-13;  // of the diagonal before elimination

// The least energy of a series by a twist xi of its end and, where it leans, a turn w of its start frame:
// 1/2 (xi' K xi + 2 xi' L w + w' M w), without unit.
struct LeastEnergy {
  Matrix6 K = Matrix6::Zero();
  Matrix63 L = Matrix63::Zero();
  Matrix3 M = Matrix3::Zero();
};

// The symmetric matrix over a series' free columns and, in the last three, the turn of its start frame.
struct SymmetricPart {
  Eigen::MatrixXd A, J, C;  // C: columns by turn, where the series leans
  Matrix3 M = Matrix3::Zero();
};

SymmetricPart symmetric_part(const Series& series, const SeriesWork& work, const Units& units) {
  const auto n = static_cast<Eigen::Index>(series.free.size());
  SymmetricPart part{Eigen::MatrixXd(n, n), Eigen::MatrixXd(6, n), Eigen::MatrixXd(series.leans ? n : 0, 3)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const int c = series.free[i];
    const double scale = units.of_column(series.angular[c]);
    part.J.col(i) << work.v.col(c), work.w.col(c);
    part.J.col(i) = scale * part.J.col(i).cwiseQuotient(units.of_pose());
    if (series.leans) part.C.row(i) = scale / units.energy() * work.lean.A_w.row(c);
    for (Eigen::Index j = 0; j < n; ++j) {
      const int d = series.free[j];
      part.A(i, j) = 0.5 * scale * units.of_column(series.angular[d]) / units.energy() * (work.A(c, d) + work.A(d, c));
    }
  }
  return part;
}

// A group's branches add their least energy to its six columns, and to the columns that turn its start frame.
void add_branch(const Series& series, const Part& group, const LeastEnergy& branch, bool leans, const SeriesWork& work,
                SymmetricPart& part) {
  const auto first = std::find(series.free.begin(), series.free.end(), group.column) - series.free.begin();
  part.A.block<6, 6>(first, first) += branch.K;
  if (!leans) return;
  const Matrix3 R = work.v.middleCols<3>(group.column);
  const Matrix63 L = branch.L * R.transpose();
  const Matrix3 M = R * branch.M * R.transpose();
  for (Eigen::Index i = 0; i < first; ++i) {
    if (!series.angular[series.free[i]]) continue;
    const Vector3 w_i = work.w.col(series.free[i]);
    part.A.block<6, 1>(first, i) += L * w_i;
    part.A.block<1, 6>(i, first) += (L * w_i).transpose();
    for (Eigen::Index j = 0; j < first; ++j)
      if (series.angular[series.free[j]]) part.A(i, j) += w_i.dot(M * work.w.col(series.free[j]));
    if (series.leans) part.C.row(i) += (M * w_i).transpose();
  }
  if (!series.leans) return;
  part.C.middleRows<6>(first) += L;
  part.M += M;
}

// Whether the pivots are positive by more than the rounding of the numbers that they are the difference of.
bool above_rounding(const Eigen::LLT<Eigen::MatrixXd>& llt, const Eigen::MatrixXd& P) {
  return (llt.matrixLLT().diagonal().array().square() > smallest_pivot * P.diagonal().array()).all();
}

// The least energy of a series, if its inside is positive definite with the end held.
//     A + rho J'J > 0  =>  A > 0 on the null space of J;      K = (J (A + rho J'J)^-1 J')^-1 - rho
std::optional<LeastEnergy> least_energy(const Series& series, const SeriesWork& work, const Units& units) {
  if (series.free.empty()) return std::nullopt;  // a rigid bar
  SymmetricPart part = symmetric_part(series, work, units);
  for (const Part& group : series.parts) {
    if (group.kind != PartKind::group) continue;
    for (std::size_t b = 0; b < series.groups[group.group].branches.size(); ++b) {
      const Series& inner = series.groups[group.group].branches[b];
      const auto branch = least_energy(inner, work.groups[group.group][b], units);
      if (!branch) return std::nullopt;
      add_branch(series, group, *branch, inner.leans, work, part);
    }
  }
  const auto& [A, J, C, M] = part;
  const double rho = std::max(1.0, 10 * A.cwiseAbs().maxCoeff());
  if (rho > 1e4) return std::nullopt;  // the difference below would lose its digits
  const Eigen::MatrixXd P = A + rho * J.transpose().lazyProduct(J);
  const Eigen::LLT<Eigen::MatrixXd> llt = cholesky(P);
  if (llt.info() != Eigen::Success || !above_rounding(llt, P)) return std::nullopt;
  const Eigen::MatrixXd P_J = llt.solve(J.transpose());
  const Matrix6 compliance = J.lazyProduct(P_J);
  const Eigen::LLT<Matrix6> inverse(compliance);
  if (inverse.info() != Eigen::Success || inverse.matrixLLT().diagonal().minCoeff() < 1e-7) return std::nullopt;
  LeastEnergy least;
  const Matrix6 Z = inverse.solve(Matrix6::Identity());
  least.K = Z - rho * Matrix6::Identity();
  if (!series.leans) return least;
  const Eigen::MatrixXd P_C = llt.solve(C);
  const Matrix63 B = J * P_C;
  least.L = Z * B;
  least.M = M + B.transpose() * Z * B - C.transpose() * P_C;
  return least;
}

}  // namespace

bool surely_stable(const Mechanism& mechanism, const std::vector<SeriesWork>& works, const Matrix6& load_tangent,
                   const Units& units) {
  Matrix6 K = units.of_pose().asDiagonal() * (-0.5 * (load_tangent + load_tangent.transpose())) *
              units.of_pose().asDiagonal() / units.energy();
  for (std::size_t i = 0; i < works.size(); ++i) {
    const auto chain = least_energy(mechanism.chains[i], works[i], units);
    if (!chain) return false;
    K += chain->K;
  }
  // A margin far above the rounding of the differences that made K.
  const Eigen::LLT<Matrix6> llt(K - 1e-7 * K.cwiseAbs().maxCoeff() * Matrix6::Identity());
  return llt.info() == Eigen::Success;
}

}  // namespace counterflex
