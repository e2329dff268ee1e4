#include "identify/fit/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace counterflex {
namespace {

// Tuned on the measured UR10: fewer Huber rounds let gross errors pull the first frames.
constexpr int huber_rounds = 3, most_rounds = 30, most_linearisations = 12;
constexpr double huber = 2.0;          // deviations, per component of a row
constexpr double tukey = 6.0;          // rows farther out than this are left out
constexpr double end_of_steps = 1e-7;  // of a parameter's deviation
constexpr std::size_t few = 20;  // rows: below, the stated deviation is better than that of the residuals
// Medians of the norms of 1 and 3 standard normal variables.
constexpr std::array<double, 4> median_norm = {0, 0.6744897501960817, 0, 1.5381722544550522};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Robust deviations of all sessions. A stated deviation is a lower bound.
std::vector<SessionScale> scales_of(const FitProblem& problem, const std::vector<LinearRow>& rows) {
  std::vector<std::vector<double>> distances(problem.measurements.sessions.size()), angles = distances;
  for (const LinearRow& row : rows) {
    if (!row.at.is_found) continue;
    const Eigen::Index lengths = row.at.distances, turns = row.at.r.size() - lengths;
    // Norms, not components: the axes of a tracker's frame must not count.
    distances[row.session].push_back(row.at.r.head(lengths).norm() / median_norm[lengths]);
    if (turns > 0) angles[row.session].push_back(row.at.r.tail(turns).norm() / median_norm[turns]);
  }
  std::vector<SessionScale> scales;
  for (std::size_t s = 0; s < distances.size(); ++s) {
    const auto scale = [&](std::vector<double>& all) {
      if (all.empty()) return 1.0;
      const bool is_bound = problem.measurements.sessions[s].sigma_given || all.size() < few;
      return std::max(median(all), is_bound ? 1.0 : 1e-6);
    };
    scales.push_back({scale(distances[s]), scale(angles[s])});
  }
  return scales;
}

void weigh(const std::vector<SessionScale>& scales, bool is_redescending, std::vector<LinearRow>& rows) {
  for (LinearRow& row : rows) {
    row.distance_scale = scales[row.session].distance;
    row.angle_scale = scales[row.session].angle;
    const double u = row.at.is_found ? ratio(row) : tukey;
    if (is_redescending)
      row.weight = u < tukey ? std::pow(1 - (u / tukey) * (u / tukey), 2) : 0;
    else
      row.weight = u <= huber ? 1 : huber / u;
  }
}

std::vector<MeasurementKind> kinds_of(const FitProblem& problem) {
  std::vector<MeasurementKind> kinds;
  for (const Session& session : problem.measurements.sessions) kinds.push_back(session.kind);
  return kinds;
}

}  // namespace

double ratio(const LinearRow& row) {
  double sum = 0;
  for (Eigen::Index i = 0; i < row.at.r.size(); ++i)
    sum += std::pow(row.at.r[i] / (i < row.at.distances ? row.distance_scale : row.angle_scale), 2);
  return std::sqrt(sum / static_cast<double>(row.at.r.size()));
}

std::vector<LinearRow> linearise(const FitProblem& problem, const Eigen::VectorXd& values,
                                 const std::vector<SessionFrames>& frames,
                                 std::vector<Configuration>& loaded) {
  std::vector<double> all;
  for (const Parameter& parameter : parameters(problem.machine)) all.push_back(parameter.value);
  for (std::size_t k = 0; k < problem.varied.size(); ++k)
    all[problem.varied[k]] = values[static_cast<Eigen::Index>(k)];
  const std::vector<Response> found = responses(with_parameters(problem.machine, all), problem.varied,
                                                problem.states, problem.threads, loaded);
  std::vector<LinearRow> rows;
  for (std::size_t i = 0; i < problem.measurements.rows.size(); ++i) {
    const Measurement& row = problem.measurements.rows[i];
    const std::size_t first = problem.states.first[i];
    rows.push_back({residual(row, problem.measurements.sessions[row.session].kind, frames[row.session],
                             &found[first], &problem.X_MT_nominal[first]),
                    row.session});
  }
  return rows;
}

FitStep refit(const FitProblem& problem, const std::vector<LinearRow>& rows, const Eigen::VectorXd& origin,
              const Eigen::VectorXd& prior, const std::function<bool(std::size_t)>& is_used) {
  std::vector<LinearRow> used;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (is_used(i)) used.push_back(rows[i]);
  return solve_rows(used, kinds_of(problem), origin - problem.before, prior);
}

namespace {

/// One step of all unknowns. A parameter that would leave its bound ends there.
FitStep bounded_step(const FitProblem& problem, const std::vector<MeasurementKind>& kinds,
                     const std::vector<LinearRow>& rows, const Eigen::VectorXd& values) {
  Eigen::VectorXd prior = problem.prior;
  for (;;) {
    FitStep step = solve_rows(rows, kinds, values - problem.before, prior);
    bool changed = false;
    for (Eigen::Index k = 0; k < prior.size(); ++k)
      if (prior[k] > 0 && values[k] + step.parameters[k] < problem.least[k]) {
        prior[k] = 0;
        changed = true;
      }
    if (changed) continue;
    for (Eigen::Index k = 0; k < prior.size(); ++k) {
      if (problem.prior[k] == prior[k]) continue;
      step.parameters[k] = problem.least[k] - values[k];
      step.covariance(k, k) = problem.prior[k] * problem.prior[k];
    }
    return step;
  }
}

/// The largest entry in its deviations.
double size_of(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance) {
  double largest = 0;
  for (Eigen::Index k = 0; k < step.size(); ++k)
    if (covariance(k, k) > 0) largest = std::max(largest, std::abs(step[k]) / std::sqrt(covariance(k, k)));
  return largest;
}

/// Moves the residuals of linearised rows by a step.
void shift(const FitStep& step, std::vector<LinearRow>& rows) {
  for (LinearRow& row : rows)
    if (row.at.is_found) row.at.r += row.at.J_p * step.parameters + row.at.J_s * step.sessions[row.session];
}

}  // namespace

Fit fit(const FitProblem& problem, std::vector<SessionFrames> start) {
  Fit result;
  result.values = problem.before;
  result.frames = std::move(start);
  std::vector<Configuration> loaded;
  const std::vector<MeasurementKind> kinds = kinds_of(problem);
  int round = 0;
  for (result.iterations = 1;; ++result.iterations) {
    result.rows = linearise(problem, result.values, result.frames, loaded);
    const Eigen::VectorXd from = result.values;
    // Weights change many times where rows are linearised: that costs little.
    for (int inner = 0; inner < most_rounds; ++inner) {
      ++round;
      result.scales = scales_of(problem, result.rows);
      weigh(result.scales, round > huber_rounds, result.rows);
      const FitStep step = bounded_step(problem, kinds, result.rows, result.values);
      result.covariance = step.covariance;
      result.values += step.parameters;
      for (std::size_t s = 0; s < result.frames.size(); ++s)
        result.frames[s] = moved(result.frames[s], step.sessions[s]);
      shift(step, result.rows);
      if (round > huber_rounds && size_of(step.parameters, step.covariance) < end_of_steps) break;
    }
    const bool is_small = size_of(result.values - from, result.covariance) < 10 * end_of_steps;
    if ((is_small && result.iterations > 1) || result.iterations == most_linearisations) return result;
  }
}

}  // namespace counterflex
