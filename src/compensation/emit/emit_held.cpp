// Blocks that are not corrected one by one: what they hold, and what cannot be held.
#include <fmt/format.h>

#include <cmath>

#include "compensation/emit/emitter.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

Vector3 Emitter::shift_mm(const Move& move, const Vector3& correction) const {
  return frame(move).X_MW.R.transpose() * (correction + frame(move).datum_shift) / mm;
}

Vector3 Emitter::held_shift_mm(const Move& move) const {
  Vector3 shift = Vector3::Zero();
  if (!state_.correction_known) return shift;
  const Vector3 all = shift_mm(move, state_.correction);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (state_.holds[axis]) shift[axis] = all[axis];
  return shift;
}

Vector3 Emitter::correction_of(const Move& move, const Vector3& shift_mm) const {
  return frame(move).X_MW.R * (shift_mm * mm) - frame(move).datum_shift;
}

void Emitter::hold(const Vector3& correction) {
  state_.correction = correction;
  state_.correction_known = true;
  state_.holds = {true, true, true};
}

bool Emitter::rounds_to_nothing(const Move& move, std::size_t axis, double shift_mm) const {
  const int decimals = decimals_of(move, job_.options.write).end[axis];
  const double unit = mm_per(move.unit);
  return std::abs(shift_mm) <= 0.5 * std::pow(10.0, -decimals) * unit * (1 + 1e-9);
}

// Why the block is not followed, as the reader notes it at the first of a run of such blocks.
std::string Emitter::why_fixed(const Move& move) const {
  std::string why = state_.why_fixed.empty() ? "the block is not followed" : state_.why_fixed;
  for (const LeftAlone& block : job_.program.left_alone)
    if (line_in_text(block) <= line_in_text(move) && !block.machine_position) why = block.why;
  return why;
}

// Axes that the block sets to a place of its own take no shift: the text must hold none, and where something
// is called at a known place none may be needed. The other axes are shifted.
void Emitter::emit_fixed(std::size_t m) {
  const Move& move = job_.program.moves[m];
  const Vector3 in_text = held_shift_mm(move);
  const std::optional<Vector3> at_call = move.calls_at_end ? hold_position(move) : std::nullopt;
  if (out_.failure) return;
  leave_pending_alone();
  const Vector3 shift = held_shift_mm(move), needed = at_call ? shift_mm(move, *at_call) : shift;
  bool edits = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along = shift[axis];
    const double kept = rounds_to_nothing(move, axis, needed[axis]) ? in_text[axis] : needed[axis];
    if (move.fixed[axis] && !rounds_to_nothing(move, axis, kept))
      return refuse(
          move,
          fmt::format(
              "{}; {} stays where it is, and the correction of {:.4f} mm that holds there cannot be kept",
              why_fixed(move), "XYZ"[axis], kept));
    if (move.fixed[axis]) state_.holds[axis] = false;
    edits = edits || (move.words[axis] && along != 0);
  }
  if (!edits) return pass(move);
  put(shifted(m, shift), Extent::held);
}

MoveEdit Emitter::shifted(std::size_t m, const Vector3& shift) const {
  const Move& move = job_.program.moves[m];
  MoveEdit edit{
      .move = m, .end_mm = move.end_mm + shift, .orientation = turned_words(job_, move, 1, state_.turn)};
  if (move.arc) edit.centre_mm = shifted_centre(move, shift);
  return edit;
}

// Words of axes that do not move have the value that the text holds, to the last digit: G92 sets coordinates
// by them.
void Emitter::keep_standing_axes(const Move& move, MoveEdit& edit) {
  come_to(move);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (move.known_start[axis] && move.end_mm[axis] == move.start_mm[axis] && state_.held[axis] && !move.arc)
      edit.end_mm[axis] = *state_.held[axis];
  }
}

// The correction that holds, as a shift of the block's words: nothing is inserted to split it.
void Emitter::emit_rigid(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  if (!pending_.empty() && !all_known(move.known_end)) return pending_.push_back(m);
  leave_pending_alone();
  if (!state_.correction_known) return leave_alone(move);
  const Vector3 shift = held_shift_mm(move);
  MoveEdit edit = shifted(m, shift);
  if (move.handling == Handling::held && !move.cycle) keep_standing_axes(move, edit);
  if (move.cycle) {
    edit.bottom_mm = move.cycle->bottom_mm + shift.z();
    edit.retract_mm = retract_mm(move, shift.z());
  }
  if (s && move.handling == Handling::group) {
    if (move.arc && group_motion_) divide_by_height(move, *s, edit);
    set_height_inside(*s, edit.end_mm, edit);
  }
  put(std::move(edit), move.handling == Handling::own ? Extent::whole : Extent::held);
}

// After a block that '/' may skip, or that goes to an unknown place, the correction with which it
// was entered holds.
void Emitter::emit_doubtful(std::size_t m) {
  const Move& move = job_.program.moves[m];
  list(move,
       "held: a block before it may be skipped ('/') or is not followed, so its start is not known; it keeps "
       "the correction that holds there");
  const Vector3 shift = held_shift_mm(move);
  put(shifted(m, shift), Extent::held);
  state_.correction = correction_of(move, shift);
  for (std::size_t axis = 0; axis < 3; ++axis)
    state_.holds[axis] = state_.holds[axis] || move.known_end[axis];
}

// Words of axes that carry a correction keep it, so that the tool does not step by it.
bool Emitter::keeps_correction(const Move& move) const {
  if (!state_.correction_known || move.relative) return false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis] && state_.holds[axis]) return true;
  return false;
}

void Emitter::leave_alone(const Move& move) {
  if (keeps_correction(move)) return emit_doubtful(index_of(move));
  list(move, "an axis has no known position here, and none follows within 64 blocks");
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis] && !is_relative(move, axis)) state_.holds[axis] = false;
  pass(move);
}

void Emitter::leave_pending_alone() {
  for (std::size_t p : pending_) leave_alone(job_.program.moves[p]);
  pending_.clear();
}

void Emitter::list_held_words(const Move& move, const Vector3& miss) {
  // The Z of a hole is a word of its cycle.
  const bool has_own_word = move.words[0] || move.words[1] || (!move.makes_hole && move.words[2]);
  const bool has_own_mode = job_.program.dialect == "siemens" && has_own_word && !move.may_insert_words &&
                            !move.mills_at_end && !move.corners;
  const char* block =
      has_own_mode      ? "a block with IC under G90 or with AC under G91 (write G91 or G90 instead)"
      : move.makes_hole ? "a hole keeps the height of its cycle's surface and"
      : job_.program.dialect == "heidenhain" ? "a block before or behind RND or CHF"
                                             : "a block with G43, G44 or G49, or beside a corner,";
  list(move, fmt::format("{} takes no {}: its end stays off by {:.4f} mm", block,
                         move.may_insert_words ? "word of Z" : "further axis words", miss.norm() / mm));
}

void Emitter::refuse(const Move& move, std::string what) {
  if (!out_.failure) out_.failure = Failure{ErrorKind::program_text, move.line, std::move(what)};
}

// The coordinates may move under the tool from one move to the next.
void Emitter::come_to(const Move& move) {
  const std::size_t m = index_of(move);
  if (held_for_ && m <= *held_for_) return;
  if (const Move* last = move_before(job_.program, m))
    state_.held = text_position_between(*last, move, state_.held);
  held_for_ = m;
}

// Axes without a correction may have no position in the text: they take that of the original.
TextPosition Emitter::before(const Move& move) {
  come_to(move);
  TextPosition held = state_.held;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!held[axis]) held[axis] = move.start_mm[axis];
  return held;
}

void Emitter::go_through(const Move& move, const Via& via, TextPosition& held) const {
  held.set(as_written(move, held, via, false, job_.options.write).end);
}

void Emitter::put(MoveEdit edit, Extent extent) {
  const Move& move = job_.program.moves[edit.move];
  come_to(move);
  if (edit.jump || !edit.inserted.empty()) state_.held = before(move);
  if (edit.jump) go_through(move, *edit.jump, state_.held);
  for (const Via& via : edit.inserted) go_through(move, via, state_.held);
  state_.held = text_position_after(move, state_.held, edit.end_mm, job_.options.write);
  edits_.push_back(std::move(edit));
  if (!moves_tool(move)) return;
  OtherMoves& others = out_.other_moves;
  if (extent == Extent::whole)
    ++out_.corrected_moves;
  else if (move.handling == Handling::group)
    ++others.grouped;
  else
    ++(extent == Extent::in_part ? others.in_part : others.held);
}

void Emitter::pass(const Move& move) {
  come_to(move);
  Vector3 end = move.end_mm;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state_.held[axis] && is_relative(move, axis) && move.words[axis])
      end[axis] = *state_.held[axis] + move.end_mm[axis] - move.start_mm[axis];
    if (state_.held[axis] && !move.words[axis] && !(move.cycle && axis == 2)) end[axis] = *state_.held[axis];
  }
  state_.held = text_position_after(move, state_.held, end, job_.options.write);
}

}  // namespace counterflex
