#include "plan_knots.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "counterflex/compensation/compensate.hpp"

namespace counterflex {
namespace {

constexpr double gain_probe = 50e-6;  // m
constexpr double gain_margin = 1.01;
constexpr std::size_t segments_of_a_gain = 32;

}  // namespace

double room_for_knots(const Job& job, const Segment& segment) {
  const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
  return std::max(job.options.tolerance - rounding, least_share * job.options.tolerance);
}

bool KnotPlanner::add_stretch(std::size_t index, const CorrectionCurve& stretch,
                              const std::vector<double>& corners, PlannedSegment& planned) {
  if (!job_.path.segments[index].wanted.arc) return add_knots(index, stretch, corners, planned);
  planned.arc.push_back(stretch);
  return true;
}

bool KnotPlanner::add_knots(std::size_t index, const CorrectionCurve& stretch,
                            const std::vector<double>& corners, PlannedSegment& planned) {
  const Segment& segment = job_.path.segments[index];
  std::vector<double> knots = choose_knots(stretch, corners, room_for_knots(job_, segment));
  if (knots.size() > 1) {
    if (!measure_gain(index)) return false;
    const std::optional<double> room = room_between_points(job_, segment, gain_);
    if (!room) {
      failure_ = few_decimals_failure(job_.program.moves[segment.move], job_.options);
      return false;
    }
    knots = choose_knots(stretch, corners, *room);
  }
  for (double u : knots) planned.knots.push_back({u, point_at(segment.wanted, u) + stretch.at(u)});
  return true;
}

bool KnotPlanner::finish(std::size_t index, const Vector3& end, PlannedSegment& planned) {
  const Segment& segment = job_.path.segments[index];
  if (segment.wanted.arc) {
    planned.knots = {{1, segment.wanted.end + end}};
    if (!measure_gain(index)) return false;
    planned.gain = gain_;
    return true;
  }
  if (!job_.program.moves[segment.move].may_split) forbid_splitting(segment, planned);
  return true;
}

// How much the tip moves for a change of target, at most: largest singular value, once for neighbours.
bool KnotPlanner::measure_gain(std::size_t index) {
  if (gain_ > 0 && index / segments_of_a_gain == neighbours_) return true;
  neighbours_ = index / segments_of_a_gain;
  const Segment& segment = job_.path.segments[index];
  std::array<ActualRequest, 6> requests;
  std::array<ActualSolution, 6> reached;
  for (int k = 0; k < 6; ++k) {
    const Vector3 aside = (k % 2 ? -gain_probe : gain_probe) * Vector3::Unit(k / 2);
    requests[static_cast<std::size_t>(k)] = {segment.wanted.end + aside, load_at(job_, index, 1), {}, {}};
  }
  solver_.actuals(requests, reached);
  for (std::size_t k = 0; k < reached.size(); ++k)
    if (reached[k].status != Status::converged) {
      failure_ = status_failure(job_, reached[k].status, solver_.model(), job_.program.moves[segment.move],
                                requests[k].target, segment.line);
      return false;
    }
  Matrix3 gain;
  for (std::size_t axis = 0; axis < 3; ++axis)
    gain.col(static_cast<Eigen::Index>(axis)) =
        (reached[2 * axis].X_MT.p - reached[2 * axis + 1].X_MT.p) / (2 * gain_probe);
  gain_ = gain_margin * Eigen::JacobiSVD<Matrix3>(gain).singularValues()[0];
  return true;
}

// The block must stay one: its end is corrected, and what its inside misses is said.
void KnotPlanner::forbid_splitting(const Segment& segment, PlannedSegment& planned) const {
  if (planned.knots.size() < 2) return;
  const Vector3 c0 = planned.start_target - segment.wanted.start,
                c1 = planned.knots.back().target - segment.wanted.end;
  for (const Knot& knot : planned.knots) {
    const Vector3 c = knot.target - point_at(segment.wanted, knot.u);
    planned.unsplit_miss = std::max(planned.unsplit_miss, (c - (1 - knot.u) * c0 - knot.u * c1).norm());
  }
  planned.knots.erase(planned.knots.begin(), planned.knots.end() - 1);
}

}  // namespace counterflex
