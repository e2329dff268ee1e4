#include "identify/fit/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/parallel.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Tuned on the measured UR10: fewer Huber rounds let gross errors pull the first frames.
constexpr int huber_rounds = 3, most_rounds = 30, most_linearisations = 100;
constexpr double huber = 2.0;          // deviations, per component of a row
constexpr double tukey = 6.0;          // rows farther out than this are left out
constexpr double end_of_steps = 1e-6;  // of a parameter's deviation
constexpr double slow_contraction_of_steps = 0.5;
constexpr double largest_rounding = 1e-3;  // of a step that does not become smaller any more
// Damping after the first rejected step, and below which it is dropped. Every further rejection in a row
// doubles the factor by which it grows.
constexpr double first_damping = 0.5, least_damping = 0.02;
constexpr double poor_gain = 0.3;  // of the reduction that a step promised: the next one is damped
/// Of the sum of squares, and its share: smaller changes can be rounding errors of equilibria.
constexpr double negligible = 1e-4, negligible_share = 1e-9;
constexpr std::size_t rows_of_slice = 64;  // rows for one thread at a time
constexpr int most_frame_rounds = 10;
constexpr double end_of_frame_steps = 1e-4;  // of their deviations at held parameters
/// Of the frame in which a coupon was measured, from the nominal one: weak against rows that show it. Where
/// rows leave a lean unknown, a large one would change sizes to second order.
constexpr double coupon_shift = 5 * mm, coupon_turn = 1e-3;
constexpr std::size_t few = 20;  // rows: below, the stated deviation is better than that of the residuals
// Medians of the norms of 1 and 3 standard normal variables.
constexpr std::array<double, 4> median_norm = {0, 0.6744897501960817, 0, 1.5381722544550522};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// That of one row, without memory of its own.
using Residual = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// The deviations of rows of one session, in units of the stated ones.
struct SessionScale {
  double distance = 1, angle = 1;
};

/// Robust deviations of all sessions. A stated deviation is a lower bound.
std::vector<SessionScale> scales_of(const FitProblem& problem, const std::vector<LinearRow>& rows,
                                    const std::vector<Residual>& residuals) {
  std::vector<std::vector<double>> distances(problem.measurements.sessions.size()), angles = distances;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const LinearRow& row = rows[i];
    if (!row.at.is_found) continue;
    const Eigen::Index lengths = row.at.distances, turns = residuals[i].size() - lengths;
    // Norms, not components: the axes of a tracker's frame must not count.
    distances[row.session].push_back(residuals[i].head(lengths).norm() / median_norm[lengths]);
    if (turns > 0) angles[row.session].push_back(residuals[i].tail(turns).norm() / median_norm[turns]);
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

/// The size of a residual in the row's deviations, per component.
double ratio(const LinearRow& row, const Residual& r) {
  double sum = 0;
  for (Eigen::Index i = 0; i < r.size(); ++i)
    sum += std::pow(r[i] / (i < row.at.distances ? row.distance_scale : row.angle_scale), 2);
  return std::sqrt(sum / static_cast<double>(r.size()));
}

/// Weights and scales of rows that have these residuals.
void weigh(const FitProblem& problem, const std::vector<Residual>& residuals, bool is_redescending,
           std::vector<LinearRow>& rows) {
  const std::vector<SessionScale> scales = scales_of(problem, rows, residuals);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    LinearRow& row = rows[i];
    row.distance_scale = scales[row.session].distance;
    row.angle_scale = scales[row.session].angle;
    const double u = row.at.is_found ? ratio(row, residuals[i]) : tukey;
    if (is_redescending)
      row.weight = u < tukey ? std::pow(1 - (u / tukey) * (u / tukey), 2) : 0;
    else
      row.weight = u <= huber ? 1 : huber / u;
  }
}

/// Where the search is.
struct Point {
  Eigen::VectorXd values;
  std::vector<SessionFrames> frames;
  std::vector<Response> responses;  ///< of the machine with the values
  std::vector<Configuration> loaded;
  std::vector<LinearRow> rows;
};

/// Rows of the machine as it is at the point, with the point's frames.
void linearise_rows(const FitProblem& problem, Point& point) {
  point.rows.resize(problem.measurements.rows.size());
  for_each_index(
      (point.rows.size() + rows_of_slice - 1) / rows_of_slice, problem.threads, [&](std::size_t s) {
        for (std::size_t i = s * rows_of_slice; i < std::min((s + 1) * rows_of_slice, point.rows.size());
             ++i) {
          const Measurement& row = problem.measurements.rows[i];
          const std::size_t first = problem.states.first[i];
          point.rows[i].at =
              residual(row, problem.measurements.sessions[row.session].kind, point.frames[row.session],
                       &point.responses[first], &problem.X_MT_nominal[first]);
          point.rows[i].session = row.session;
        }
      });
}

/// Rows of the machine with the point's values.
void linearise(const FitProblem& problem, Point& point) {
  std::vector<double> all;
  for (const Parameter& parameter : parameters(problem.machine)) all.push_back(parameter.value);
  for (std::size_t k = 0; k < problem.varied.size(); ++k)
    all[problem.varied[k]] = point.values[static_cast<Eigen::Index>(k)];
  point.responses = responses(with_parameters(problem.machine, all), problem.varied, problem.states,
                              problem.threads, point.loaded);
  linearise_rows(problem, point);
}

/// A step of all unknowns. A parameter that would leave its bound ends there.
FitStep bounded_step(const FitProblem& problem, const Point& at, double damping) {
  const std::vector<SessionUnknowns> sessions = unknowns_of(problem, at.frames);
  const NormalMatrices normal = normal_matrices(
      at.rows, sessions, at.values.size(), [](std::size_t) { return true; }, problem.threads);
  Eigen::VectorXd prior = problem.prior;
  for (;;) {
    FitStep step = solve(normal, sessions, at.values - problem.before, {prior, problem.correlation}, damping);
    bool changed = false;
    for (Eigen::Index k = 0; k < prior.size(); ++k)
      if (prior[k] > 0 && at.values[k] + step.parameters[k] < problem.least[k]) {
        prior[k] = 0;
        changed = true;
      }
    if (changed) continue;
    for (Eigen::Index k = 0; k < prior.size(); ++k) {
      if (problem.prior[k] == prior[k]) continue;
      step.parameters[k] = problem.least[k] - at.values[k];
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

/// The best step where rows are taken as linear.
struct LinearFit {
  FitStep step;
  std::vector<Residual> residuals;  ///< after the step
  Eigen::VectorXd values;           ///< after the step
  std::vector<SessionFrames> frames;
};

/// Residuals of all rows after a step of everything.
void shift(const FitProblem& problem, const std::vector<LinearRow>& rows, const FitStep& step,
           std::vector<Residual>& residuals) {
  for_each_index((rows.size() + rows_of_slice - 1) / rows_of_slice, problem.threads, [&](std::size_t s) {
    for (std::size_t i = s * rows_of_slice; i < std::min((s + 1) * rows_of_slice, rows.size()); ++i)
      if (rows[i].at.is_found)
        residuals[i] = rows[i].at.r + rows[i].at.J_p * step.parameters +
                       rows[i].at.J_s * step.sessions[rows[i].session].step;
  });
}

/// Weights change many times where rows are linearised: that costs little. Sets those of the point's rows.
/// They are those of residuals after a step: before it, rows that agree with each other are all far out if
/// the machine is. The first step has the stated deviations.
LinearFit fit_linear(const FitProblem& problem, int rounds_before, double damping, Point& at) {
  LinearFit result{{}, {}, {}, at.frames};
  for (const LinearRow& row : at.rows) result.residuals.push_back(row.at.r);
  Eigen::VectorXd last = Eigen::VectorXd::Zero(at.values.size());
  for (int round = 0; round < most_rounds; ++round) {
    const bool is_redescending = rounds_before + round > huber_rounds;
    if (round > 0) weigh(problem, result.residuals, is_redescending, at.rows);
    result.step = bounded_step(problem, at, damping);
    shift(problem, at.rows, result.step, result.residuals);
    const double change = size_of(result.step.parameters - last, result.step.covariance);
    last = result.step.parameters;
    if (is_redescending && change < end_of_steps) break;
  }
  result.values = at.values + result.step.parameters;
  for (std::size_t s = 0; s < result.frames.size(); ++s)
    result.frames[s] = moved(result.frames[s], result.step.sessions[s].step);
  return result;
}

/// Weighted sum of squares with those of the priors, of the residuals of rows with weights.
double cost(const FitProblem& problem, const std::vector<LinearRow>& rows,
            const std::vector<Residual>& residuals, const Eigen::VectorXd& values,
            const std::vector<SessionFrames>& frames) {
  double sum = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].weight == 0) continue;
    const double u = rows[i].at.is_found ? ratio(rows[i], residuals[i]) : tukey;
    sum += rows[i].weight * u * u * std::max(1.0, static_cast<double>(residuals[i].size()));
  }
  Eigen::VectorXd from_prior = values - problem.before;
  for (Eigen::Index k = 0; k < values.size(); ++k)
    from_prior[k] = problem.prior[k] > 0 ? from_prior[k] / problem.prior[k] : 0;
  sum += from_prior.dot(ParameterPrior{problem.prior, problem.correlation}.information() * from_prior);
  for (const SessionUnknowns& session : unknowns_of(problem, frames))
    sum += session.from_prior.cwiseAbs2().dot(session.information);
  return sum;
}

double cost(const FitProblem& problem, const Point& at) {
  std::vector<Residual> residuals;
  for (const LinearRow& row : at.rows) residuals.push_back(row.at.r);
  return cost(problem, at.rows, residuals, at.values, at.frames);
}

/// The largest entry of a session's step in its deviations.
double size_of(const SessionStep& step) {
  return size_of(Eigen::VectorXd(step.step), Eigen::MatrixXd(step.covariance));
}

void copy_weights(const std::vector<LinearRow>& from, std::vector<LinearRow>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i].weight = from[i].weight;
    to[i].distance_scale = from[i].distance_scale;
    to[i].angle_scale = from[i].angle_scale;
  }
}

/// The point after the step. Its frames are those that fit best to its parameters, not only to first order: a
/// lever of the probe times a tilt of the tip is not linear, and steps of all unknowns follow its bent valley
/// slowly. Source: Golub, Pereyra, "Separable nonlinear least squares" (2003).
Point point_after(const FitProblem& problem, const Point& at, const LinearFit& linear) {
  Point to{linear.values, linear.frames, {}, at.loaded, {}};
  linearise(problem, to);
  for (int round = 0; round < most_frame_rounds; ++round) {
    copy_weights(at.rows, to.rows);
    const std::vector<SessionUnknowns> unknowns = unknowns_of(problem, to.frames);
    const NormalMatrices normal = normal_matrices(
        to.rows, unknowns, 0, [](std::size_t) { return true; }, problem.threads);
    double largest = 0;
    for (std::size_t s = 0; s < to.frames.size(); ++s) {
      if (unknowns[s].unknowns.empty()) continue;
      const SessionStep step = solve_session(normal[s], unknowns[s]);
      to.frames[s] = moved(to.frames[s], step.step);
      largest = std::max(largest, size_of(step));
    }
    if (largest < end_of_frame_steps) break;
    linearise_rows(problem, to);
  }
  return to;
}

}  // namespace

std::vector<SessionUnknowns> unknowns_of(const FitProblem& problem,
                                         const std::vector<SessionFrames>& frames) {
  std::vector<SessionUnknowns> all;
  for (std::size_t s = 0; s < frames.size(); ++s) {
    const Session& session = problem.measurements.sessions[s];
    SessionUnknowns one{unknowns_of(session)};
    const bool is_tracker =
        session.kind == MeasurementKind::tracker_point || session.kind == MeasurementKind::tracker_pose;
    if (is_tracker && session.probe_sigma > 0) {
      one.from_prior.segment<3>(6) = frames[s].X_TB.p - session.X_TB.p;
      one.information.segment<3>(6).setConstant(1 / (session.probe_sigma * session.probe_sigma));
    }
    if (session.kind == MeasurementKind::cmm_feature) {
      one.from_prior.head<3>() = frames[s].X_SM.p;
      one.from_prior.segment<3>(3) = log_so3(frames[s].X_SM.R);
      one.information.head<3>().setConstant(1 / (coupon_shift * coupon_shift));
      one.information.segment<3>(3).setConstant(1 / (coupon_turn * coupon_turn));
    }
    all.push_back(std::move(one));
  }
  return all;
}

double ratio(const LinearRow& row) {
  return ratio(row, row.at.r);
}

Fit fit(const FitProblem& problem, std::vector<SessionFrames> start) {
  Point at{problem.before, std::move(start), {}, {}, {}};
  linearise(problem, at);
  Fit result;
  double damping = 0, growth = 2, last_size = 1;
  int rounds = 0;
  for (;;) {
    ++result.iterations;
    const LinearFit found = fit_linear(problem, rounds, damping, at);
    const double size = size_of(found.step.parameters, found.step.covariance);
    const bool is_slow = size > slow_contraction_of_steps * last_size;
    // Without a parameter that moves, the frames have to take a step all the same.
    result.is_converged = result.iterations > 1 &&
                          (size < end_of_steps || (size < largest_rounding && is_slow)) &&
                          damping <= 2 * first_damping;
    last_size = size;
    if (result.is_converged || result.iterations == most_linearisations) break;
    Point next = point_after(problem, at, found);
    const double here = cost(problem, at), there = cost(problem, next),
                 expected = here - cost(problem, at.rows, found.residuals, found.values, found.frames);
    const bool is_tiny = expected < negligible + negligible_share * here;
    if (there < here || is_tiny) {
      const double gain = (here - there) / expected;
      const bool is_poor = is_tiny ? is_slow : gain < poor_gain;
      if (is_poor) damping = std::max(damping, first_damping);
      if (!is_tiny)
        damping *= std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3));
      else if (!is_poor)
        damping /= 3;
      if (damping < least_damping) damping = 0;
      growth = 2;
      rounds += huber_rounds;
      at = std::move(next);
    } else {
      damping = std::max(damping, first_damping) * growth;
      growth *= 2;
    }
  }
  result.covariance = bounded_step(problem, at, 0).covariance;
  result.values = std::move(at.values);
  result.frames = std::move(at.frames);
  result.rows = std::move(at.rows);
  return result;
}

}  // namespace counterflex
