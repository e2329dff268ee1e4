#include "identify/hold_out.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "counterflex/files/parallel.hpp"
#include "identify/candidates.hpp"

namespace counterflex {
namespace {

constexpr std::size_t frame_rows = 20;  // of a session that is held out: they give its frames
constexpr std::size_t parts = 5, regions = 4;
constexpr std::size_t fewest = 10;              // rows of a group
constexpr std::size_t slice = 64;               // rows for one thread at a time
constexpr double interval = 1.959963984540054;  // deviations to each side: 95 %
/// Of the noise of a row: parameters that move it by less within their prior deviations are not seen by it.
constexpr double visible = 0.1;
/// A prediction that is off by no more deviations of a row's noise is one that the row can test, whether
/// other rows or an earlier fit made it.
constexpr double predicted_noises = 3;

/// Whether other sessions show the same parameters. Those of single axes do not.
bool is_like_others(MeasurementKind kind) {
  return kind != MeasurementKind::axis_table && kind != MeasurementKind::clamped_torque;
}

std::vector<RowGroup> by_session(const FitProblem& problem) {
  std::vector<RowGroup> groups;
  for (std::size_t s = 0; s < problem.measurements.sessions.size(); ++s) {
    if (!is_like_others(problem.measurements.sessions[s].kind)) continue;
    const Session& session = problem.measurements.sessions[s];
    RowGroup group{session.name, {}, !unknowns_of(session).empty()};
    for (std::size_t i = 0; i < problem.measurements.rows.size(); ++i)
      if (problem.measurements.rows[i].session == s) group.rows.push_back(i);
    if (group.rows.size() >= fewest + frame_rows) groups.push_back(std::move(group));
  }
  return groups.size() < 2 ? std::vector<RowGroup>{} : groups;
}

std::vector<RowGroup> by_part(const FitProblem& problem) {
  std::vector<RowGroup> groups;
  for (std::size_t part = 0; part < parts; ++part) {
    RowGroup group{fmt::format("part {} of {}", part + 1, parts), {}, false};
    for (std::size_t i = part; i < problem.measurements.rows.size(); i += parts) group.rows.push_back(i);
    // Groups that leave rows out would not be those of a jackknife.
    if (group.rows.size() < 2) return {};
    groups.push_back(std::move(group));
  }
  return groups;
}

/// Slices across the direction in which the places of the tip spread most.
std::vector<RowGroup> by_region(const FitProblem& problem) {
  Eigen::MatrixXd places(3, static_cast<Eigen::Index>(problem.measurements.rows.size()));
  for (std::size_t i = 0; i < problem.measurements.rows.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = problem.X_MT_nominal[problem.states.first[i]].p;
  const Eigen::MatrixXd centred = places.colwise() - places.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred * centred.transpose(), Eigen::ComputeFullU);
  const Eigen::VectorXd along = centred.transpose() * svd.matrixU().col(0);
  std::vector<std::size_t> order(problem.measurements.rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return along[static_cast<Eigen::Index>(a)] < along[static_cast<Eigen::Index>(b)];
  });
  std::vector<RowGroup> groups;
  for (std::size_t r = 0; r < regions; ++r) {
    RowGroup group{fmt::format("region {} of {}", r + 1, regions), {}, false};
    for (std::size_t k = r * order.size() / regions; k < (r + 1) * order.size() / regions; ++k)
      group.rows.push_back(order[k]);
    std::sort(group.rows.begin(), group.rows.end());
    if (group.rows.size() >= 2) groups.push_back(std::move(group));
  }
  return groups.size() < 2 ? std::vector<RowGroup>{} : groups;
}

/// Share of the row's numbers whose residual r lies in its 95 % interval.
double share_in_interval(const LinearRow& row, const Eigen::VectorXd& r, const SessionStep& frames,
                         const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd J = row.at.J_p + row.at.J_s * frames.by_parameters;
  int inside = 0;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const double noise = i < row.at.distances ? row.distance_scale : row.angle_scale;
    const double variance = J.row(i).dot(covariance * J.row(i).transpose()) +
                            row.at.J_s.row(i).dot(frames.covariance * row.at.J_s.row(i).transpose()) +
                            noise * noise;
    inside += std::abs(r[i]) < interval * std::sqrt(variance);
  }
  return static_cast<double>(inside) / static_cast<double>(r.size());
}

struct HeldFrames {
  std::vector<SessionStep> frames;  ///< by session
  std::vector<std::size_t> rows;    ///< of the group, without those that give its frames
};

HeldFrames held_frames(const FitProblem& problem, const RowGroup& group, const Fit& all,
                       const FitStep& trained) {
  HeldFrames held{trained.sessions, {}};
  std::vector<bool> is_for_frames(all.rows.size(), false);
  if (group.has_own_frames) {
    // Evenly spread over the rows. The parameters are held where the training led them.
    for (std::size_t k = 0; k < frame_rows; ++k)
      is_for_frames[group.rows[k * group.rows.size() / frame_rows]] = true;
    const std::vector<SessionUnknowns> unknowns = unknowns_of(problem, all.frames);
    NormalMatrices own = normal_matrices(
        all.rows, unknowns, trained.parameters.size(), [&](std::size_t i) { return is_for_frames[i]; }, 1);
    move(trained.parameters, own);
    const std::size_t session = all.rows[group.rows[0]].session;
    held.frames[session] = solve_session(own[session], unknowns[session]);
  }
  for (const std::size_t i : group.rows)
    if (!is_for_frames[i] && all.rows[i].at.is_found && all.rows[i].weight != 0) held.rows.push_back(i);
  return held;
}

}  // namespace

std::vector<RowGroup> hold_out_groups(const FitProblem& problem, HoldOut kind) {
  if (kind == HoldOut::region) return by_region(problem);
  if (kind == HoldOut::fifth) return by_part(problem);
  std::vector<RowGroup> groups = by_session(problem);
  return groups.empty() && kind == HoldOut::automatic ? by_part(problem) : groups;
}

TestRows test_rows(const FitProblem& problem, const RowGroup& group, const Fit& all, const FitStep& trained,
                   const Eigen::VectorXd& tried) {
  const HeldFrames held = held_frames(problem, group, all, trained);
  const Eigen::MatrixXd prior = tried.asDiagonal() * problem.correlation * tried.asDiagonal();
  const Eigen::VectorXd is_tried = tried.unaryExpr([](double p) { return p > 0 ? 1.0 : 0.0; });
  const Eigen::MatrixXd left = is_tried.asDiagonal() * trained.covariance * is_tried.asDiagonal();
  TestRows result;
  result.seen_by_tests.resize(static_cast<std::size_t>(tried.size()));
  result.seen_by_untested = result.seen_by_tests;
  for (const std::size_t i : held.rows) {
    const LinearRow& row = all.rows[i];
    const Eigen::MatrixXd J =
        (row.at.J_p + row.at.J_s * held.frames[row.session].by_parameters).topRows(row.at.distances);
    // Of the stated noise: rows that contradict the fit have raised the real one.
    const double least = visible * visible;
    const double before = (J * prior * J.transpose()).trace(), after = (J * left * J.transpose()).trace();
    if (before <= least) {
      result.blind.push_back(i);
      continue;
    }
    const double noise = row.distance_scale * row.distance_scale * static_cast<double>(J.rows());
    const bool is_test = after < std::max(identified_share * identified_share * before,
                                          predicted_noises * predicted_noises * noise);
    (is_test ? result.tests : result.untested).push_back(i);
    std::vector<bool>& seen = is_test ? result.seen_by_tests : result.seen_by_untested;
    for (Eigen::Index k = 0; k < tried.size(); ++k)
      if (J.col(k).squaredNorm() * tried[k] * tried[k] > least) seen[static_cast<std::size_t>(k)] = true;
  }
  return result;
}

RowErrors errors_of(const FitProblem& problem, const RowGroup& group, const std::vector<std::size_t>& rows,
                    const Fit& all, const FitStep& trained) {
  const HeldFrames held = held_frames(problem, group, all, trained);
  RowErrors errors;
  errors.rows = rows;
  errors.distance.resize(rows.size());
  errors.in_interval.resize(rows.size());
  std::vector<double> angle(rows.size(), -1);
  for_each_index((rows.size() + slice - 1) / slice, problem.threads, [&](std::size_t s) {
    for (std::size_t k = s * slice; k < std::min((s + 1) * slice, rows.size()); ++k) {
      const LinearRow& row = all.rows[rows[k]];
      const Measurement& measured = problem.measurements.rows[rows[k]];
      const SessionStep& frame = held.frames[row.session];
      const Eigen::VectorXd r = row.at.r + row.at.J_p * trained.parameters + row.at.J_s * frame.step;
      const Eigen::Index turns = r.size() - row.at.distances;
      errors.distance[k] = r.head(row.at.distances).norm() * measured.sigma;
      if (turns > 0) angle[k] = r.tail(turns).norm() * measured.sigma_angle;
      errors.in_interval[k] = share_in_interval(row, r, frame, trained.covariance);
    }
  });
  std::copy_if(angle.begin(), angle.end(), std::back_inserter(errors.angle), [](double a) { return a >= 0; });
  return errors;
}

ErrorSummary summary(std::vector<double> errors) {
  ErrorSummary result;
  result.count = errors.size();
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  double sum = 0, squares = 0;
  for (const double e : errors) {
    sum += e;
    squares += e * e;
  }
  const auto n = static_cast<double>(errors.size());
  result.mean = sum / n;
  result.rms = std::sqrt(squares / n);
  result.p95 = errors[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
  result.largest = errors.back();
  return result;
}

}  // namespace counterflex
