#include "identify/hold_out.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace counterflex {
namespace {

constexpr std::size_t frame_rows = 20;  // of a session that is held out: they give its frames
constexpr std::size_t parts = 5, regions = 4;
constexpr std::size_t fewest = 10;  // rows of a group

/// Whether other sessions show the same parameters. Those of single axes do not.
bool is_like_others(MeasurementKind kind) {
  return kind != MeasurementKind::axis_table && kind != MeasurementKind::clamped_torque;
}

std::vector<RowGroup> by_session(const FitProblem& problem) {
  std::vector<RowGroup> groups;
  for (std::size_t s = 0; s < problem.measurements.sessions.size(); ++s) {
    if (!is_like_others(problem.measurements.sessions[s].kind)) continue;
    RowGroup group{problem.measurements.sessions[s].name, {}, true};
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
    if (group.rows.size() >= 2) groups.push_back(std::move(group));
  }
  return groups.size() < 2 ? std::vector<RowGroup>{} : groups;
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

}  // namespace

std::vector<RowGroup> hold_out_groups(const FitProblem& problem, HoldOut kind) {
  if (kind == HoldOut::region) return by_region(problem);
  if (kind == HoldOut::fifth) return by_part(problem);
  std::vector<RowGroup> groups = by_session(problem);
  return groups.empty() && kind == HoldOut::automatic ? by_part(problem) : groups;
}

RowErrors errors_of(const FitProblem& problem, const RowGroup& group, const std::vector<LinearRow>& rows,
                    const FitStep& trained) {
  std::vector<Eigen::Matrix<double, session_unknowns, 1>> frames = trained.sessions;
  std::vector<bool> is_for_frames(group.rows.size(), false);
  if (group.has_own_frames) {
    // Evenly spread over the rows. The parameters are held where the training led them.
    std::vector<LinearRow> own;
    std::vector<MeasurementKind> kinds;
    for (const Session& session : problem.measurements.sessions) kinds.push_back(session.kind);
    for (std::size_t k = 0; k < frame_rows; ++k) {
      const std::size_t at = k * group.rows.size() / frame_rows;
      is_for_frames[at] = true;
      LinearRow row = rows[group.rows[at]];
      if (row.at.is_found) row.at.r += row.at.J_p * trained.parameters;
      own.push_back(std::move(row));
    }
    const Eigen::VectorXd held = Eigen::VectorXd::Zero(trained.parameters.size());
    const FitStep step = solve_rows(own, kinds, held, held);
    frames[rows[group.rows[0]].session] = step.sessions[rows[group.rows[0]].session];
  }
  RowErrors errors;
  for (std::size_t k = 0; k < group.rows.size(); ++k) {
    const LinearRow& row = rows[group.rows[k]];
    if (is_for_frames[k] || !row.at.is_found || row.weight == 0) continue;
    const Measurement& measured = problem.measurements.rows[group.rows[k]];
    const Eigen::VectorXd r = row.at.r + row.at.J_p * trained.parameters + row.at.J_s * frames[row.session];
    errors.rows.push_back(group.rows[k]);
    errors.distance.push_back(r.head(row.at.distances).norm() * measured.sigma);
    if (r.size() > row.at.distances)
      errors.angle.push_back(r.tail(r.size() - row.at.distances).norm() * measured.sigma_angle);
  }
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
  result.p95 = errors[static_cast<std::size_t>(0.95 * (n - 1))];
  result.largest = errors.back();
  return result;
}

}  // namespace counterflex
