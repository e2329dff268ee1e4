#include <fmt/format.h>

#include <algorithm>

#include "program/gcode/moves/contour.hpp"
#include "program/gcode/remarks.hpp"
#include "program/klartext/codes.hpp"
#include "program/klartext/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 3> klartext_axes{"X", "Y", "Z"};
constexpr const char* retracts_by_code = "M140 retracts from the part along the tool";

double mm_per_unit(const KlartextReading& r) {
  return r.state.unit ? mm_per(*r.state.unit) : 1.0;
}

/// "C" and "IC".
bool is_of_further_axis(const KlartextWord& word) {
  constexpr std::string_view letters = "ABCUVW";
  const bool incremental = word.key.size() == 2 && word.key[0] == 'I';
  return (word.key.size() == 1 || incremental) && letters.find(word.key.back()) != std::string_view::npos;
}

void watch_rotary_axes(KlartextReading& r) {
  for (const KlartextWord& word : r.words)
    if (is_of_further_axis(word) && (!word.literal || word.value != 0))
      r.state.displacements[1] = "a rotary or further axis is not at zero";
}

void check_unit(const KlartextBlock& block, const KlartextReading& r) {
  if (!r.state.unit)
    refuse_klartext(r.program.text, r.program.file, block, block.parts[0].begin,
                    "a move before the unit is known: write MM or INCH behind BEGIN PGM, or give --units mm "
                    "or --units inch");
}

bool is_polar(const KlartextBlock& block) {
  return block.head == "LP" || block.head == "CP";
}

bool programs_axis(const KlartextReading& r) {
  return std::any_of(klartext_axes.begin(), klartext_axes.end(),
                     [&](auto axis) { return find_word(r.words, axis) != nullptr; });
}

bool all_incremental(const KlartextReading& r) {
  return std::all_of(r.words.begin(), r.words.end(), [](const KlartextWord& word) {
    return word.incremental ||
           std::find(klartext_axes.begin(), klartext_axes.end(), word.key) == klartext_axes.end();
  });
}

std::string displacement_reason(const KlartextReading& r) {
  if (!r.state.displacements.empty()) return r.state.displacements.begin()->second;
  return may_skip_or_repeat(r) ? "a jump, a repetition or a call may run the block never or several times"
                               : "";
}

/// A coordinate: a word that may be changed, or an unknown one.
void place_coordinate(const KlartextWord& word, std::size_t axis, bool uncertain, KlartextReading& r,
                      Move& move) {
  KlartextState& state = r.state;
  const auto i = static_cast<Eigen::Index>(axis);
  const bool known_before = state.known[axis];
  state.known[axis] = false;
  if (uncertain || !word.literal || (word.incremental && !known_before)) {
    move.fixed[axis] = !word.incremental || (word.literal && !uncertain);
    return;
  }
  if (word.incremental) {
    state.position_mm[i] += word.value * mm_per_unit(r);
    if (!move.relative) move.incremental = (move.incremental | 1U << axis) & 7U;
  } else {
    state.position_mm[i] = word.value * mm_per_unit(r);
  }
  state.known[axis] = true;
  move.words[axis] = AxisWord{word.number, word.decimals};
}

void place_coordinates(const KlartextBlock& block, KlartextReading& r, Move& move) {
  const std::string displacement = displacement_reason(r);
  move.relative = !is_polar(block) && all_incremental(r);
  bool expression = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const KlartextWord* word = find_word(r.words, klartext_axes[axis]);
    if (word == nullptr) continue;
    expression = expression || !word->literal;
    place_coordinate(*word, axis, !displacement.empty(), r, move);
  }
  if (!displacement.empty()) {
    r.state.known.fill(false);
    note_uncorrected(r, block.line, displacement);
  } else if (expression) {
    const char* cure = r.options.evaluate ? "" : " (--evaluate works out constants)";
    note_uncorrected(r, block.line, fmt::format("a Q parameter gives the position{}", cure));
  }
}

void allow_klartext_changes(const KlartextCodes& codes, bool held, KlartextReading& r, Move& move) {
  const bool has_time = find_word(r.words, "FT") != nullptr;  // of the whole block
  // Behind a piece that '/' may skip the start of an arc would be unknown.
  const bool skips_arc = move.block_delete && move.arc;
  const bool divided = !codes.acts_after && !r.state.corner && !held && !has_time && !skips_arc;
  const bool feed = move.motion == Motion::feed;
  move.may_split = feed && divided;
  // A move that is inserted before a rapid has no F of its own.
  const double feed_of_jump = feed ? move.feed_mm_min : r.feed_before_mm_min;
  move.may_jump = all_known(move.known_start) && feed_of_jump > 0 && divided && (feed || !move.block_delete);
  move.stays_whole = codes.acts_after || has_time || skips_arc || find_word(r.words, "M") != nullptr;
}

/// Under M89 the following blocks, too, call the cycle at their end, until M99. The block of M89 and that of
/// M99 call the cycle themselves: before these its definition may be repeated.
template <typename Call>
void call_cycle(const KlartextCodes& codes, KlartextReading& r, Call&& call) {
  if (codes.cycle_call) r.state.calls_each = false;
  call();
  if (codes.cycle_call) r.state.calls_each = codes.calls_each;
}

/// A cycle of an older control is shifted with the position at which it is called.
bool shifts_with_call(const KlartextReading& r, const Move& move) {
  return r.state.cycle_is_relative && !move.block_delete && move.group == 0 && !move.fixed[0] &&
         !move.fixed[1] && !move.fixed[2];
}

void call_cycle_after(const KlartextBlock& block, KlartextReading& r, Move& move) {
  if (displacement_reason(r).empty() && shifts_with_call(r, move)) {
    move.known_end = r.state.known;
    return call_relative_cycle(block, r, move);
  }
  const bool place_is_known = all_known(r.state.known);
  // Above the surface it only positions the tool.
  const bool is_above = r.state.surface && move.known_start[2] && move.start_mm.z() > r.state.surface->z_mm;
  const bool goes =
      !move.known_start[0] || !move.known_start[1] || move.start_mm.head<2>() != move.end_mm.head<2>();
  const bool feeds = move.motion == Motion::feed && goes && !is_above;
  r.state.known[2] = false;
  if (displacement_reason(r).empty() && r.state.cycle_acts_here && take_hole(r, move)) {
    if (feeds) add_uncorrected(r, {.line = block.line, .why = std::string(feed_to_hole), .feeds = true});
    return note_hole(block, r, move);
  }
  move.calls_at_end = place_is_known && !move.block_delete;
  r.state.surface.reset();
  move.fixed[2] = true;
  move.words[2].reset();
  if (!r.state.cycle_acts_here) {
    move.fixed.fill(true), move.words.fill({}), r.state.known.fill(false);
    r.variables.clear();  // the cycle may call a program that sets them
    forget_klartext_speeds(r.state);
  }
  note_uncorrected(r, block.line, "cycles are not corrected");
}

/// A cycle that is called at a position of the machine is not followed, and may leave the tool anywhere.
void call_cycle_at_machine_position(KlartextReading& r) {
  r.state.surface.reset();
  r.state.known.fill(false);
  r.variables.clear();
  forget_klartext_speeds(r.state);
}

void add_machine_position(const KlartextBlock& block, const KlartextCodes& codes, KlartextReading& r) {
  const bool calls = codes.cycle_call || r.state.calls_each;
  if (calls) call_cycle(codes, r, [&] { call_cycle_at_machine_position(r); });
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (find_word(r.words, klartext_axes[axis]) != nullptr) move_by_machine(r, axis);
  r.state.run_begin = r.program.moves.size();
  r.state.contour = r.state.after_contour = false;
  add_uncorrected(r, {.line = block.line,
                      .why = "M91 or M92: a position of the machine",
                      .machine_position = true,
                      .feeds = calls || find_word(r.words, "FMAX") == nullptr});
}

/// After a block that may be skipped its axes are unknown.
void forget_klartext_skippable(const KlartextBlock& block, KlartextReading& r, const Move& move) {
  if (empty(block.block_delete)) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis]) r.state.known[axis] = false;
}

/// The arc about a pole may change the words of its CC. Later arcs use the pole as the arc has left it. If
/// the arc is not changed, or may be skipped, the CC must not be edited.
void use_pole(KlartextReading& r, const Move& move) {
  if (r.state.pole->must_stay) return;
  const bool taken = move.arc && (move.words[0] || move.words[1] || move.words[2]) && !move.block_delete;
  if (!taken) return r.state.pole.reset();
  r.state.pole->just_set = false;
}

void add_klartext_move(const KlartextBlock& block, const KlartextCodes& codes, KlartextReading& r) {
  check_unit(block, r);
  Move move = begin_klartext_move(block, r);
  const bool rapid = find_word(r.words, "FMAX") != nullptr;
  move.motion = rapid ? Motion::rapid : Motion::feed;
  place_coordinates(block, r, move);
  if (is_polar(block)) {
    std::string why = displacement_reason(r);
    if (why.empty()) why = place_polar_end(block, r, move);
    if (!why.empty()) return add_unfollowed_move(block, r, why);
  } else if (r.state.pole && !is_along_z(move)) {
    r.state.pole->radius_mm.reset();
    r.state.pole->angle.reset();
  }
  move.end_mm = r.state.position_mm;
  if (block.head == "C" || block.head == "CR") read_klartext_arc(block, r, move);
  const bool tangent = block.head == "CT";
  const bool held = tangent && !read_klartext_tangent_arc(r, move);
  if (held) move.handling = Handling::held;
  allow_klartext_changes(codes, held, r, move);
  follow_contour(block, r, move);
  move.known_end = r.state.known;
  if (codes.cycle_call || r.state.calls_each) {
    call_cycle(codes, r, [&] { call_cycle_after(block, r, move); });
    for (std::size_t axis = 0; axis < 3; ++axis)
      move.known_end[axis] = move.known_end[axis] && r.state.known[axis];
  }
  move.may_insert_words = move.words[0] || move.words[1] || move.words[2];
  if (r.state.corner) {
    expect_corner_before(move);
    if (!r.program.moves.empty()) place_corner(*r.state.corner, r.program.moves.back(), move);
    r.state.corner.reset();
  }
  forget_klartext_skippable(block, r, move);
  if ((block.head == "C" || block.head == "CP") && r.state.pole) use_pole(r, move);
  add_move(r, std::move(move));
}

}  // namespace

double klartext_length_mm(const KlartextReading& r, const KlartextWord& word) {
  return word.value * mm_per_unit(r);
}

/// F: mm/min, in inch programs tenths of an inch/min; expressions and feeds per tooth are unknown. F behind
/// M103, M128 or M140 belongs to that code.
void read_klartext_feed(KlartextReading& r) {
  KlartextState& state = r.state;
  const double tenths = state.unit == LengthUnit::inches && state.feed_per_turn == false ? 0.1 : 1.0;
  const KlartextFeed& of_tool = state.tool_feed;
  bool of_code = false;
  for (const KlartextWord& word : r.words) {
    if (word.key == "M") of_code = of_code || word.value == 103 || word.value == 128 || word.value == 140;
    if (word.key == "F" && !of_code)
      state.feed = {word.literal && state.feed_per_turn ? word.value * mm_per_unit(r) * tenths : 0,
                    state.feed_per_turn == true};
    if (word.key == "FAUTO")
      state.feed = of_tool.per_turn || state.feed_per_turn == false ? of_tool : KlartextFeed{};
    if (word.key == "FU") state.feed = {word.literal ? word.value * mm_per_unit(r) : 0, true};
    if (word.key == "FZ" || word.key == "FT") state.feed = {};
  }
}

void forget_klartext_speeds(KlartextState& state) {
  state.feed = state.tool_feed = {};
  state.spindle_rpm = 0;
}

/// That acts now; 0: unknown.
double feed_mm_min(const KlartextState& state) {
  if (state.plunges_slower) return 0;
  const double rpm = state.spindle_off ? 0 : state.spindle_rpm;
  return state.feed.mm * (state.feed.per_turn ? rpm : 1.0);
}

Move begin_klartext_move(const KlartextBlock& block, KlartextReading& r) {
  const KlartextState& state = r.state;
  Move move;
  move.line = line_of_file(r.program.expansion, block.line);
  if (!r.program.expansion.lines.empty()) move.text_line = block.line;
  move.block_index = r.program.block_count - 1;
  move.block = block.span;
  move.unit = state.unit.value_or(LengthUnit::millimetres);
  move.known_start = state.known;
  move.frame = static_cast<std::uint32_t>(state.frame);
  const Move* before = move_before(r.program, r.program.moves.size());
  const bool in_new_frame = before != nullptr && before->frame != move.frame;
  if (in_new_frame || !displacement_reason(r).empty())
    for (std::size_t axis = 0; axis < 3; ++axis)
      move.moved_only_by_program[axis] = state.moved_by_machine[axis] != r.moves_read + 1;
  move.start_mm = move.end_mm = state.position_mm;
  move.spindle_rpm = state.spindle_off ? 0 : state.spindle_rpm;
  move.feed_mm_min = feed_mm_min(state);
  if (!empty(block.number)) {
    long number = 0;
    for (const char c : part(r.program.text, block.number).substr(0, 9)) number = 10 * number + (c - '0');
    move.block_number = number;
  }
  move.tool = as_tool(state.tool);
  move.has_tool_length = move.tool_in_spindle = move.tool_is_chosen = state.tool > 0;
  move.operation = r.operation.index_in(r.program, move.motion, move.tool);
  move.may_insert_words = false;
  move.force = state.force;
  move.sets_force = r.force_line == block.line;
  move.block_delete = !empty(block.block_delete);
  return move;
}

void move_by_machine(KlartextReading& r, std::size_t axis) {
  r.state.known[axis] = false;
  r.state.moved_by_machine[axis] = r.moves_read + 1;
}

/// An inserted word in the next block would move back.
void retract_klartext(const KlartextBlock& block, KlartextReading& r, const char* why) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis == 2 || !r.state.tool_along_z) move_by_machine(r, axis);
  r.state.run_begin = r.program.moves.size();
  r.state.contour = r.state.after_contour = false;
  add_uncorrected(r, {block.line, why, true});
}

void read_klartext_motion(const KlartextBlock& block, KlartextReading& r) {
  r.feed_before_mm_min = feed_mm_min(r.state);
  if (!read_words(block, r)) {
    forget_klartext_speeds(r.state);
    return add_unfollowed_move(block, r,
                               fmt::format("the block {} has words that are not supported", block.head));
  }
  const KlartextCodes codes = read_klartext_m(block, r);
  read_klartext_feed(r);
  watch_rotary_axes(r);
  if (is_polar(block) && codes.machine_position) {
    add_unfollowed_move(block, r, block.head + " with M91 or M92 is not followed");
  } else if (is_polar(block)) {
    add_klartext_move(block, codes, r);
  } else if (codes.machine_position && programs_axis(r)) {
    add_machine_position(block, codes, r);
  } else if (programs_axis(r)) {
    add_klartext_move(block, codes, r);
  } else if (std::any_of(r.words.begin(), r.words.end(), is_of_further_axis) &&
             r.state.displacements.contains(1) && find_word(r.words, "FMAX") == nullptr) {
    add_uncorrected(r, {.line = block.line, .why = r.state.displacements[1], .feeds = true});
  } else if (codes.cycle_call) {
    call_cycle(codes, r, [&] { add_cycle_call(block, r); });
  } else if (find_word(r.words, "R") != nullptr && r.state.contour) {
    r.state.contour = false;
    r.state.after_contour = true;
  }
  if (codes.retracts) retract_klartext(block, r, retracts_by_code);
  if (codes.stops_spindle) r.state.spindle_off = true;
  r.ended = r.ended || (codes.ends && !may_not_run(block, r));
}

void read_klartext_codes(const KlartextBlock& block, KlartextReading& r) {
  KlartextBlock codes = block;
  codes.head.clear();
  if (!read_words(codes, r)) {
    forget_klartext_speeds(r.state);
    return add_unfollowed_move(block, r, "the block M has words that are not supported");
  }
  const KlartextCodes found = read_klartext_m(block, r);
  read_klartext_feed(r);
  if (programs_axis(r)) return add_unfollowed_move(block, r, "axes without L are not supported");
  if (found.cycle_call) call_cycle(found, r, [&] { add_cycle_call(block, r); });
  if (found.retracts) retract_klartext(block, r, retracts_by_code);
  if (found.stops_spindle) r.state.spindle_off = true;
  r.ended = r.ended || (found.ends && !may_not_run(block, r));
}

}  // namespace counterflex
