#include "compensation/plan/knots.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/solve/failures.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// A gain that is measured at one place: in steps small against any curvature, with a margin for the places
// beside it.
constexpr double gain_probe = 50e-6;  // m
constexpr double gain_margin = 1 + curve_share;

// Fractions between which points are two zones away from the ends of the segment.
std::pair<double, double> between_zones(const Job& job, const Segment& segment) {
  const double length = (segment.wanted.end - segment.wanted.start).norm();
  const auto twice = [&](const Move* move) {
    return move != nullptr && move->zone ? 2 * move->zone->length_mm * mm / length : 0;
  };
  return {twice(move_before(job.program, segment.move)), 1 - twice(&job.program.moves[segment.move])};
}

}  // namespace

double room_for_knots(const Job& job, const Segment& segment) {
  const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
  return std::max(job.options.tolerance - rounding, curve_share * job.options.tolerance);
}

std::optional<double> room_between_points(const Job& job, const Segment& segment, double gain) {
  const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
  const double room = job.options.tolerance / gain - rounding;
  if (room < curve_share * job.options.tolerance) return std::nullopt;
  return room;
}

namespace {

std::optional<Failure> add_fading_knots(const Job& job, PlaceSolver& solver, std::size_t index,
                                        const CorrectionCurve& stretch, const Fade& fade,
                                        const std::vector<double>& corners, PlannedSegment& planned) {
  const Segment& segment = job.path.segments[index];
  double gain = 1;
  if (auto failure = set_gain(job, solver, index, gain)) return failure;
  const std::optional<double> room = room_between_points(job, segment, gain);
  if (!room) return few_decimals_failure(job.program.moves[segment.move], job.options);
  for (const double u : choose_knots(stretch, fade, corners, *room))
    planned.knots.push_back({command_at(job, segment, u, fade(u, stretch.at(u))), u});
  return std::nullopt;
}

}  // namespace

std::optional<Failure> add_knots(const Job& job, PlaceSolver& solver, std::size_t index,
                                 const CorrectionCurve& stretch, const Fade& fade,
                                 const std::vector<double>& corners, PlannedSegment& planned) {
  if (fade.acts()) return add_fading_knots(job, solver, index, stretch, fade, corners, planned);
  const Segment& segment = job.path.segments[index];
  std::vector<double> knots = choose_knots(stretch, corners, room_for_knots(job, segment));
  if (knots.size() > 1) {
    double gain = 1;
    if (auto failure = set_gain(job, solver, index, gain)) return failure;
    const std::optional<double> room = room_between_points(job, segment, gain);
    if (!room) return few_decimals_failure(job.program.moves[segment.move], job.options);
    knots = choose_knots(stretch, corners, *room);
    // Where that is not possible the zones become smaller.
    const auto [first, last] = between_zones(job, segment);
    if (first < last) knots = kept_from_ends(stretch, corners, *room, knots, first, last);
  }
  for (const double u : knots) planned.knots.push_back({command_at(job, segment, u, stretch.at(u)), u});
  return std::nullopt;
}

// Where the cell of the place gives no bound the largest singular value is measured.
std::optional<Failure> set_gain(const Job& job, PlaceSolver& solver, std::size_t index, double& gain) {
  const Segment& segment = job.path.segments[index];
  const Model& model = model_of(job, segment);
  const Vector3& end = segment.wanted.end;
  const Vector6 F = job.forces.at(index, 1);
  const std::optional<Matrix3> R = orientation_at(segment, 1);
  gain = R ? HUGE_VAL : solver.bend_along(model, {end, end, F, F, {}}).gain;
  if (std::isfinite(gain)) return std::nullopt;
  std::array<ForwardRequest, 6> requests;
  std::array<ForwardAnswer, 6> reached;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector3 aside =
        (k % 2 != 0 ? -gain_probe : gain_probe) * Vector3::Unit(static_cast<Eigen::Index>(k / 2));
    requests[k] = {.model = &model, .target = end + aside, .F = F, .R = R};
  }
  solver.forwards(requests, reached);
  Matrix3 J;
  for (std::size_t k = 0; k < 6; ++k) {
    if (reached[k].status != Status::converged)
      return status_failure(job, reached[k].status, segment, requests[k].target);
    if (k % 2 != 0)
      J.col(static_cast<Eigen::Index>(k / 2)) =
          (reached[k - 1].X_MT.p - reached[k].X_MT.p) / (2 * gain_probe);
  }
  gain = gain_margin * Eigen::JacobiSVD<Matrix3>(J).singularValues()[0];
  return std::nullopt;
}

void forbid_splitting(const Segment& segment, PlannedSegment& planned) {
  if (planned.knots.size() < 2) return;
  const Vector3 c0 = planned.start.target - segment.wanted.start,
                c1 = planned.knots.back().target - segment.wanted.end;
  for (const Knot& knot : planned.knots) {
    const Vector3 c = knot.target - point_at(segment.wanted, knot.u);
    planned.unsplit_miss = std::max(planned.unsplit_miss, (c - (1 - knot.u) * c0 - knot.u * c1).norm());
  }
  planned.knots.erase(planned.knots.begin(), planned.knots.end() - 1);
}

}  // namespace counterflex
