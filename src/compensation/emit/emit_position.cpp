// Positions that are solved by themselves: the first one that is known, and the bottoms of holes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/emit/emitter.hpp"
#include "compensation/solve/failures.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr std::size_t look_ahead = 64;  // blocks

}  // namespace

// The correction at a wanted position, as a shift (m) and a turn; the emission fails without one. Only in a
// hole a cutting force acts.
std::optional<Emitter::PositionCorrection> Emitter::solve_position(const Vector3& wanted, const Move& move) {
  const Model& model = model_with(job_.model, job_.tools, move.tool);
  const std::size_t index = index_of(move);
  if (ends_as_programmed(job_, index)) return PositionCorrection{-frame(move).datum_shift, Vector3::Zero()};
  const TargetRequest request{&model, wanted, job_.forces.in_hole(index), orientation_of(job_, move),
                              directions_at(job_, index, 1, Side::before)};
  TargetAnswer answer;
  solver_.targets({&request, 1}, {&answer, 1});
  if (answer.status != Status::converged) {
    out_.failure = status_failure(job_, answer.status,
                                  {model, frame(move), move.tool, answer.target, request.R_MT}, move.line);
    return std::nullopt;
  }
  const Vector3 correction = answer.target - wanted;
  out_.failure = limit_failure(job_, correction + frame(move).datum_shift, move.line);
  if (!out_.failure) out_.failure = turn_limit_failure(job_, answer.turn, move.line);
  if (out_.failure) return std::nullopt;
  return PositionCorrection{correction, answer.turn};
}

// Those that are too far before `move` take no correction of its own: to be called before it has one.
void Emitter::leave_far_pending_alone(const Move& move) {
  const auto near = std::find_if(pending_.begin(), pending_.end(), [&](std::size_t p) {
    return move.block_index - job_.program.moves[p].block_index <= look_ahead;
  });
  for (auto p = pending_.begin(); p != near; ++p) leave_alone(job_.program.moves[*p]);
  pending_.erase(pending_.begin(), near);
}

// Words before the first known position take its correction.
void Emitter::give_to_pending() {
  for (std::size_t p : pending_) {
    const Move& move = job_.program.moves[p];
    const bool cuts = move.motion == Motion::feed;
    if (cuts)
      list(move,
           "a feed move with a position that is not known: its words have the correction of the next known "
           "one");
    put(shifted(p, shift_mm(move, state_.correction)), cuts ? Extent::in_part : Extent::whole);
  }
  pending_.clear();
}

// The first position that is known in all axes: its correction serves the words before it as well.
void Emitter::emit_first_known(std::size_t m) {
  const Move& move = job_.program.moves[m];
  const std::optional<PositionCorrection> solved = solve_position(wanted_of(job_, move), move);
  if (!solved) return;
  const Vector3& correction = solved->shift;
  leave_far_pending_alone(move);
  const Vector3 kept = correction_that_can_be_written(move, correction);
  hold(kept);
  state_.turn = solved->turn;
  give_to_pending();
  if (kept != correction)
    list_held_words(move, correction - kept);
  else if (move.motion == Motion::feed)
    list(move, "a feed move from a position that is not known: its end is corrected without cutting force");
  const bool in_part = kept != correction || move.motion == Motion::feed;
  put(shifted(m, shift_mm(move, state_.correction)), in_part ? Extent::in_part : Extent::whole);
}

// The correction (M, m) where the words of the block put the tool, before what it calls; the emission fails
// without one. What words can be written for it holds there.
std::optional<Vector3> Emitter::hold_position(const Move& move) {
  const std::optional<PositionCorrection> solved = solve_position(wanted_of(job_, move), move);
  if (!solved) return std::nullopt;
  leave_far_pending_alone(move);
  hold(correction_that_can_be_written(move, solved->shift));
  give_to_pending();
  return solved->shift;
}

// R of a hole with its shift (program coordinates, mm). Where it is not below the tool in the original, so it
// is in the text: the last hole may have left the tool higher than its own shift does. The same holds for the
// height where the series began.
double Emitter::retract_mm(const Move& move, double shift) {
  const CycleMove& cycle = *move.cycle;
  const double planned = cycle.retract_mm + shift;
  const bool may_raise = cycle.retract_word && !move.relative && keeps_retract_above_tool(job_.program, move);
  if (!may_raise) return planned;
  const WriteOptions& options = job_.options.write;
  const int decimals = options.decimals >= 0
                           ? options.decimals
                           : std::max(decimals_of(move, options).inserted, cycle.retract_word->decimals);
  const double digit = mm_per(move.unit) / std::pow(10.0, decimals), rounding = 1e-6;
  const TextPosition held = before(move);
  double height_mm = *held[2];
  if (leaves_at_high_retract(move) && !cycle.begins_series && held.cycle_initial_mm)
    height_mm = std::max(height_mm, *held.cycle_initial_mm);
  const double least = std::ceil(height_mm / digit - rounding) * digit;
  return std::round(planned / digit) * digit < least ? least : planned;
}

// A hole is shifted by the correction at its bottom; the tool leaves it there, or at the height where it
// began.
void Emitter::emit_hole(std::size_t m) {
  const Move& move = job_.program.moves[m];
  const Vector3 bottom = wanted_frame(frame(move)) * (hole_of(move) * mm);
  const std::optional<PositionCorrection> solved = solve_position(bottom, move);
  if (!solved) return;
  Vector3 shift = shift_mm(move, solved->shift);
  const Vector3 entered = held_shift_mm(move);
  MoveEdit edit{.move = m};
  Extent extent = Extent::whole;
  if (!move.cycle->bottom_word && !move.cycle->may_insert_bottom) {
    const double miss = shift.z() - entered.z();
    if (!rounds_to_nothing(move, 2, miss)) {
      list(move, fmt::format("the block takes no Z word: the hole's bottom stays off by {:.4f} mm", miss));
      extent = Extent::in_part;
    }
    shift.z() = entered.z();
  }
  edit.bottom_mm = move.cycle->bottom_mm + shift.z();
  edit.end_mm = move.end_mm + shift;
  const bool held_z = state_.holds[2];
  leave_far_pending_alone(move);
  hold(correction_of(move, shift));
  give_to_pending();
  edit.retract_mm = retract_mm(move, shift.z());
  put(std::move(edit), extent);
  // The text determines where the cycle leaves the tool.
  if (state_.held[2]) shift.z() = *state_.held[2] - move.end_mm.z();
  if (!move.known_end[2]) shift.z() = entered.z();
  state_.correction = correction_of(move, shift);
  state_.holds[2] = state_.held[2] || held_z;
}

}  // namespace counterflex
