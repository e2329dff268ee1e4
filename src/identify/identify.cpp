#include "counterflex/identify/identify.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>

#include "identify/candidates.hpp"
#include "identify/checks.hpp"
#include "identify/fit/fit.hpp"
#include "identify/fit/frames.hpp"
#include "identify/ladder.hpp"
#include "identify/noise.hpp"
#include "identify/ranges.hpp"
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
  check_repeats(measurements);
  const States states = nominal_states(machine, measurements, options.threads);
  const Candidates candidate = candidates(machine, measurements, options.sets, options.prior);
  if (candidate.varied.empty())
    throw InputError(ErrorKind::machine_or_force, {},
                     "the machine file has no parameter of the sets to fit; add error slots, compliances, "
                     "harmonics_mdeg of joints or sigma_um of error tables");
  const FitProblem problem{
      machine,          measurements,    states,          states.X_MT,           candidate.varied,
      candidate.before, candidate.prior, candidate.least, candidate.correlation, options.threads};
  std::vector<Configuration> loaded;
  const std::vector<SessionFrames> frames =
      first_frames(problem, responses(machine, candidate.varied, states, options.threads, loaded));
  const auto fit_of = [&](const Eigen::VectorXd& prior) {
    FitProblem with = problem;
    with.prior = prior;
    return fit(with, frames);
  };

  Identification result;
  const std::vector<RowGroup> groups = hold_out_groups(problem, options.hold_out);
  const bool has_groups = !groups.empty();
  // Errors of motion can follow the rows far from the truth, and everything else with them. The ladder tries
  // them as linear steps from a fit without them; without rows to test them they are left out.
  std::vector<ParameterSet> first = options.sets;
  if (options.ladder) std::erase_if(first, depends_on_place);
  Eigen::VectorXd kept = prior_of(candidate, first), fitted = kept;
  Fit about = fit_of(kept);
  std::optional<Ladder> ladder(std::in_place, problem, candidate, about, groups);
  if (has_groups && options.ladder) kept = climb(*ladder, problem, options.sets, result.ladder);
  const bool moves_with_place = ((kept - kept.cwiseMin(prior_of(candidate, first))).array() > 0).any();
  if (moves_with_place) {
    about = fit_of(kept);
    fitted = kept;
    ladder.emplace(problem, candidate, about, groups);
  }
  if (has_groups) result.held_out = held_out(*ladder, measurements, kept, result.untested_rows);

  const Fit final_fit = kept == fitted ? about : fit_of(kept);
  Eigen::MatrixXd covariance = final_fit.covariance;
  if (has_groups) widen_by_groups(*ladder, kept, covariance);
  result.iterations = final_fit.iterations;
  result.is_converged = final_fit.is_converged;
  fill_noise(problem, final_fit, result);
  fill_parameters(machine, candidate, final_fit, kept, covariance, result);
  fill_rows(problem, final_fit, result);
  return result;
}

}  // namespace counterflex
