#include "identify/fit/least_squares.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "counterflex/files/parallel.hpp"

namespace counterflex {
namespace {

constexpr std::size_t portion = 256;  // rows whose normal matrix one thread makes at a time
constexpr double rank = 1e-13;        // of the largest eigenvalue: smaller ones are directions without rows

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

/// J' J of rows of one session, the right-hand side as the last column of J.
Eigen::MatrixXd normal_of(const std::vector<LinearRow>& rows, const std::vector<std::size_t>& used,
                          std::size_t from, std::size_t to, const std::vector<int>& unknowns,
                          Eigen::Index parameters) {
  const auto k = static_cast<Eigen::Index>(unknowns.size());
  Eigen::Index height = 0;
  for (std::size_t i = from; i < to; ++i) height += rows[used[i]].at.r.size();
  Eigen::MatrixXd J(height, k + parameters + 1);
  Eigen::Index line = 0;
  for (std::size_t at = from; at < to; ++at) {
    const LinearRow& row = rows[used[at]];
    for (Eigen::Index i = 0; i < row.at.r.size(); ++i, ++line) {
      const double factor =
          std::sqrt(row.weight) / (i < row.at.distances ? row.distance_scale : row.angle_scale);
      for (Eigen::Index u = 0; u < k; ++u)
        J(line, u) = factor * row.at.J_s(i, unknowns[static_cast<std::size_t>(u)]);
      if (parameters > 0) J.row(line).segment(k, parameters) = factor * row.at.J_p.row(i);
      J(line, k + parameters) = -factor * row.at.r[i];
    }
  }
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(J.cols(), J.cols());
  N.selfadjointView<Eigen::Lower>().rankUpdate(J.transpose());
  return Eigen::MatrixXd(N.selfadjointView<Eigen::Lower>());
}

/// The normal matrix with what is known of the session's unknowns.
Eigen::MatrixXd with_prior(Eigen::MatrixXd N, const SessionUnknowns& unknowns) {
  for (std::size_t u = 0; u < unknowns.unknowns.size(); ++u) {
    const int of = unknowns.unknowns[u];
    const auto at = static_cast<Eigen::Index>(u);
    N(at, at) += unknowns.information[of];
    N(at, N.cols() - 1) -= unknowns.information[of] * unknowns.from_prior[of];
  }
  return N;
}

/// The unknowns of a session from its normal matrix: for parameters that are held, by parameter, covariance.
SessionStep eliminate(const Eigen::MatrixXd& N, const SessionUnknowns& unknowns, double damping) {
  const auto k = static_cast<Eigen::Index>(unknowns.unknowns.size());
  const Eigen::Index n = N.cols() - k - 1;  // parameters
  SessionStep result;
  result.by_parameters.setZero(session_unknowns, n);
  result.covariance.setZero();
  if (k == 0) return result;
  Eigen::MatrixXd N_s = N.topLeftCorner(k, k), right(k, n + 1 + k);
  for (Eigen::Index u = 0; u < k; ++u)
    N_s(u, u) += damping * unknowns.information[unknowns.unknowns[static_cast<std::size_t>(u)]];
  right << N.topRightCorner(k, n + 1), Eigen::MatrixXd::Identity(k, k);
  const Eigen::MatrixXd X = pseudo_solve(N_s, right);
  for (Eigen::Index u = 0; u < k; ++u) {
    const int to = unknowns.unknowns[static_cast<std::size_t>(u)];
    result.step[to] = X(u, n);
    if (n > 0) result.by_parameters.row(to) = -X.row(u).head(n);
    for (Eigen::Index v = 0; v < k; ++v)
      result.covariance(to, unknowns.unknowns[static_cast<std::size_t>(v)]) = X(u, n + 1 + v);
  }
  return result;
}

}  // namespace

NormalMatrices normal_matrices(const std::vector<LinearRow>& rows,
                               const std::vector<SessionUnknowns>& sessions, Eigen::Index parameters,
                               const std::function<bool(std::size_t)>& is_used, int threads) {
  std::vector<std::vector<std::size_t>> used(sessions.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].weight != 0 && rows[i].at.is_found && is_used(i)) used[rows[i].session].push_back(i);
  struct Portion {
    std::size_t session, from, to;
  };
  std::vector<Portion> portions;
  for (std::size_t s = 0; s < sessions.size(); ++s)
    for (std::size_t from = 0; from < used[s].size(); from += portion)
      portions.push_back({s, from, std::min(from + portion, used[s].size())});
  std::vector<Eigen::MatrixXd> sums(portions.size());
  for_each_index(portions.size(), threads, [&](std::size_t i) {
    const auto& [session, from, to] = portions[i];
    sums[i] = normal_of(rows, used[session], from, to, sessions[session].unknowns, parameters);
  });
  NormalMatrices normal;
  for (const SessionUnknowns& session : sessions) {
    const Eigen::Index size = static_cast<Eigen::Index>(session.unknowns.size()) + parameters + 1;
    normal.push_back(Eigen::MatrixXd::Zero(size, size));
  }
  for (std::size_t i = 0; i < portions.size(); ++i) normal[portions[i].session] += sums[i];
  return normal;
}

void move(const Eigen::VectorXd& parameters, NormalMatrices& normal) {
  const Eigen::Index n = parameters.size();
  for (Eigen::MatrixXd& N : normal) N.rightCols<1>() -= N.middleCols(N.cols() - 1 - n, n) * parameters;
}

SessionStep solve_session(const Eigen::MatrixXd& normal, const SessionUnknowns& unknowns) {
  return eliminate(with_prior(normal, unknowns), unknowns, 0);
}

Eigen::MatrixXd ParameterPrior::information() const {
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < sigma.size(); ++k)
    if (sigma[k] > 0) free.push_back(k);
  const Eigen::MatrixXd among = correlation(free, free);
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(sigma.size(), sigma.size());
  const Eigen::MatrixXd inverse = among.llt().solve(Eigen::MatrixXd::Identity(among.rows(), among.cols()));
  result(free, free) = inverse;
  return result;
}

FitStep solve(const NormalMatrices& normal, const std::vector<SessionUnknowns>& sessions,
              const Eigen::VectorXd& from_prior, const ParameterPrior& known, double damping) {
  const Eigen::VectorXd& prior = known.sigma;
  const Eigen::Index n = prior.size();
  FitStep step;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n + 1);  // of the parameters in prior deviations
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(sessions[s].unknowns.size());
    Eigen::MatrixXd N = with_prior(normal[s], sessions[s]);
    N.middleCols(k, n) *= prior.asDiagonal();
    N.middleRows(k, n) = prior.asDiagonal() * N.middleRows(k, n);
    step.sessions.push_back(eliminate(N, sessions[s], damping));
    all += N.block(k, k, n, n + 1);
    for (Eigen::Index u = 0; u < k; ++u) {
      const int of = sessions[s].unknowns[static_cast<std::size_t>(u)];
      all.leftCols(n) += N.block(k, u, n, 1) * step.sessions[s].by_parameters.row(of);
      all.col(n) -= N.block(k, u, n, 1) * step.sessions[s].step[of];
    }
  }
  const Eigen::VectorXd to_scaled = prior.unaryExpr([](double p) { return p > 0 ? 1 / p : 0.0; });
  const Eigen::MatrixXd information = known.information();
  all.leftCols(n) += information;
  all.diagonal().array() += damping;
  all.col(n) -= information * from_prior.cwiseProduct(to_scaled);
  // No eigenvalue is below the least of the prior's information, that of a direction that no row determines.
  const Eigen::LLT<Eigen::MatrixXd> factor(all.leftCols(n));
  const Eigen::VectorXd scaled = factor.solve(all.col(n));
  step.parameters = scaled.cwiseProduct(prior);
  step.covariance = prior.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(n, n)) * prior.asDiagonal();
  for (SessionStep& session : step.sessions) {
    session.step += session.by_parameters * scaled;
    session.by_parameters = session.by_parameters * to_scaled.asDiagonal();
  }
  return step;
}

}  // namespace counterflex
