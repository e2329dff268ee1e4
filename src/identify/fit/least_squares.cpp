#include "identify/fit/least_squares.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace counterflex {
namespace {

constexpr Eigen::Index portion = 256;  // rows that are added at a time
constexpr double rank = 1e-13;         // of the largest eigenvalue: smaller ones are directions without rows

/// J' J of rows that come one behind the other, the right-hand side as the last column of J.
class NormalMatrix {
 public:
  explicit NormalMatrix(Eigen::Index columns)
      : rows_(portion, columns), sum_(Eigen::MatrixXd::Zero(columns, columns)) {}

  /// A row to be filled.
  Eigen::Block<Eigen::MatrixXd, 1, Eigen::Dynamic> add() {
    if (used_ == portion) reduce();
    return rows_.row(used_++);
  }

  Eigen::MatrixXd sum() {
    reduce();
    return Eigen::MatrixXd(sum_.selfadjointView<Eigen::Lower>());
  }

 private:
  void reduce() {
    if (used_ == 0) return;  // of a session that is held out
    sum_.selfadjointView<Eigen::Lower>().rankUpdate(rows_.topRows(used_).transpose());
    used_ = 0;
  }

  Eigen::Index used_ = 0;
  Eigen::MatrixXd rows_, sum_;
};

/// The unknowns of one session as a function of the parameters: x = x_0 - X dp.
struct Eliminated {
  std::vector<int> unknowns;
  Eigen::VectorXd x_0;
  Eigen::MatrixXd X;
};

/// N^+ B; N symmetric. A frame's columns have different units: each is scaled to its own length.
Eigen::MatrixXd pseudo_solve(const Eigen::MatrixXd& N, const Eigen::MatrixXd& B) {
  const Eigen::VectorXd scale = N.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * N * scale.asDiagonal());
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double least = rank * values[values.size() - 1];
  const Eigen::VectorXd inverse = values.unaryExpr([&](double v) { return v > least ? 1 / v : 0.0; });
  const Eigen::MatrixXd scaled = eigen.eigenvectors().transpose() * (scale.asDiagonal() * B);
  return scale.asDiagonal() * (eigen.eigenvectors() * (inverse.asDiagonal() * scaled));
}

}  // namespace

WeightedRow weighted(const LinearRow& row) {
  const Eigen::Index n = row.at.r.size();
  Eigen::VectorXd factor(n);
  for (Eigen::Index i = 0; i < n; ++i)
    factor[i] = std::sqrt(row.weight) / (i < row.at.distances ? row.distance_scale : row.angle_scale);
  return {factor.asDiagonal() * row.at.r, factor.asDiagonal() * row.at.J_p, factor.asDiagonal() * row.at.J_s};
}

FitStep solve_rows(const std::vector<LinearRow>& rows, const std::vector<MeasurementKind>& kinds,
                   const Eigen::VectorXd& from_prior, const Eigen::VectorXd& prior) {
  const Eigen::Index n = prior.size();
  std::vector<Eliminated> sessions(kinds.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n + 1);  // of the parameters in prior deviations
  for (std::size_t s = 0; s < kinds.size(); ++s) {
    std::vector<int>& unknowns = sessions[s].unknowns;
    unknowns = unknowns_of(kinds[s]);
    const auto k = static_cast<Eigen::Index>(unknowns.size());
    NormalMatrix normal(k + n + 1);
    for (const LinearRow& row : rows) {
      if (row.session != s || row.weight == 0 || !row.at.is_found) continue;
      const WeightedRow w = weighted(row);
      for (Eigen::Index i = 0; i < w.r.size(); ++i) {
        auto line = normal.add();
        for (Eigen::Index u = 0; u < k; ++u) line[u] = w.J_s(i, unknowns[static_cast<std::size_t>(u)]);
        line.segment(k, n) = w.J_p.row(i).cwiseProduct(prior.transpose());
        line[k + n] = -w.r[i];
      }
    }
    const Eigen::MatrixXd N = normal.sum();
    all += N.block(k, k, n, n + 1);
    if (k == 0) continue;
    const Eigen::MatrixXd X = pseudo_solve(N.topLeftCorner(k, k), N.topRightCorner(k, n + 1));
    all -= N.block(k, 0, n, k) * X;
    sessions[s].x_0 = X.col(n);
    sessions[s].X = X.leftCols(n);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    all(i, i) += 1;
    if (prior[i] > 0) all(i, n) -= from_prior[i] / prior[i];
  }
  // No eigenvalue is below 1, that of a direction that no row determines.
  const Eigen::LLT<Eigen::MatrixXd> factor(all.leftCols(n));
  FitStep step;
  const Eigen::VectorXd scaled = factor.solve(all.col(n));
  step.parameters = scaled.cwiseProduct(prior);
  step.covariance = prior.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(n, n)) * prior.asDiagonal();
  for (const Eliminated& session : sessions) {
    Eigen::Matrix<double, session_unknowns, 1> ds = Eigen::Matrix<double, session_unknowns, 1>::Zero();
    if (!session.unknowns.empty()) {
      const Eigen::VectorXd x = session.x_0 - session.X * scaled;
      for (std::size_t u = 0; u < session.unknowns.size(); ++u)
        ds[session.unknowns[u]] = x[static_cast<Eigen::Index>(u)];
    }
    step.sessions.push_back(ds);
  }
  return step;
}

}  // namespace counterflex
