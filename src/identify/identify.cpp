#include "counterflex/identify/identify.hpp"

#include <Eigen/Cholesky>

#include "identify/candidates.hpp"
#include "identify/checks.hpp"
#include "identify/fit/fit.hpp"
#include "identify/fit/frames.hpp"
#include "identify/ladder.hpp"
#include "identify/result.hpp"

namespace counterflex {
namespace {

std::vector<SessionFrames> first_frames(const FitProblem& problem, const std::vector<Response>& found) {
  std::vector<SessionFrames> frames;
  for (std::size_t s = 0; s < problem.measurements.sessions.size(); ++s) {
    std::vector<const Measurement*> rows;
    std::vector<Pose> X_MT;
    for (std::size_t i = 0; i < problem.measurements.rows.size(); ++i) {
      const Measurement& row = problem.measurements.rows[i];
      const Response& at = found[problem.states.first[i]];
      if (row.session != s || at.status != Status::converged) continue;
      rows.push_back(&row);
      X_MT.push_back(at.X_MT);
    }
    if (!rows.empty()) check_units(problem.measurements.sessions[s], rows, X_MT);
    frames.push_back(rows.empty() ? SessionFrames{}
                                  : first_frames(problem.measurements.sessions[s], rows, X_MT));
  }
  return frames;
}

}  // namespace

bool is_covariance(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd variances = matrix.diagonal();
  if (!(variances.array() > 0).all() || !matrix.isApprox(matrix.transpose(), 1e-9)) return false;
  const Eigen::VectorXd scale = variances.cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * matrix * scale.asDiagonal());
  return factor.info() == Eigen::Success;
}

Identification identify(const Machine& machine, const Measurements& measurements,
                        const IdentifyOptions& options) {
  check_sessions(measurements);
  const States states = nominal_states(machine, measurements, options.threads);
  const Candidates candidate = candidates(machine, measurements, options.sets, options.prior);
  if (candidate.varied.empty())
    throw InputError(ErrorKind::machine_or_force, {},
                     "the machine file has no parameter of the sets to fit; add error slots or compliances");
  const FitProblem problem{
      machine,          measurements,    states,          states.X_MT,           candidate.varied,
      candidate.before, candidate.prior, candidate.least, candidate.correlation, options.threads};
  std::vector<Configuration> loaded;
  const std::vector<SessionFrames> frames =
      first_frames(problem, responses(machine, candidate.varied, states, options.threads, loaded));
  const Fit all = fit(problem, frames);

  Identification result;
  std::vector<ParameterSet> kept = options.sets;
  const Ladder ladder(problem, candidate, all, hold_out_groups(problem, options.hold_out));
  const bool has_groups = !ladder.groups().empty();
  if (has_groups && options.ladder) kept = climb(ladder, measurements, options.sets, result.ladder);
  if (has_groups) result.held_out = held_out(ladder, measurements, kept);

  FitProblem last = problem;
  last.prior = prior_of(candidate, kept);
  const Fit final_fit = kept.size() == options.sets.size() ? all : fit(last, frames);
  Eigen::MatrixXd covariance = final_fit.covariance;
  if (has_groups) widen_by_groups(ladder, kept, covariance);
  result.iterations = final_fit.iterations;
  result.is_converged = final_fit.is_converged;
  result.repeatability = repeatability_of(measurements);
  fill_parameters(machine, candidate, final_fit, last.prior, covariance, result);
  fill_rows(problem, final_fit, result);
  return result;
}

}  // namespace counterflex
