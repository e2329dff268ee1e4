// Lines beside corners: their height changes between what the corners take.
#include <algorithm>
#include <cmath>

#include "compensation/emit/emitter.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

// Planned, in the words of the segment's move; nothing where an end is not planned.
std::optional<Emitter::EndHeights> Emitter::end_heights(std::size_t s) const {
  const PlannedSegment& planned = plan_.segments[s];
  const Move& move = job_.program.moves[job_.path.segments[s].move];
  if (!planned.group.empty())
    return EndHeights{move.start_mm.z() + shift_mm(move, shift_of(planned.group.front().c)).z(),
                      move.end_mm.z() + shift_mm(move, shift_of(planned.group.back().c)).z()};
  if (!planned.end && planned.knots.empty()) return std::nullopt;
  const Vector3& end = end_of(planned).target;
  return EndHeights{in_words_mm(job_, move, planned.start.target).z(), in_words_mm(job_, move, end).z()};
}

namespace {

double slope(const Move& move, double rise_mm) {
  return rise_mm / (move.end_mm - move.start_mm).norm();
}

}  // namespace

// The height of the corner at the end of a segment: in the middle of what both of its flat sides should
// reach.
double Emitter::corner_height_mm(std::size_t s, const EndHeights& heights) const {
  const Move &move = job_.program.moves[job_.path.segments[s].move], *next = &move + 1;
  const bool follows =
      s + 1 < plan_.segments.size() && job_.path.segments[s + 1].move == job_.path.segments[s].move + 1;
  const auto behind = follows && next->corners ? end_heights(s + 1) : std::nullopt;
  if (!behind || !changes_height_inside(*next)) return heights.end_mm;
  const double before_it =
                   -flat_part_mm(move.corners->end_mm) * slope(move, heights.end_mm - heights.start_mm),
               behind_it =
                   flat_part_mm(next->corners->begin_mm) * slope(*next, behind->end_mm - behind->start_mm);
  const double middle = (std::max({0.0, before_it, behind_it}) + std::min({0.0, before_it, behind_it})) / 2,
               most = height_share * job_.options.tolerance / mm;
  return heights.end_mm + std::clamp(middle, -most, most);
}

// A line beside corners keeps its height beside the first, changes it, and ends at the height of its end.
// Returns by how much its flat parts miss their places (mm).
double Emitter::set_height_inside(std::size_t s, const Vector3& end_mm, MoveEdit& edit) {
  const Move& move = job_.program.moves[job_.path.segments[s].move];
  if (!changes_height_inside(move) || !edit.inserted.empty()) return 0;
  const TextPosition from = before(move);
  const auto heights = end_heights(s);
  if (!from[0] || !from[1] || !from[2] || !heights) return 0;
  const Vector3 start_mm(*from[0], *from[1], *from[2]), way_mm = end_mm - start_mm;
  const double begins_mm = flat_part_mm(move.corners->begin_mm), ends_mm = flat_part_mm(move.corners->end_mm),
               length_mm = (move.end_mm - move.start_mm).norm();
  const double end_height = ends_mm > 0 ? corner_height_mm(s, *heights) : end_mm.z();
  if (rounds_to_nothing(move, 2, end_height - start_mm.z())) return 0;
  const auto put_at = [&](double u, double height) {
    Vector3 p = start_mm + u * way_mm;
    p.z() = height;
    edit.inserted.push_back({p});
  };
  if (begins_mm > 0) put_at(begins_mm / length_mm, start_mm.z());
  if (ends_mm > 0) put_at(1 - ends_mm / length_mm, end_height);
  const double rise = slope(move, heights->end_mm - heights->start_mm);
  return std::max(std::abs(start_mm.z() - heights->start_mm - rise * begins_mm),
                  std::abs(end_height - heights->end_mm + rise * ends_mm));
}

}  // namespace counterflex
