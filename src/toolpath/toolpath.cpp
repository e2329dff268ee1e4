#include "counterflex/toolpath/toolpath.hpp"

#include <array>

#include "counterflex/geometry/units.hpp"

namespace counterflex {
namespace {

Segment segment_of(const Move& move, std::size_t index, const Pose& X_MW) {
  Segment segment;
  segment.move = index;
  segment.line = move.line;
  segment.cutting = move.motion == Motion::feed;
  segment.p_WT_start = move.start_mm * mm;
  segment.p_WT_end = move.end_mm * mm;
  segment.p_MT_start = X_MW * segment.p_WT_start;
  segment.p_MT_end = X_MW * segment.p_WT_end;
  segment.feed_m_s = move.feed_mm_min * mm / 60;
  return segment;
}

/// Feed moves count, rapids stand still; so does the clock where no feed is programmed.
void advance(Segment& segment, double s, double t) {
  const double length = segment.cutting ? (segment.p_WT_end - segment.p_WT_start).norm() : 0;
  segment.s_start = s;
  segment.s_end = s + length;
  segment.t_start = t;
  segment.t_end = segment.feed_m_s > 0 ? t + length / segment.feed_m_s : t;
}

}  // namespace

namespace {

// Where the position is unknown it is taken to be the next one programmed, so that nothing seems to move.
void ignore_axis(Program& program, std::size_t axis) {
  const auto k = static_cast<Eigen::Index>(axis);
  double next_mm = 0;
  for (auto move = program.moves.rbegin(); move != program.moves.rend(); ++move) {
    if (!move->known_end[axis]) move->end_mm[k] = next_mm;
    if (!move->known_start[axis]) move->start_mm[k] = move->end_mm[k];
    next_mm = move->start_mm[k];
    move->ignored[axis] = move->known_start[axis] = move->known_end[axis] = true;
  }
}

}  // namespace

void ignore_axes(Program& program, const std::array<bool, 3>& ignored) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (ignored[axis]) ignore_axis(program, axis);
}

Toolpath build_toolpath(const Program& program, const Pose& X_MW) {
  Toolpath path{X_MW, {}};
  path.segments.reserve(program.moves.size());
  double s = 0, t = 0;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    if (!all_known(move.known_start) || !all_known(move.known_end) || move.start_mm == move.end_mm) continue;
    Segment& segment = path.segments.emplace_back(segment_of(move, i, X_MW));
    advance(segment, s, t);
    s = segment.s_end;
    t = segment.t_end;
  }
  return path;
}

}  // namespace counterflex
