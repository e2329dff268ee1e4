#pragma once
/// What should be commanded along every segment: targets at knots, before they are rounded and written.
#include "compensation/plan/curve.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

struct Knot {
  double u = 1;                      ///< fraction of the segment
  Vector3 target = Vector3::Zero();  ///< M (m)
};

struct PlannedSegment {
  Vector3 start_target = Vector3::Zero();  ///< where the segment should begin (M, m)
  bool starts_anywhere = false;            ///< a rapid begins where the move before it ended
  std::optional<Vector3> end{};            ///< of a segment that is not divided: the target at its end (M, m)
  /// Else the last one is its end; a step within is two knots at one fraction.
  std::vector<Knot> knots;
  /// Of an arc: its correction between steps of the force; its text is fitted when it is known where the one
  /// before it ends.
  std::vector<CorrectionCurve> arc;
  std::vector<CurveNode> group;  ///< of a move of a contour group: corrections at places along it
  double gain = 1;               ///< of an arc: the tip moves by at most this for a change of target
  /// m: largest deviation inside, where points would have been needed but must not be inserted.
  double unsplit_miss = 0;
};

struct Plan {
  std::vector<PlannedSegment> segments;
  std::optional<Failure> failure;  ///< the first along the path
};

/// What must be left of the tolerance of a segment for corrections between points (m); nothing where rounding
/// to the digits takes it all.
std::optional<double> room_between_points(const Job& job, const Segment& segment, double gain);

/// Plans all segments that are corrected on their own or in a group. A line that bends little, by the bound
/// of its cell, is planned by its ends. Other lines and arcs are sampled between their corners until a
/// polynomial predicts them.
Plan plan(const Job& job);

}  // namespace counterflex
