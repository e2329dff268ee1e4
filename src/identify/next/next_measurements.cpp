#include "counterflex/identify/next_measurements.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "counterflex/machine/parameters.hpp"
#include "identify/fit/residuals.hpp"

namespace counterflex {
namespace {

/// Places of the program, the same without force, then candidates, as rows that have tangents.
Measurements rows_of(const std::vector<ProgramPlace>& program,
                     const std::vector<NextMeasurement>& candidates) {
  Measurements all;
  all.sessions.push_back({"program", MeasurementKind::tracker_point, true, Pose{}});
  for (const bool is_loaded : {true, false})
    for (const ProgramPlace& place : program) {
      Measurement row;
      row.states = {place.state};
      if (!is_loaded) row.states[0].F.setZero();
      row.sigma = 1;
      all.rows.push_back(std::move(row));
    }
  for (const NextMeasurement& candidate : candidates) {
    all.sessions.push_back({"candidate", candidate.kind, true, Pose{}});
    all.rows.push_back(candidate.row);
    all.rows.back().session = all.sessions.size() - 1;
  }
  return all;
}

/// What a row with tangents H takes from C.
Eigen::MatrixXd gain(const Eigen::MatrixXd& C, const Eigen::MatrixXd& H) {
  const Eigen::MatrixXd HC = H * C;
  const Eigen::MatrixXd S = Eigen::MatrixXd::Identity(H.rows(), H.rows()) + HC * H.transpose();
  return HC.transpose() * S.llt().solve(HC);
}

}  // namespace

ProgramUncertainty next_measurements(const Machine& machine, const KnownParameters& known,
                                     const std::vector<ProgramPlace>& program,
                                     std::vector<NextMeasurement> candidates, int count, int threads) {
  const std::vector<std::size_t> varied = parameter_indices(machine, known.names);
  const Measurements rows = rows_of(program, candidates);
  const States states = nominal_states(machine, rows, threads);
  std::vector<Configuration> loaded;
  const std::vector<Response> at = responses(machine, varied, states, threads, loaded);
  std::vector<RowResidual> found;
  for (std::size_t i = 0; i < rows.rows.size(); ++i)
    found.push_back(residual(rows.rows[i], rows.sessions[rows.rows[i].session].kind, {}, &at[states.first[i]],
                             &states.X_MT[states.first[i]]));
  // The mean variance is the trace of C times M. Touching off removes the mean of the unloaded deviations.
  const Eigen::Index n = known.covariance.rows();
  Eigen::MatrixXd touched = Eigen::MatrixXd::Zero(3, n), M = Eigen::MatrixXd::Zero(n, n);
  double weight = 0;
  const auto is_found = [&](std::size_t k) {
    return found[k].is_found && found[program.size() + k].is_found;
  };
  for (std::size_t k = 0; k < program.size(); ++k) {
    if (!is_found(k)) continue;
    touched += program[k].weight * found[program.size() + k].J_p;
    weight += program[k].weight;
  }
  if (weight > 0) touched /= weight;
  for (std::size_t k = 0; k < program.size(); ++k) {
    if (!is_found(k)) continue;
    const Eigen::MatrixXd J = found[k].J_p - touched;
    M += program[k].weight / weight * J.transpose() * J;
  }
  Eigen::MatrixXd C = known.covariance;
  const auto variance = [&](const Eigen::MatrixXd& of) { return of.cwiseProduct(M).sum(); };
  ProgramUncertainty result{"", std::sqrt(std::max(variance(C), 0.0)), {}};
  constexpr double same = 1e-9;  // of equal candidates the first one is chosen
  for (int step = 0; step < count; ++step) {
    double most = 0;
    std::size_t best = candidates.size();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const RowResidual& row = found[2 * program.size() + i];
      if (!row.is_found) continue;
      const double less = variance(gain(C, row.J_p));
      if (!(less > (1 + same) * most)) continue;
      most = less;
      best = i;
    }
    if (best == candidates.size()) break;  // no row shows a parameter that matters
    C -= gain(C, found[2 * program.size() + best].J_p);
    result.next.push_back(candidates[best]);
    result.next.back().sigma_after = std::sqrt(std::max(variance(C), 0.0));
  }
  return result;
}

}  // namespace counterflex
