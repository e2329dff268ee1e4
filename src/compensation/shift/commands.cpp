#include "compensation/shift/commands.hpp"

#include <Eigen/Geometry>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// The side of the cutter, where the segment is beside a contour.
Vector3 away_beside(const Job& job, std::size_t s, double u) {
  const Segment& segment = job.path.segments[s];
  const CutterSide side = job.program.moves[segment.move].cutter_side;
  if (side == CutterSide::none) return Vector3::Zero();
  const Vector3 z = job.path.frames[segment.frame].X_MW.R.col(2);
  const Vector3 left = z.cross(direction_at(segment.wanted, u));
  if (left.norm() < 1e-9) return Vector3::Zero();
  return (side == CutterSide::left ? 1 : -1) * left.normalized();
}

bool same_contour(const Job& job, std::size_t a, std::size_t b) {
  const Move& first = job.program.moves[job.path.segments[a].move];
  const Move& second = job.program.moves[job.path.segments[b].move];
  return first.group != 0 && first.group == second.group;
}

void move_curve(Curve& curve, const Vector3& start, const Vector3& end) {
  curve.start += start;
  curve.end += end;
}

}  // namespace

Vector3 away_from_contour(const Job& job, std::size_t segment, double u) {
  const Move& move = job.program.moves[job.path.segments[segment].move];
  if (move.cutter_side != CutterSide::none) return away_beside(job, segment, u);
  if (move.group == 0) return Vector3::Zero();
  const bool comes = segment > 0 && same_contour(job, segment - 1, segment);
  const bool goes = segment + 1 < job.path.segments.size() && same_contour(job, segment, segment + 1);
  const Vector3 start = comes ? away_beside(job, segment - 1, 1) : Vector3::Zero();
  const Vector3 end = goes ? away_beside(job, segment + 1, 0) : Vector3::Zero();
  return start + u * (end - start);
}

double length_of(const std::map<long, double>& lengths, long tool) {
  const auto found = lengths.find(tool);
  return found == lengths.end() ? 0 : found->second;
}

Vector3 tool_axis_at_home(const Model& model) {
  return tip(model.mechanism, model.home).R.col(2);
}

void shift_pieces(const Job& job, const ConstantShift& shift, std::vector<Piece>& pieces) {
  const Vector3 axis = tool_axis_at_home(job.model);
  for (Piece& piece : pieces) {
    const long tool = job.program.moves[piece.move].tool;
    const double radius = piece.segment == no_segment ? 0 : length_of(shift.radii, tool);
    if (!shift.frames.empty()) {
      const Pose& by = shift.frames[piece.frame];
      piece.commanded = by * piece.commanded;
      if (piece.turn) piece.turn = by.R * *piece.turn;
    }
    const Vector3 back = length_of(shift.lengths, tool) * axis;
    move_curve(piece.commanded, back, back);
    if (piece.commanded.arc) piece.commanded.arc->centre += back;
    if (radius == 0) continue;
    move_curve(piece.commanded, radius * away_from_contour(job, piece.segment, piece.u0),
               radius * away_from_contour(job, piece.segment, piece.u1));
  }
}

}  // namespace counterflex
