#include "counterflex/toolpath/toolpath.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {
namespace {

Curve scaled(Curve curve, double factor) {
  curve.start *= factor;
  curve.end *= factor;
  if (curve.arc) curve.arc->centre *= factor;
  return curve;
}

/// `X_MW` is the pose of the move's coordinates.
void fill_in(const Move& move, std::size_t index, const Pose& X_MW, Segment& segment) {
  segment.move = index;
  segment.line = move.line;
  segment.cutting = move.motion == Motion::feed;
  segment.frame = move.frame;
  if (move.orientation) segment.turn = X_MW.R * turn_of(*move.orientation);
  segment.wanted = curve_in(X_MW, move);
}

/// Under G93 F defines the duration of the move.
double feed_m_s(const Move& move, double way) {
  return move.feed_mode == FeedMode::inverse_time ? way * move.feed_per_min / 60 : move.feed_mm_min * mm / 60;
}

bool gives_segment(const Move& move) {
  return all_known(move.known_start) && all_known(move.known_end) &&
         (move.start_mm != move.end_mm || move.arc ||
          (move.orientation && move.orientation->start != move.orientation->end));
}

/// Advances path length and time for feed moves. Rapids do not count; time does not advance without a
/// programmed feed.
void advance(const Move& move, Segment& segment, const PathEnd& start) {
  const double way = segment.cutting ? length(segment.wanted) : 0;
  segment.s_start = start.s;
  segment.s_end = start.s + way;
  segment.t_start = start.t;
  segment.feed_m_s = feed_m_s(move, way);
  segment.t_end = segment.feed_m_s > 0 ? start.t + way / segment.feed_m_s : start.t;
}

}  // namespace

namespace {

// An unknown position is taken as the next programmed one, so that there is no apparent motion.
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

std::vector<WorkFrame> one_frame(const Program& program, const WorkFrame& frame) {
  return std::vector<WorkFrame>(program.frames.size(), frame);
}

std::optional<Matrix3> orientation_at(const Segment& segment, double u) {
  if (!segment.turn) return std::nullopt;
  return orientation_at(*segment.turn, u);
}

double turn_of(const Segment& segment) {
  return segment.turn ? angle_of(*segment.turn) : 0;
}

Pose wanted_frame(const WorkFrame& frame) {
  return {frame.X_MW.R, frame.X_MW.p + frame.datum_shift};
}

Curve curve_of(const Move& move) {
  Curve curve{move.start_mm, move.end_mm, {}};
  if (!move.arc) return curve;
  const Vector3 normal = normal_of(*move.arc);
  curve.arc = Arc{move.arc->centre_mm, normal,
                  sweep_between(move.start_mm, move.end_mm, move.arc->centre_mm, normal, move.arc->turns)};
  return curve;
}

Curve curve_in(const Pose& X_AP, const Move& move) {
  return X_AP * scaled(curve_of(move), mm);
}

double duration_of(const Move& move) {
  if (move.motion != Motion::feed || !gives_segment(move)) return 0;
  const Vector3 start = move.start_mm * mm, end = move.end_mm * mm;
  const double way = move.arc ? length(scaled(curve_of(move), mm)) : (end - start).norm();
  const double feed = feed_m_s(move, way);
  return feed > 0 ? way / feed : 0;
}

std::vector<double> outermost_fractions(const Curve& curve) {
  constexpr double along_normal = 1e-9;
  std::vector<double> fractions;
  if (!curve.arc) return fractions;
  const Arc& arc = *curve.arc;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 in_plane = Vector3::Unit(axis) - arc.normal[axis] * arc.normal;
    if (in_plane.norm() < along_normal) continue;
    for (const double side : {-1.0, 1.0}) {
      const Vector3 outermost = arc.centre + side * in_plane;
      const double u = sweep_between(curve.start, outermost, arc.centre, arc.normal) / arc.sweep;
      if (u < 1) fractions.push_back(u);
    }
  }
  std::sort(fractions.begin(), fractions.end());
  return fractions;
}

Extent extent_of(const Curve& curve) {
  Extent extent{curve.start, curve.start};
  for (const Vector3& p : points_along(curve)) {
    extent.least = extent.least.cwiseMin(p);
    extent.most = extent.most.cwiseMax(p);
  }
  return extent;
}

Extent extent_of(const Move& move) {
  return extent_of(curve_of(move));
}

std::vector<double> fractions_along(const Curve& curve) {
  if (!curve.arc) return {0, 1};
  const int pieces = 1 + static_cast<int>(curve.arc->sweep / (std::numbers::pi / 8));
  std::vector<double> fractions = outermost_fractions(curve);
  for (int i = 0; i <= pieces; ++i) fractions.push_back(static_cast<double>(i) / pieces);
  std::sort(fractions.begin(), fractions.end());
  fractions.erase(std::unique(fractions.begin(), fractions.end()), fractions.end());
  return fractions;
}

std::vector<Vector3> points_along(const Curve& curve) {
  std::vector<Vector3> points;
  for (const double u : fractions_along(curve)) points.push_back(point_at(curve, u));
  return points;
}

int count_of_holes(const Move& move) {
  if (!move.cycle) return 0;
  return move.relative ? move.cycle->repeats : std::min(move.cycle->repeats, 1);
}

std::vector<double> fractions_of_holes(const Move& move) {
  const int count = move.known_end[0] && move.known_end[1] ? count_of_holes(move) : 0;
  std::vector<double> fractions;
  for (int i = 1; i <= count; ++i) fractions.push_back(static_cast<double>(i) / count);
  return fractions;
}

Vector3 bottom_of_hole(const Move& move, double u) {
  const Vector3 place_mm = u == 1 ? move.end_mm : Vector3(move.start_mm + u * (move.end_mm - move.start_mm));
  return {place_mm.x(), place_mm.y(), move.cycle->bottom_mm};
}

std::vector<Curve> holes_of_cycle(const Move& move) {
  std::vector<Curve> holes;
  for (const double u : fractions_of_holes(move)) {
    const Vector3 bottom_mm = bottom_of_hole(move, u);
    holes.push_back({{bottom_mm.x(), bottom_mm.y(), move.cycle->retract_mm}, bottom_mm, {}});
  }
  if (!move.makes_hole || !move.called || !all_known(move.known_end)) return holes;
  const double bottom_mm = move.called->heights_mm[2];
  if (std::isfinite(bottom_mm))
    holes.push_back({move.end_mm, {move.end_mm.x(), move.end_mm.y(), bottom_mm}, {}});
  return holes;
}

std::vector<Vector3> places_of_cycle(const Move& move) {
  std::vector<Vector3> places;
  for (const Curve& hole : holes_of_cycle(move)) {
    const double retract_mm = move.cycle ? move.cycle->retract_mm : move.called->heights_mm[1];
    places.push_back(hole.end);
    places.emplace_back(hole.end.x(), hole.end.y(), retract_mm);
  }
  return places;
}

bool goes_to_unknown_places(const Move& move) {
  const bool drills = move.cycle ? move.cycle->repeats > 0 : move.makes_hole;
  return any_axis(move.fixed) || move.mills_at_end || (drills && holes_of_cycle(move).empty());
}

void ignore_axes(Program& program, const std::array<bool, 3>& ignored) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (ignored[axis]) ignore_axis(program, axis);
}

Toolpath build_toolpath(const Program& program, const std::vector<WorkFrame>& frames, const PathEnd& start) {
  Toolpath path{frames, {}, start};
  std::vector<Pose> wanted(frames.size());
  std::transform(frames.begin(), frames.end(), wanted.begin(), wanted_frame);
  path.segments.reserve(program.moves.size());
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    if (!gives_segment(move)) continue;
    Segment& segment = path.segments.emplace_back();
    fill_in(move, i, wanted[move.frame], segment);
    advance(move, segment, path.end);
    path.end = {segment.s_end, segment.t_end};
  }
  return path;
}

}  // namespace counterflex
