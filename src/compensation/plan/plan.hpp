#pragma once
/// What should be commanded along every segment: targets at knots, before they are rounded and written.
#include <algorithm>
#include <vector>

#include "counterflex/compensation/options.hpp"

namespace counterflex {

// The solved correction along one segment, as a curve that can be read anywhere.

/// Command minus wanted place, axes of M: position (m), and rotation vector by its lever (m): zero where the
/// program gives no orientation. So its norm is what a tolerance is for.
using Correction = Vector6;

inline Vector3 shift_of(const Correction& c) {
  return c.head<3>();
}

struct CurveNode {
  double u = 0;  ///< fraction of the segment
  Correction c = Correction::Zero();
};

/// A stretch without corners: the nodes of its polynomial.
using CurveInterval = std::vector<CurveNode>;

/// The polynomial through nodes (Lagrange's form).
inline Correction polynomial_at(const CurveInterval& nodes, double u) {
  Correction sum = Correction::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i) weight *= (u - nodes[j].u) / (nodes[i].u - nodes[j].u);
    sum += weight * nodes[i].c;
  }
  return sum;
}

class CorrectionCurve {
 public:
  /// The correction at `u`; at a step between two intervals that of the later one.
  Correction at(double u) const {
    const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), u,
                                        [](double v, const CurveInterval& i) { return v < i.back().u; });
    return polynomial_at(after == intervals_.end() ? intervals_.back() : *after, u);
  }

  /// The fractions of its nodes and of the middles between them: as close as it bends.
  std::vector<double> nodes() const {
    std::vector<double> fractions;
    for (const CurveInterval& interval : intervals_)
      for (const CurveNode& node : interval) {
        if (!fractions.empty()) fractions.push_back((fractions.back() + node.u) / 2);
        fractions.push_back(node.u);
      }
    return fractions;
  }

  double begin() const { return intervals_.front().front().u; }
  double end() const { return intervals_.back().back().u; }
  void add(CurveInterval interval) { intervals_.push_back(std::move(interval)); }

 private:
  std::vector<CurveInterval> intervals_;
};

/// A commanded position (M, m), and the rotation vector by which the tool is turned against the wanted
/// orientation (rad, axes of M), where the program gives one.
struct TargetCommand {
  Vector3 target = Vector3::Zero();
  Vector3 turn = Vector3::Zero();
};

struct Knot : TargetCommand {
  double u = 1;  ///< fraction of the segment
};

struct PlannedSegment {
  TargetCommand start{};         ///< where the segment should begin
  bool starts_anywhere = false;  ///< a rapid begins where the move before it ended
  /// The last one is its end, a step is two knots at one fraction; empty if it is not corrected by itself.
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

/// The command of a correction at a fraction of a segment.
TargetCommand command_at(const Job& job, const Segment& segment, double u, const Correction& c);

/// What must be left of the tolerance of a segment for corrections between points (m); nothing where rounding
/// to the digits takes it all.
std::optional<double> room_between_points(const Job& job, const Segment& segment, double gain);

/// Plans all segments that are corrected on their own or in a group. A line that bends little, by the bound
/// of its cell, is planned by its ends. Other lines and arcs are sampled between their corners until a
/// polynomial predicts them.
Plan plan(const Job& job);

}  // namespace counterflex
