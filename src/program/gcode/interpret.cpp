#include "program/gcode/interpret.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/gcode/flow.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/other_moves.hpp"
#include "program/gcode/moves/read_arc.hpp"
#include "program/gcode/moves/read_cycle.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/offsets.hpp"
#include "program/gcode/remarks.hpp"
#include "program/gcode/words/modal_words.hpp"
#include "program/siemens/cycles.hpp"
#include "program/siemens/speeds.hpp"
#include "program/siemens/statements.hpp"
#include "program/text/force_comment.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool is_blank_line(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) { return is_blank(c) || is_ignored(c); });
}

/// If several comments are alone in a line, the first one with a name is the operation.
void apply_comments(const Block& block, Reading& r) {
  const std::string_view text = r.program.text;
  if (block.comments.empty()) {
    if (is_blank_line(part(text, block.span))) r.operation.expect_title();
    return;
  }
  bool may_name = has_comments_alone(text, block);
  for (const Span& comment : block.comments) {
    if (const auto force = read_force_comment(text, r.program.file, block, comment))
      r.state.force = force->F, r.force_line = block.line;
    else if (may_name)
      may_name = !r.operation.name(part(text, comment), as_tool(r.state.tool));
  }
}

constexpr std::uint64_t bit_of(Action action) {
  return std::uint64_t{1} << static_cast<unsigned>(action);
}

/// Whether the block has codes other than G0 to G3.
bool has_other_codes(const SortedBlock& sorted) {
  constexpr std::uint64_t motions = bit_of(Action::rapid) | bit_of(Action::feed) | bit_of(Action::arc);
  return (sorted.actions & ~motions) != 0 || !sorted.m.empty();
}

void check_can_move(const Block& block, const Reading& r) {
  const Word& word = first_axis_word(block);
  const auto fail = [&](const std::string& message) { refuse_word(block, r, word, message); };
  if (!why_not_followed(r).empty()) return;
  if (r.state.motion == MotionMode::none)
    fail(fmt::format("{} without a motion: program G0 or G1 before it", word.letter));
  if (r.state.motion == MotionMode::cancelled)
    fail(fmt::format("{} without a motion: after G80, {} needs G0 or G1 again", word.letter, r.dialect.name));
  demand_unit(block, r, word);
}

void read_line(const Block& block, Reading& r, Motion motion) {
  const bool hole = r.called && takes_modal_hole(block, r);
  Move& move = start_move(block, r, motion);
  place_words(block, r, move);
  if (hole) place_modal_hole(r, move);
  finish_move(r, move);
  if (hole) end_called_hole(r);
}

/// The move of a block under the active motion.
void read_modal_move(const Block& block, Reading& r) {
  check_can_move(block, r);
  if (r.called && r.state.motion != MotionMode::rapid && r.state.motion != MotionMode::feed)
    takes_modal_hole(block, r);
  switch (r.state.motion) {
    case MotionMode::clockwise:
    case MotionMode::counter_clockwise:
      return read_arc(block, r);
    case MotionMode::cycle:
      return read_cycle(block, r);
    case MotionMode::probe:
      return read_held(block, r, "the end of a probing move is not known", false);
    case MotionMode::spline:
      return read_held(block, r, "a spline is not followed", true);
    case MotionMode::thread:
      return read_held(block, r, "a thread is not followed", false);
    default:
      return read_line(block, r, r.state.motion == MotionMode::feed ? Motion::feed : Motion::rapid);
  }
}

/// Whether the words of the block move the tool under the active motion.
bool has_words_of_motion(const Reading& r) {
  if (has_axis_word(r.sorted) || (may_turn_tool(r) && r.sorted.has_any("ABC"))) return true;
  switch (r.state.motion) {
    case MotionMode::clockwise:
    case MotionMode::counter_clockwise:
      return r.sorted.has_any("IJKR");
    case MotionMode::cycle:
      return r.sorted.has(Action::cycle) || r.sorted.has_any("RL");
    default:
      return false;
  }
}

const FoundG* find_own_motion(const SortedBlock& sorted) {
  for (const FoundG& g : sorted.g) {
    const Action action = g.code->action;
    if (action == Action::own_way || action == Action::engrave || action == Action::pocket ||
        action == Action::call || (action == Action::probe && g.code->group == CodeGroup::none))
      return &g;
  }
  return nullptr;
}

bool has_m(const SortedBlock& sorted, std::initializer_list<int> codes) {
  return std::ranges::any_of(
      sorted.m, [&](const FoundM& m) { return std::ranges::find(codes, m.code) != codes.end(); });
}

/// "O9001" of M98 P9001 and G65 P9001; empty if P has no plain number, and for M97, which calls a block.
std::string called_by_number(const Reading& r) {
  const Word* p = r.sorted.word('P');
  const bool by_number = r.sorted.has(Action::call) || has_m(r.sorted, {98});
  return by_number && p != nullptr && p->literal ? fmt::format("O{:.0f}", p->value) : std::string();
}

void read_own_motion(const Block& block, Reading& r, const FoundG& found) {
  switch (found.code->action) {
    case Action::own_way:
      return read_own_way(block, r, found);
    case Action::engrave:
      return read_engraving(block, r, found);
    case Action::pocket:
      return read_pocket(block, r);
    case Action::call:
      return read_call(block, r, called_by_number(r));
    default:
      return read_held(block, r, "the end of a probing move is not known", false);
  }
}

/// G28 beside G0 is an error on some controls, G53 beside G28 on all.
void check_reference(const Block& block, const Reading& r, const FoundG& reference) {
  const bool other = r.sorted.has(Action::rapid) || r.sorted.has(Action::feed);
  if (r.sorted.has(Action::machine_move) || (other && !r.dialect.reference_beside_motion))
    refuse_word(block, r, *reference.word,
                fmt::format("G{} is not allowed in a block with another motion", reference.word->value));
}

/// "G28 Z0 M98 P9001" moves, then calls.
void move_and_call(const Block& block, Reading& r, const FoundG& machine) {
  add_machine_move(block, r, machine);
  if (r.sorted.has(MAction::call)) read_call(block, r, called_by_number(r));
}

/// Passes the axis words to the code that uses them.
void apply_axis_words(const Block& block, Reading& r) {
  if (!has_other_codes(r.sorted)) {
    if (!r.state.entering_data && has_words_of_motion(r)) read_modal_move(block, r);
    return;
  }
  if (const FoundG* reference = r.sorted.find(Action::reference_move)) {
    check_reference(block, r, *reference);
    return move_and_call(block, r, *reference);
  }
  if (const FoundG* machine = r.sorted.find(Action::machine_move)) return move_and_call(block, r, *machine);
  if (const FoundG* own = find_own_motion(r.sorted)) return read_own_motion(block, r, *own);
  // The block moves before it calls. Its end is not known behind a call that stays.
  if (r.sorted.has(MAction::call))
    return read_call(block, r, has_words_of_motion(r) ? std::string() : called_by_number(r));
  if (!has_words_of_motion(r) || takes_axis_words(r)) return;
  if (const FoundG* dwell = r.sorted.find(Action::dwell)) {
    if (r.dialect.dwell_takes_axis_words) return;
    refuse_word(block, r, *dwell->word, "axis words are not allowed in a block with a dwell");
  }
  if (const FoundG* smooth = r.sorted.find(Action::smooth))
    refuse_word(block, r, *smooth->word,
                fmt::format("axis words are not allowed in a block with G{}", smooth->word->value));
  read_modal_move(block, r);
}

void end_unknown_cutter(Reading& r) {
  if (r.sorted.has(Action::cutter) || r.sorted.has(Action::no_cutter))
    r.state.unknown_modes &= static_cast<std::uint16_t>(~unknown_cutter);
}

/// M3, M4 and M5. M13 and M14 of some controls are M3 and M4 with coolant.
void start_spindle(Reading& r) {
  if (has_m(r.sorted, {3, 4, 13, 14})) r.state.spindle_off = false;
}

/// M19 orients the spindle.
void stop_spindle(Reading& r) {
  if (has_m(r.sorted, {5, 19})) r.state.spindle_off = true;
}

void remark_unknown_unit_of_feed(const Block& block, Reading& r) {
  if (!r.state.unit || unit_of_feed(r)) return;
  add_remark(r.program, block.line,
             "F is in the basic system of the control under G70, and this system is not stated: feeds are "
             "unknown from here on; state units of [program] in the machine file, or give --units");
}

/// In the order in which controls execute them.
void apply_codes(const Block& block, Reading& r) {
  apply_feed_and_tool(r);
  remark_unknown_unit_of_feed(block, r);
  start_spindle(r);
  end_unknown_cutter(r);
  apply_modes(block, r);
  apply_cutter(r);
  apply_work_offset(block, r);
  apply_tool_length(block, r);
  apply_displacements(block, r);
  if ((r.state.displaced & modal_macro) != 0) forget_speeds(r.state);  // F and S of G66 are arguments
  apply_set_data(block, r);
  if (r.sorted.has(MAction::restore)) r.state.unknown_modes = all_unknown_modes, forget_speeds(r.state);
  remark_machine_codes(block, r);
}

Context context_of(const Reading& r) {
  const bool open = r.in_body() || r.state.unknown_modes != 0 || r.state.entering_data;
  if (open || (r.state.displaced & modal_macro) != 0) return Context::unknown;
  switch (r.state.motion) {
    case MotionMode::clockwise:
    case MotionMode::counter_clockwise:
      return Context::arc;
    case MotionMode::cycle:
    case MotionMode::spline:
    case MotionMode::thread:
      return Context::cycle;
    default:
      return Context::plain;
  }
}

/// Whether the block feeds further axes alone, which are not followed: they may cut.
bool feeds_further_axes(const Reading& r) {
  const bool feeds = r.state.motion != MotionMode::none && r.state.motion != MotionMode::rapid &&
                     r.state.motion != MotionMode::cancelled;
  if (!feeds || r.sorted.has(Action::call) || r.sorted.has(Action::dwell) || r.sorted.has(Action::displace) ||
      r.sorted.has(Action::set_data) || r.sorted.has(Action::shift))
    return false;
  return (r.state.displaced & rotary) != 0 && r.sorted.has_any(may_turn_tool(r) ? "UVW" : "ABCUVW");
}

/// Counts the block as a feed move of unknown length, unless it was.
void note_feed_of_further_axes(const Block& block, Reading& r) {
  std::vector<LeftAlone>& left = r.program.left_alone;
  const bool is_listed = !left.empty() && left.back().text_line == block.text_line;
  if (!is_listed)
    left.push_back({block.line, "a feed of further axes is not followed", false, block.text_line});
  if (!left.back().machine_position) left.back().feeds = true;
}

void apply_words(const Block& block, Reading& r) {
  r.corner = block.corner;
  r.angle = block.angle;
  sort_words(r.program.file, r.dialect, block, context_of(r), r.sorted);
  read_program_number(block, r);
  apply_parameter(block, r);
  remark_named_tool(block, r);
  if (has_other_codes(r.sorted)) {
    apply_codes(block, r);
  } else {
    apply_feed_and_tool(r);
    apply_motion(r);
    apply_tool_length(block, r);
    watch_other_axes(block, r);
  }
  note_begin_of_program(block, r);
  apply_speed_words(block, r);
  if (r.dialect.sinumerik_words) apply_tool_edge(r);
  const std::size_t moves = r.program.moves.size();
  if (r.sorted.unknown_code)
    read_anything(block, r, "the number of a code is a variable or an expression");
  else if (r.angle && !has_axis_word(r.sorted))
    read_anything(block, r, "ANG= needs exactly one of X and Y, in a line under G17");
  else
    apply_axis_words(block, r);
  if (r.program.moves.size() > moves)
    join_contour(r);
  else if (feeds_further_axes(r))
    note_feed_of_further_axes(block, r);
  refuse_beside_orientation(block, r);
  if (r.sorted.has(MAction::retract)) apply_retract(block, r);
  stop_spindle(r);
  r.own_feed.reset();
}

void read_words(const Block& block, Reading& r) {
  if (empty(block.block_delete)) return apply_words(block, r);
  // States that a skippable block sets are unknown afterwards.
  const ModalState before = r.state;
  apply_words(block, r);
  mark_differences_unknown(r.dialect, before, r.state);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (r.sorted.word(letters_of_axes[axis]) != nullptr) r.state.known[axis] = false;
    if (r.sorted.word("ABC"[axis]) != nullptr) r.state.known_angles[axis] = false;
  }
}

void end_program(const Block& block, Reading& r) {
  if (r.sorted.has(MAction::return_from_call)) return_from_call(block, r);
  if (r.sorted.has(MAction::end) && (r.body.jumps || r.body.open.empty())) r.ended = true;
}

void read_with_own_modes(const Block& block, Reading& r) {
  if (!block.has_own_mode) return read_words(block, r);
  apply_own_modes(block, r);
  read_words(block, r);
  r.block_relative.reset();
  r.relative_axes = 0;
}

/// A line of a Sinumerik with a statement.
void read_statement(const Block& block, Reading& r) {
  ++r.program.block_count;
  begin_statement(block, r);
  const bool words = (!block.words.empty() || !block.speed_words.empty()) && has_words_of_its_own(block, r);
  if (!words) forget_unread_speeds(block, r.state);
  if (words) read_with_own_modes(block, r);
  end_statement(block, r);
  if (words && empty(block.block_delete)) end_program(block, r);
}

}  // namespace

void interpret(const Block& block, Reading& r) {
  r.feed_before_mm_min = feed_mm_min(r);
  apply_comments(block, r);
  remark_length(block, r);
  if (r.dialect.sinumerik_words) note_declarations(block, r);
  if (!has_content(block)) return;
  if (!r.dialect.sinumerik_words) apply_variables(block, r);
  if (!empty(block.flow_keyword)) {
    if (block.words.empty() || block.words.front().letter == 'N') {
      read_flow(block, r);
      if (block.statement != Statement::none) end_statement(block, r);
      return;
    }
    refuse(r.program.file, block, block.flow_keyword.begin,
           "words are not allowed before a condition, a loop or a call");
  }
  const bool has_statement = block.statement != Statement::none || assigns_to_word(block, r);
  if (has_statement) return read_statement(block, r);
  if (block.words.empty() && block.speed_words.empty()) return;
  ++r.program.block_count;
  read_with_own_modes(block, r);
  if (empty(block.block_delete)) end_program(block, r);
}

}  // namespace counterflex
