#include "forces/path/raw_forces.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include "counterflex/toolpath/reach.hpp"
#include "forces/path/profile/profile_cover.hpp"
#include "forces/turning_axes.hpp"

namespace counterflex {
namespace {

// Sine of the angle between feed and tool below which the feed has no lateral direction. The noise of rounded
// coordinates is larger.
constexpr double parallel = 1e-6;

constexpr std::string_view no_lateral_direction = "the feed is parallel to the tool axis";
constexpr std::string_view no_feed = "the block only turns the tool";
constexpr std::string_view given_zero = "the force given for it is zero";
constexpr std::string_view not_given = "no force is given for it";
constexpr std::string_view not_in_holes = "the rows of a profile do not act in holes of cycles";
constexpr std::string_view in_the_air = "it is wholly above --air-above";

// Slopes closer than this give the same cutting force; number of places per piece of turning axes where it is
// computed.
constexpr double same_slope = 1e-9;
constexpr int slopes_per_piece = 10;

// Segments that only turn the tool count this for each radian (m), and at least that in all.
constexpr double turn_counts = mm / deg;
constexpr double least_turn_counts = 1e-6;

// Keys closer than this to the end of a segment act at the end (m).
constexpr double shortest_piece = 1e-9;

/// The profile at `key`, in the interval that begins with `row`.
Vector6 value(const ForceProfile& profile, std::size_t row, double key) {
  const ForceRows& rows = profile.rows;
  if (!profile.linear || row + 1 == rows.size() || rows.ends(row + 1)) return rows.wrench(row);
  const ForceRow from = rows[row], to = rows[row + 1];
  const double w = std::clamp((key - from.key) / (to.key - from.key), 0.0, 1.0);
  return (1 - w) * from.F + w * to.F;
}

bool lateral(const Vector6& F) {
  return F[0] != 0 || F[1] != 0 || F[3] != 0 || F[4] != 0;
}

bool axial(const Vector6& F) {
  return F[2] != 0 || F[5] != 0;
}

/// For a force in the feed frame where the feed is parallel to the tool.
bool loses(const ForcePiece& piece) {
  return lateral(piece.F0) || lateral(piece.F1);
}
bool keeps(const ForcePiece& piece) {
  return axial(piece.F0) || axial(piece.F1);
}

ForceNote loss_at(int line, std::string_view why) {
  return {line, fmt::format("{}: of the force in the feed frame only the z component acts", why)};
}

bool only_turns(const Segment& segment) {
  return length(segment.wanted) == 0;
}

// The direction in which a cycle drills, axes of the work frame.
Vector3 way_of_hole(const Move& move) {
  const bool upwards = move.cycle && move.cycle->bottom_mm > move.cycle->retract_mm;
  return (upwards ? 1 : -1) * Vector3::UnitZ();
}

using SlopeAt = std::function<double(double)>;

bool is_steep(double slope) {
  return std::abs(slope) > steepest_ramp;
}

// Between two places a slope changes by less, where it is nearly this steep.
constexpr double least_steep = steepest_ramp - 0.02;
constexpr int most_halvings = 60;  // of long paths: their ends are far apart for `shortest_piece`

/// Adds the places between increasing `places` where a slope is steepest, if it is steep there.
void add_steepest(const SlopeAt& slope, std::vector<double>& places) {
  const auto size = [&](double s) { return std::abs(slope(s)); };
  const std::size_t count = places.size();
  for (std::size_t k = 0; k + 1 < count; ++k) {
    double a = places[k], b = places[k + 1];
    const double steepest = std::max(size(a), size(b));
    if (is_steep(steepest) || steepest < least_steep) continue;
    for (int i = 0; i < most_halvings && b - a > shortest_piece; ++i) {
      const double c = a + (b - a) / 3, d = b - (b - a) / 3;
      (size(c) < size(d) ? a : b) = size(c) < size(d) ? c : d;
    }
    if (is_steep(slope(a))) places.push_back(a);
  }
  std::ranges::sort(places);
}

/// Two places side by side, one on either side of the steepest ramp.
struct SlopeLimit {
  double before = 0, after = 0;
};
std::optional<SlopeLimit> limit_between(const SlopeAt& slope, double from, double to) {
  const bool begins_steep = is_steep(slope(from));
  if (begins_steep == is_steep(slope(to))) return std::nullopt;
  double before = from, after = to;
  for (int i = 0; i < most_halvings && after - before > shortest_piece; ++i) {
    const double middle = (before + after) / 2;
    (is_steep(slope(middle)) == begins_steep ? before : after) = middle;
  }
  return SlopeLimit{before, after};
}

}  // namespace

double force_end(const Segment& segment) {
  if (segment.s_end > segment.s_start) return segment.s_end;
  return segment.s_start + std::max(turn_counts * turn_of(segment), least_turn_counts);
}

Segment with_force_end(const Segment& segment) {
  Segment along = segment;
  along.s_end = force_end(segment);
  return along;
}

ForceAxes feed_axes(const Vector3& feed_M, const Matrix3& R_MT) {
  const Vector3 z = R_MT.col(2), lateral = z.cross(feed_M.normalized());
  ForceAxes axes;
  if (lateral.norm() < parallel) return {R_MT, true};
  axes.R_MF.col(1) = lateral.normalized();
  axes.R_MF.col(0) = axes.R_MF.col(1).cross(z);
  axes.R_MF.col(2) = z;
  return axes;
}

ForceAxes axes_of(ForceFrame frame, const Vector3& feed_M, const Matrix3& R_MW, const Matrix3& R_MT) {
  switch (frame) {
    case ForceFrame::machine:
      return {};
    case ForceFrame::work:
      return {R_MW, false};
    case ForceFrame::tool:
      return {R_MT, false};
    case ForceFrame::feed:
      break;
  }
  return feed_axes(feed_M, R_MT);
}

Vector6 in_machine_axes(const ForceAxes& axes, const Vector6& F) {
  Vector6 F_M = F;
  if (axes.only_z) F_M[0] = F_M[1] = F_M[3] = F_M[4] = 0;
  F_M.head<3>() = (axes.R_MF * F_M.head<3>()).eval();
  F_M.tail<3>() = (axes.R_MF * F_M.tail<3>()).eval();
  return F_M;
}

void append_profile_pieces(const ForceProfile& profile, const KeySpan& keys, double s0, double s1,
                           std::vector<ForcePiece>& pieces) {
  const double length = s1 - s0, range = keys.end - keys.start;
  if (range == 0) {  // a line or a block number
    const Vector6 F = value(profile, row_at(profile, keys.start), keys.start);
    pieces.push_back({s0, s1, F, F, Vector6::Zero()});
    return;
  }
  const double margin = range * std::min(shortest_piece / length, 0.5);
  const auto add = [&](double from, double to, double at, double end) {
    const std::size_t row = row_at(profile, (from + to) / 2);
    pieces.push_back({at, end, value(profile, row, from), value(profile, row, to), Vector6::Zero()});
  };
  double from = keys.start, at = s0;
  for (std::size_t row = row_at(profile, keys.start); row < profile.rows.size(); ++row) {
    const double key = profile.rows.key(row);
    if (key <= keys.start + margin) continue;
    if (key >= keys.end - margin) break;
    const double s = s0 + (key - keys.start) / range * length;
    add(from, key, at, s);
    from = key;
    at = s;
  }
  add(from, keys.end, at, s1);
}

void append(const ForcePiece& piece, std::size_t first, std::vector<ForcePiece>& pieces) {
  if (pieces.size() > first) {
    ForcePiece& last = pieces.back();
    if (last.F0 == last.F1 && piece.F0 == piece.F1 && last.F1 == piece.F0) {
      last.s1 = piece.s1;
      return;
    }
  }
  pieces.push_back(piece);
}

std::string why_unplaced(const Program& program, const Toolpath& path, std::size_t m) {
  const Move& move = program.moves[m];
  if (move.motion != Motion::feed || move.cycle) return "";
  std::string axes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!move.known_start[axis] || !move.known_end[axis]) axes += "XYZ"[axis];
  if (axes.empty() || std::ranges::binary_search(path.segments, m, {}, &Segment::move)) return "";
  return "the position in " + axes + " is unknown";
}

RawForces::RawForces(const ForceSource& source, const Program& program, const Toolpath& path,
                     const std::vector<Matrix3>& R_MT, std::optional<long>& block_number)
    : source_(source),
      program_(program),
      path_(path),
      R_MT_(R_MT),
      coverage_(source, program, path, block_number) {
  assert(R_MT.size() == 1 || (!R_MT.empty() && R_MT.size() % path.segments.size() == 0));
}

void RawForces::append_to(std::size_t i, double shift, std::size_t first_piece,
                          std::vector<ForcePiece>& pieces, ForceRemarks& remarks) {
  const Segment& segment = path_.segments[i];
  if (segment.s_end > segment.s_start) return append_along(segment, i, shift, first_piece, pieces, remarks);
  append_along(with_force_end(segment), i, shift, first_piece, pieces, remarks);
}

void RawForces::append_along(const Segment& segment, std::size_t i, double shift, std::size_t first_piece,
                             std::vector<ForcePiece>& pieces, ForceRemarks& remarks) {
  const std::string_view why_lost = only_turns(segment) ? no_feed : no_lateral_direction;
  std::string why;
  bool forced = false, lost = false;
  const auto take = [&](const AxesAlong& axes, bool first) {
    const bool only_z = stretch_.frame == ForceFrame::feed && axes.at(0.5, 1).only_z;
    std::string why_none = stretch_.why;
    if (why_none.empty() && is_zero(stretch_)) {
      why_none = given_zero;
    } else if (only_z && std::any_of(stretch_.pieces.begin(), stretch_.pieces.end(), loses)) {
      lost = true;
      if (std::none_of(stretch_.pieces.begin(), stretch_.pieces.end(), keeps)) why_none = why_lost;
    }
    forced = forced || why_none.empty();
    if (why.empty()) why = why_none;
    append_turned(segment, axes, shift, first_piece, first, pieces);
  };
  const auto axes_in = [&](ForceFrame frame) {
    return AxesAlong(frame, segment, path_.frames[segment.frame].X_MW.R, orientations(i));
  };
  if (in_air(source_, program_.moves[segment.move])) {
    give_same(segment.s_start, segment.s_end, Vector6::Zero(), ForceFrame::machine);
    stretch_.why = in_the_air;
    take(axes_in(ForceFrame::machine), true);
  } else {
    for (const ForceStretch& stretch : coverage_.stretches(i)) {
      const AxesAlong axes = axes_in(stretch.rule != nullptr ? frame_of(*stretch.rule) : ForceFrame::machine);
      give(stretch, i, segment, axes);
      take(axes, stretch.from == 0);
    }
  }
  if (lost) remarks.notes.push_back(loss_at(segment.line, why_lost));
  if (!forced)
    remarks.unforced.push_back({segment.line, path_.segments[i].s_end - path_.segments[i].s_start, why});
}

Vector6 RawForces::in_hole(std::size_t m, const Matrix3& R_MT, ForceRemarks& remarks) {
  const Move& move = program_.moves[m];
  const Matrix3& R_MW = path_.frames[move.frame].X_MW.R;
  const Vector3 way = R_MW * way_of_hole(move);
  GivenForce given = in_air(source_, move) ? GivenForce{.why = std::string(in_the_air)}
                                           : given_in_hole(move, coverage_.hole(m), way.dot(R_MT.col(2)));
  const ForceAxes axes = axes_of(given.frame, way, R_MW, R_MT);
  const bool loses = axes.only_z && lateral(given.F);
  if (loses) remarks.notes.push_back(loss_at(move.line, no_lateral_direction));
  const Vector6 F = source_.scale * in_machine_axes(axes, given.F);
  if (given.why.empty() && F.isZero(0)) given.why = loses ? no_lateral_direction : given_zero;
  const std::size_t holes = move.cycle ? static_cast<std::size_t>(count_of_holes(move)) : 1;
  if (!given.why.empty())
    remarks.unforced.insert(remarks.unforced.end(), holes, {move.line, 0, std::move(given.why)});
  return F;
}

RawForces::GivenForce RawForces::given_in_hole(const Move& move, const ForceStretch& by, double slope) const {
  if (by.comment) return {.F = *move.force};
  if (by.rule == nullptr) return {.why = std::string(coverage_.has_profiles() ? not_in_holes : not_given)};
  if (const auto* force = std::get_if<ConstantForce>(&by.rule->content)) return {force->F, force->frame, {}};
  const double feed_m_s = move.feed_mode == FeedMode::length ? move.feed_mm_min * mm / 60 : 0;
  CutForce cut = cutting_force(std::get<CutResponse>(by.rule->content), feed_m_s, move.spindle_rpm, slope);
  return {cut.F, ForceFrame::feed, std::move(cut.why)};
}

bool RawForces::is_zero(const StretchForce& given) const {
  const auto zero = [](const ForcePiece& piece) { return piece.F0.isZero(0) && piece.F1.isZero(0); };
  return source_.scale == 0 || std::all_of(given.pieces.begin(), given.pieces.end(), zero);
}

void RawForces::give_same(double s0, double s1, const Vector6& F, ForceFrame frame) {
  stretch_.pieces.clear();
  stretch_.pieces.push_back({s0, s1, F, F, Vector6::Zero()});
  stretch_.frame = frame;
  stretch_.why.clear();
}

void RawForces::give(const ForceStretch& stretch, std::size_t i, const Segment& segment,
                     const AxesAlong& axes) {
  const double length = segment.s_end - segment.s_start;
  const double s0 = segment.s_start + stretch.from * length,
               s1 = stretch.to == 1 ? segment.s_end : segment.s_start + stretch.to * length;
  const ForceRule* rule = stretch.rule;
  if (stretch.comment) return give_same(s0, s1, *program_.moves[segment.move].force, ForceFrame::machine);
  if (rule == nullptr) {
    give_same(s0, s1, Vector6::Zero(), ForceFrame::machine);
    stretch_.why = not_given;
    return;
  }
  if (const auto* force = std::get_if<ConstantForce>(&rule->content))
    return give_same(s0, s1, force->F, force->frame);
  if (const auto* response = std::get_if<CutResponse>(&rule->content))
    return give_cut(*response, s0, s1, segment, axes);
  const auto& profile = std::get<ForceProfile>(rule->content);
  const KeySpan& keys = coverage_.keys(*rule, i);
  const double range = keys.end - keys.start;
  const KeySpan here{stretch.from == 0 ? keys.start : keys.start + stretch.from * range,
                     stretch.to == 1 ? keys.end : keys.start + stretch.to * range};
  stretch_.pieces.clear();
  stretch_.frame = profile.frame;
  stretch_.why.clear();
  append_profile_pieces(profile, here, s0, s1, stretch_.pieces);
}

// If the slope changes along the segment, as on an upright arc, the force is linear between close places. It
// steps where the feed comes along the tool axis.
void RawForces::give_cut(const CutResponse& response, double s0, double s1, const Segment& segment,
                         const AxesAlong& axes) {
  if (only_turns(segment)) {
    give_same(s0, s1, Vector6::Zero(), ForceFrame::machine);
    stretch_.why = fmt::format("{}: the model has no chips for it", no_feed);
    return;
  }
  const double rpm = program_.moves[segment.move].spindle_rpm;
  const auto slope = [&](double s) {
    const double u = (s - segment.s_start) / (segment.s_end - segment.s_start);
    return direction_at(segment.wanted, u).dot(axes.at(u, 1).R_MF.col(2));
  };
  const auto force = [&](double s) { return cutting_force(response, segment.feed_m_s, rpm, slope(s)); };
  const int count = axes.turn() ? slopes_per_piece * axes.pieces() : 1;
  std::vector<double> places;
  for (int k = 0; k <= count; ++k) places.push_back(k == count ? s1 : s0 + (s1 - s0) * k / count);
  const double middle = slope((s0 + s1) / 2);
  const bool even =
      std::ranges::all_of(places, [&](double s) { return std::abs(slope(s) - middle) < same_slope; });
  stretch_.pieces.clear();
  stretch_.frame = ForceFrame::feed;
  stretch_.why = force((s0 + s1) / 2).why;
  if (even) {
    const Vector6 F = force((s0 + s1) / 2).F;
    stretch_.pieces.push_back({s0, s1, F, F, Vector6::Zero()});
    return;
  }
  add_steepest(slope, places);
  bool goes_on = false;
  // Over [begin, end], with the forces at `from` and `to`.
  const auto give = [&](double begin, double end, double from, double to) {
    const CutForce a = force(from), b = force(to);
    if (a.why.empty() || b.why.empty()) stretch_.why.clear();
    stretch_.pieces.push_back({begin, end, a.F, b.F, Vector6::Zero(), goes_on});
    goes_on = true;
  };
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double from = places[k - 1], to = places[k];
    const auto limit = limit_between(slope, from, to);
    if (!limit) {
      give(from, to, from, to);
      continue;
    }
    const bool at_start = limit->after - from < 2 * shortest_piece,
               at_end = to - limit->after < 2 * shortest_piece;
    if (!at_start) give(from, at_end ? to : limit->after, from, limit->before);
    goes_on = false;
    if (!at_end) give(at_start ? from : limit->after, to, limit->after, to);
  }
}

void RawForces::append_turned(const Segment& segment, const AxesAlong& axes, double shift,
                              std::size_t first_piece, bool first, std::vector<ForcePiece>& pieces) {
  const bool turns = stretch_.frame == ForceFrame::feed || stretch_.frame == ForceFrame::tool;
  for (const ForcePiece& part : stretch_.pieces) {
    bool begins = true;
    turn_pieces(part, segment, axes, turned_);
    for (ForcePiece& piece : turned_) {
      piece.s0 += shift;
      piece.s1 += shift;
      piece.F0 *= source_.scale;
      piece.F1 *= source_.scale;
      if (begins) piece.goes_on = part.goes_on;
      // as at a tangential junction
      if (first && turns && pieces.size() > first_piece)
        piece.goes_on = nearly_same(pieces.back().F1, piece.F0);
      begins = first = false;
      append(piece, first_piece, pieces);
    }
  }
}

std::span<const Matrix3> RawForces::orientations(std::size_t i) const {
  if (R_MT_.size() == 1) return R_MT_;
  const std::size_t each = R_MT_.size() / path_.segments.size();
  return std::span(R_MT_).subspan(i * each, each);
}

}  // namespace counterflex
