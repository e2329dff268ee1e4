#pragma once
/// From the sampled correction of a segment to the targets that are written.
#include "plan.hpp"
#include "waypoint_solver.hpp"

namespace counterflex {

/// What knots between the ends of a segment must leave of the tolerance, before it is known how the tip
/// follows targets (m).
double room_for_knots(const Job& job, const Segment& segment);

/// Finishes the segments of one model in one chunk.
class KnotPlanner {
 public:
  KnotPlanner(const Job& job, WaypointSolver& solver) : job_(job), solver_(solver) {}

  /// Adds the knots of a stretch without steps of the correction along a line, or the stretch to an arc's.
  /// `corners`: fractions of the segment.
  bool add_stretch(std::size_t index, const CorrectionCurve& stretch, const std::vector<double>& corners,
                   PlannedSegment& planned);

  /// After the last stretch; `end` is the correction there.
  bool finish(std::size_t index, const Vector3& end, PlannedSegment& planned);

  const std::optional<Failure>& failure() const { return failure_; }

 private:
  bool add_knots(std::size_t index, const CorrectionCurve& stretch, const std::vector<double>& corners,
                 PlannedSegment& planned);
  bool measure_gain(std::size_t index);
  void forbid_splitting(const Segment& segment, PlannedSegment& planned) const;

  const Job& job_;
  WaypointSolver& solver_;
  double gain_ = 0;  // measured among these
  std::size_t neighbours_ = 0;
  std::optional<Failure> failure_;
};

}  // namespace counterflex
