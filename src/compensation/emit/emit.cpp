#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/emit/contour_radius.hpp"
#include "compensation/emit/emitter.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

std::vector<MoveEdit> Emitter::run() {
  edits_.reserve(job_.program.moves.size());
  for (std::size_t m = 0; m < job_.program.moves.size() && !out_.failure; ++m) {
    const bool has_segment =
        next_segment_ < job_.path.segments.size() && job_.path.segments[next_segment_].move == m;
    const std::array<bool, 3> lost = lost_axes(job_.program, m);
    for (std::size_t axis = 0; axis < 3; ++axis) state_.holds[axis] = state_.holds[axis] && !lost[axis];
    emit_move(m, has_segment ? Index(next_segment_) : std::nullopt);
    if (has_segment) ++next_segment_;
    state_.doubtful = leaves_doubt(job_.program.moves[m], state_.doubtful);
  }
  leave_pending_alone();
  for (const LeftAlone& block : job_.program.left_alone)
    if (!block.machine_position) state_.why_fixed = block.why;
  out_.narrowed = narrowed_contours(job_, edits_);
  out_.other_moves.left = static_cast<std::size_t>(std::ranges::count_if(job_.program.moves, moves_tool));
  for (const MoveEdit& edit : edits_) out_.other_moves.left -= moves_tool(job_.program.moves[edit.move]);
  if (out_.failure) out_.corrected_moves = 0, out_.other_moves = {};  // nothing is written
  return std::move(edits_);
}

void Emitter::emit_move(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  if (move.starts_uncorrected) {
    leave_pending_alone();
    hold(-frame(move).datum_shift);
    state_.turn.setZero();
  }
  const bool known = all_known(move.known_start) && all_known(move.known_end);
  const bool carries =
      state_.doubtful && state_.correction_known && pending_.empty() && any_axis(state_.holds);
  if (any_axis(move.fixed)) return emit_fixed(m);
  if (move.group != 0) return emit_group(m, s);
  if (move.handling == Handling::held) return emit_rigid(m, s);
  if (move.cycle) return emit_hole(m);
  if (s) return emit_segment(*s);
  if (known) return state_.correction_known ? emit_rigid(m, s) : pass(move);
  if (carries && (move.motion == Motion::feed || !all_known(move.known_end))) return emit_doubtful(m);
  if (all_known(move.known_end)) return emit_first_known(m);
  pending_.push_back(m);
}

void Emitter::emit_segment(std::size_t s) {
  const Segment& segment = job_.path.segments[s];
  const PlannedSegment& planned = plan_.segments[s];
  MoveEdit edit{.move = segment.move};
  UnsplitMiss miss{.position = planned.unsplit_miss};
  start_turn_ = state_.turn;
  end_turn_ = planned.knots.back().turn;
  const double jump = put_jump(segment, planned, edit);
  if (segment.wanted.arc)
    emit_arc(segment, planned, edit, miss);
  else
    emit_line(segment, planned, edit, miss);
  // A block that must stay one begins where the last one ended.
  if (segment.cutting && !job_.program.moves[segment.move].may_split) miss.position += jump;
  finish_segment(segment, planned, miss, std::move(edit));
}

namespace {

Vector3 without_height(const WorkFrame& frame, int axis, const Vector3& step) {
  const Vector3 normal = frame.X_MW.R.col(axis);
  return step - step.dot(normal) * normal;
}

double slope(const Move& move, double rise_mm) {
  return rise_mm / (move.end_mm - move.start_mm).norm();
}

// By how much a control shortens a line beside a chamfer for the largest tool that passes the chamfer, as a
// share of what the chamfer takes: 0 at outer corners of a contour, and at roundings.
double share_for_tool(const Move& before, CutterSide side) {
  const Move& after = *(&before + 1);
  const Vector3 a = before.end_mm - before.start_mm, b = after.end_mm - after.start_mm;
  const bool is_round = before.corners->end_size.kind == CornerKind::round;
  if (is_round || !is_inner_corner(curve_of(before), curve_of(after), side)) return 0;
  return std::cos(std::atan2(a.cross(b).norm(), a.dot(b)) / 2);
}

}  // namespace

Via Emitter::via_of(const Move& move, const TargetCommand& command, double u) const {
  return {in_words_mm(job_, move, command.target), {}, turned_words(job_, move, u, command.turn)};
}

// The step of the correction at the start (m); a feed move performs it where one may be inserted.
double Emitter::put_jump(const Segment& segment, const PlannedSegment& planned, MoveEdit& edit) {
  const Move& move = job_.program.moves[segment.move];
  const Vector3 start = planned.start.target - segment.wanted.start;
  Vector3 step = start - state_.correction;
  // The pieces of such an arc choose their heights themselves; where one has left the tool a rapid may begin.
  const Move* last = move_before(job_.program, segment.move);
  if (stays_flat(move))
    step = without_height(frame(move), move.arc->normal, step);
  else if (!segment.cutting && last != nullptr && stays_flat(*last))
    step = without_height(frame(move), last->arc->normal, step);
  const double turned = lever(job_.options) * (planned.start.turn - state_.turn).norm();
  const double jump =
      planned.starts_anywhere || !state_.correction_known ? 0 : std::hypot(step.norm(), turned);
  const bool jumps = jump > small_share * job_.options.tolerance;
  if (jumps || segment.wanted.arc) piece_held_ = before(move);
  if (!jumps) return 0;
  if (!move.may_jump && !move.may_split) return jump;
  const Via begin = via_of(move, planned.start, 0);
  start_turn_ = planned.start.turn;
  if (move.may_jump)
    edit.jump = begin;
  else
    edit.inserted.push_back(begin);
  go_through(move, begin, piece_held_);
  return jump;
}

void Emitter::emit_line(const Segment& segment, const PlannedSegment& planned, MoveEdit& edit,
                        UnsplitMiss& miss) {
  const Move& move = job_.program.moves[segment.move];
  for (std::size_t k = 0; k + 1 < planned.knots.size(); ++k) {
    edit.inserted.push_back(via_of(move, planned.knots[k], planned.knots[k].u));
  }
  const Vector3& end = planned.knots.back().target;
  if (move.may_position) {
    Vector3 above = in_words_mm(job_, move, end);
    above.z() = before(move)[2].value_or(move.start_mm.z());
    edit.inserted.push_back({above});
  }
  const double miss_mm = set_height_inside(index_of(segment), in_words_mm(job_, move, end), edit);
  if (miss_mm * mm > (1 - height_share) * job_.options.tolerance)
    miss.position = std::max(miss.position, miss_mm * mm);
}

// Lines beside corners: their height changes between what the corners take.

// Planned, in the words of the segment's move; nothing where an end is not planned.
std::optional<Emitter::EndHeights> Emitter::end_heights(std::size_t s) const {
  const PlannedSegment& planned = plan_.segments[s];
  const Move& move = job_.program.moves[job_.path.segments[s].move];
  if (!planned.group.empty())
    return EndHeights{move.start_mm.z() + shift_mm(move, shift_of(planned.group.front().c)).z(),
                      move.end_mm.z() + shift_mm(move, shift_of(planned.group.back().c)).z()};
  if (planned.knots.empty()) return std::nullopt;
  const Vector3& end = planned.knots.back().target;
  return EndHeights{in_words_mm(job_, move, planned.start.target).z(), in_words_mm(job_, move, end).z()};
}

// The flat parts of a line beside its corners. At inner corners of a contour they are longer, as far as line
// and tolerance allow it: what the control shortens must not reach beyond them.
CornerEnds Emitter::flat_parts_mm(std::size_t s, const EndHeights& heights) const {
  const Move& move = job_.program.moves[job_.path.segments[s].move];
  const double begin = flat_part_mm(move.corners->begin_mm), end = flat_part_mm(move.corners->end_mm);
  if (move.cutter_side == CutterSide::none) return {begin, end};
  const double room = (1 - height_share) * job_.options.tolerance / mm /
                      std::abs(slope(move, heights.end_mm - heights.start_mm)),
               most = (most_flat * (move.end_mm - move.start_mm).norm() - begin - end) / 2;
  const auto lengthened = [&](double part, const Move* before) {
    if (part == 0) return part;
    return part +
           std::clamp(room - part, 0.0, std::min(share_for_tool(*before, move.cutter_side) * part, most));
  };
  return {lengthened(begin, &move - 1), lengthened(end, &move)};
}

// The height of the corner at the end of a segment: in the middle of what both of its flat sides should
// reach.
double Emitter::corner_height_mm(std::size_t s, const EndHeights& heights) const {
  const Move &move = job_.program.moves[job_.path.segments[s].move], *next = &move + 1;
  const bool follows =
      s + 1 < plan_.segments.size() && job_.path.segments[s + 1].move == job_.path.segments[s].move + 1;
  const auto behind = follows && next->corners ? end_heights(s + 1) : std::nullopt;
  if (!behind || !changes_height_inside(*next)) return heights.end_mm;
  const double before_it = -flat_parts_mm(s, heights).end_mm * slope(move, heights.end_mm - heights.start_mm),
               behind_it =
                   flat_parts_mm(s + 1, *behind).begin_mm * slope(*next, behind->end_mm - behind->start_mm);
  const double middle = (std::max({0.0, before_it, behind_it}) + std::min({0.0, before_it, behind_it})) / 2,
               most = height_share * job_.options.tolerance / mm;
  return heights.end_mm + std::clamp(middle, -most, most);
}

// A line beside corners keeps its height beside the first, changes it, and ends at the height of its end.
// Returns by how much its flat parts miss their places (mm).
double Emitter::set_height_inside(std::size_t s, const Vector3& end_mm, MoveEdit& edit) {
  const Move& move = job_.program.moves[job_.path.segments[s].move];
  if (!changes_height_inside(move) || !edit.inserted.empty()) return 0;
  const auto from_mm = before(move).place_mm();
  const auto heights = end_heights(s);
  if (!from_mm || !heights) return 0;
  const Vector3 start_mm = *from_mm, way_mm = end_mm - start_mm;
  const CornerEnds flat = flat_parts_mm(s, *heights);
  const double begins_mm = flat.begin_mm, ends_mm = flat.end_mm,
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

namespace {

/// Why no points are put into a move; empty if its own data do not show it.
std::string_view why_not_split(const Move& move) {
  if (move.may_split) return "";
  if (move.exact_stop)
    return "; the tool stops exactly at its end, and would stop at each inserted point, too";
  if (move.corners) return "; a rounding or chamfer of the control is beside it";
  if (move.block_delete && move.arc) return "; '/' may skip its block";
  if (move.stays_whole) return "; a word of its block acts at its start, at its end or on the whole block";
  return "";
}

}  // namespace

void Emitter::finish_segment(const Segment& segment, const PlannedSegment& planned, const UnsplitMiss& miss,
                             MoveEdit edit) {
  const Move& move = job_.program.moves[segment.move];
  const Vector3 correction = planned.knots.back().target - segment.wanted.end;
  Vector3 kept = correction_that_can_be_written(move, correction);
  const bool in_part = kept != correction;
  const bool ends_elsewhere = move.arc && (move.arc->flat || move.polar);
  if (ends_elsewhere) kept = correction_where_held(move, kept);
  edit.end_mm = in_words_mm(job_, move, segment.wanted.end + kept);
  state_.turn = end_turn_;
  edit.orientation = turned_words(job_, move, 1, state_.turn);
  hold(kept);
  if (in_part)
    list_held_words(move, correction - kept);
  else if (miss.position > 0)
    list(move,
         fmt::format("not split, its end is corrected: between its ends the deviation may reach {:.4f} mm{}",
                     miss.position / mm, why_not_split(move)));
  if (miss.turn > 0)
    list(move, fmt::format("not split, and the control turns the tool with the path: the orientation at its "
                           "end stays off by {:.4f} degrees",
                           miss.turn / deg));
  put(std::move(edit), in_part ? Extent::in_part : Extent::whole);
  if (ends_elsewhere && move.polar) {
    for (std::size_t axis = 0; axis < 3; ++axis) state_.held[axis] = piece_held_[axis];
  }
}

// Where no axis words may be inserted, absent axes keep the correction that they have; those that words
// before the first known position have placed take that of the move.
Vector3 Emitter::correction_that_can_be_written(const Move& move, const Vector3& correction) const {
  if (takes_all_words(move) || move.may_position || !state_.correction_known) return correction;
  const auto is_pending = [&](std::size_t axis) {
    return std::any_of(pending_.begin(), pending_.end(), [&](std::size_t p) {
      const Move& earlier = job_.program.moves[p];
      return earlier.words[axis] && !earlier.relative;
    });
  };
  const Matrix3& R_MW = frame(move).X_MW.R;
  Vector3 c_W = R_MW.transpose() * correction;
  const Vector3 held_W = R_MW.transpose() * state_.correction;
  const double rounding = rounding_allowance(move, job_.options.write);
  bool all_written = true;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (move.words[axis] || may_insert_word(move, axis) || is_pending(axis) ||
        std::abs(c_W[axis] - held_W[axis]) < rounding)
      continue;
    c_W[axis] = held_W[axis];
    all_written = false;
  }
  return all_written ? correction : Vector3(R_MW * c_W);
}

// The last piece of a flat arc ends at the height of its start, and polar words may lead beside the target.
Vector3 Emitter::correction_where_held(const Move& move, const Vector3& correction) const {
  Vector3 shift = shift_mm(move, correction);
  bool differs = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double held = *piece_held_[axis] - move.end_mm[axis];
    if (rounds_to_nothing(move, axis, shift[axis] - held)) continue;
    shift[axis] = held;
    differs = true;
  }
  return differs ? correction_of(move, shift) : correction;
}

}  // namespace counterflex
