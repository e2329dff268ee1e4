#include "program/gcode/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/expand/definitions.hpp"
#include "program/expand/expand.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/other_moves.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/offsets.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::string_view subprogram_by_number = "O";

/// Whether the compensation acts alike: behind the move that ends it, it does not act.
bool act_alike(Contour a, Contour b) {
  const auto is_off = [](Contour contour) { return contour == Contour::none || contour == Contour::leaving; };
  return a == b || (is_off(a) && is_off(b));
}

std::uint16_t differences(const ModalState& a, const ModalState& b) {
  std::uint16_t found = a.unknown_modes | b.unknown_modes;
  if (a.motion != b.motion) found |= unknown_motion;
  if (a.relative != b.relative) found |= unknown_distance;
  if (a.normal != b.normal) found |= unknown_plane;
  if (a.unit != b.unit || a.unit_is_of_lengths != b.unit_is_of_lengths) found |= unknown_unit;
  if (a.frame != b.frame) found |= unknown_offset;
  if (a.absolute_centres != b.absolute_centres) found |= unknown_centres;
  if (a.returns_to_retract != b.returns_to_retract) found |= unknown_level;
  if (!act_alike(a.contour, b.contour)) found |= unknown_cutter;
  if (a.feed_mode != b.feed_mode) found |= unknown_feed_mode;
  if (a.tool != b.tool) found |= unknown_tool;
  return found;
}

/// Shifts and turns that act in one of the states alone. A work offset does not end them.
std::uint16_t different_shifts(const Dialect& dialect, const ModalState& a, const ModalState& b) {
  std::uint16_t found = 0;
  if (a.shifts.set_mm != b.shifts.set_mm) found |= set_position;
  if (a.shifts.local_mm != b.shifts.local_mm) found |= dialect.sinumerik_words ? framed : shifted;
  if (a.shifts.turn_rad != b.shifts.turn_rad) found |= dialect.sinumerik_words ? framed : rotated;
  return found;
}

/// Feed and speed of the spindle that differ are unknown.
void mark_speeds_unknown(const ModalState& before, ModalState& now) {
  if (now.feed != before.feed || now.feed_unit != before.feed_unit) now.feed = 0;
  if (now.spindle_rpm != before.spindle_rpm) now.spindle_rpm = 0;
  if (now.feed_share != before.feed_share) now.feed_share = 0;
  now.feed_of_axes = now.feed_of_axes || before.feed_of_axes;
  if (now.main_spindle != before.main_spindle) now.main_spindle.reset();
  now.surface_speed = now.surface_speed || before.surface_speed;
  now.spindle_off = now.spindle_off || before.spindle_off;
}

/// Modal states that may have any value at the begin of a subprogram.
void forget_state(ModalState& state) {
  state.known.fill(false);
  state.unknown_modes = all_unknown_modes;
  state.displaced = 0;
  state.mirrored_axes = 0;
  state.modal_macros = 0;
  forget_speeds(state);
}

void open_body(Reading& r, std::string name) {
  if (r.body.open.empty()) {
    end_contour(r);
    r.body.left.reset();
  }
  r.body.open.push_back({std::move(name), r.state});
  r.state.known.fill(false);
}

void open_subprogram(Reading& r, std::string name) {
  const bool outermost = r.body.open.empty();
  const ModalState before = r.state;
  open_body(r, std::move(name));
  if (!outermost) return;
  r.body.open.back().before = before;
  r.body.subprogram = true;
  r.moved_by_machine.fill(true);
  forget_state(r.state);
}

/// "o100 sub".
void open_definition(const Block& block, Reading& r, const std::string& name) {
  if (!empty(block.block_delete))
    refuse(r.program.file, block, block.flow_keyword.begin,
           "'/' may skip the begin of this subprogram: then its body runs here; remove the '/'");
  if (r.body.open.empty())
    r.body.before_definition = {block.span.begin, r.program.moves.size(), r.program.operations.size(),
                                r.run_begin,      r.moved_by_machine,     r.operation,
                                r.variables};
  open_subprogram(r, name);
}

/// LinuxCNC reads a definition without executing it: its end restores everything. Behind a move of the
/// program, blocks of a definition are not moves. Before the first one they stay in the list: a text that
/// only defines subprograms is called from other files.
void close_definition(const Block& block, Reading& r) {
  BeforeDefinition& before = r.body.before_definition;
  if (r.program.before || before.moves > r.body.defined_moves) {
    r.program.moves.resize(before.moves);
    r.program.operations.resize(before.operations);
    r.program.operation_titles.resize(before.operations);
    r.operation = std::move(before.operation);
    r.run_begin = before.run_begin;
    add_unused({before.begin, block.span.end}, r.program.expansion);
  } else {
    r.body.defined_moves = r.program.moves.size();
  }
  r.moved_by_machine = before.moved_by_machine;
  r.variables = std::move(before.variables);
  r.state = std::move(r.body.open.front().before);
  r.body.open.clear();
  r.body.subprogram = false;
}

void close_body(Reading& r) {
  const ModalState before = std::move(r.body.open.back().before);
  r.body.open.pop_back();
  const bool outermost = r.body.open.empty();
  if (outermost && r.body.subprogram) {
    r.state = before;
    r.body.subprogram = false;
    return;
  }
  mark_differences_unknown(r.dialect, before, r.state);
  if (outermost && r.body.left) mark_differences_unknown(r.dialect, *r.body.left, r.state);
  r.state.known.fill(false);
}

/// A path through the body leaves it here, or starts again.
void note_differences(Reading& r) {
  if (r.body.open.empty()) return;
  if (r.body.left)
    mark_differences_unknown(r.dialect, r.state, *r.body.left);
  else
    r.body.left = r.state;
}

/// "O100" and "SPINDLE_ON" of the names "100" and "<spindle_on>" of O-words.
std::string called_program(const std::string& name) {
  return name.starts_with('<') ? name.substr(1, name.find('>') - 1) : "O" + name;
}

void call(const Block& block, Reading& r, const std::string& program) {
  ++r.program.block_count;
  r.sorted = {};
  read_call(block, r, program);
}

bool sets(const Reading& r, CodeGroup group) {
  return (r.begin.groups >> static_cast<unsigned>(group) & 1) != 0;
}

/// The coordinates at the end of the program that its begin does not set again; else empty.
std::string_view coordinates_left(const Reading& r) {
  const FrameShifts& shifts = r.state.shifts;
  unsigned left = r.state.displaced;
  if (!shifts.local_mm.isZero(0)) left |= shifted;
  if (!shifts.set_mm.isZero(0)) left |= set_position;
  if (shifts.turn_rad != 0) left |= rotated;
  left &= ~unsigned{r.begin.ended};
  if ((left & shifted) != 0) return "G52 shifts the coordinates";
  if ((left & set_position) != 0 || r.begin.takes_position) return "G92 or G52 has set the coordinates";
  if ((left & rotated) != 0) return "the coordinates are rotated";
  if ((left & data) != 0 || r.state.offsets_set != 0 || r.offsets != r.begin.offsets)
    return "G10 has changed a work offset";
  const auto moved = [](const auto& offset) { return !offset.second.moved_mm.isZero(0); };
  if (std::ranges::any_of(r.offsets, moved)) return "G10 L20 has changed a work offset";
  return left != 0 ? "the coordinates are not those of the work offset" : std::string_view();
}

/// A state that the first pass begins with and a repetition may not.
struct StateLeft {
  CodeGroup group;
  bool differs;
  unsigned doubt;  ///< its bit of `unknown_modes`
  std::string_view if_differs, if_unknown;
};

/// The state at the end of the program with which a repetition would differ from the first pass; else empty.
std::string_view state_left(const Reading& r) {
  if (const std::string_view coordinates = coordinates_left(r); !coordinates.empty()) return coordinates;
  const ModalState& state = r.state;
  const std::string& offset = r.program.frames[state.frame].work_offset;
  const std::array states{StateLeft{CodeGroup::offset, !offset.empty() && offset != "G54", unknown_offset,
                                    "the work offset is not G54", "the work offset is not known to be G54"},
                          StateLeft{CodeGroup::distance, state.relative, unknown_distance, "G91 is active",
                                    "G90 is not known to be active"},
                          StateLeft{CodeGroup::unit, state.unit != r.options.unit, unknown_unit,
                                    "the unit is another one", "the unit is not known to be the first one"},
                          StateLeft{CodeGroup::plane, state.normal != 2, unknown_plane, "G17 is not active",
                                    "G17 is not known to be active"},
                          StateLeft{CodeGroup::arc, state.absolute_centres != r.options.absolute_centres,
                                    unknown_centres, "the centres of arcs are read in another way",
                                    "the centres of arcs are not known to be read in the first way"},
                          StateLeft{CodeGroup::cutter, state.contour == Contour::inside, unknown_cutter,
                                    "G41 or G42 is active", "G40 is not known to be active"}};
  for (const StateLeft& left : states) {
    if (sets(r, left.group)) continue;
    if ((state.unknown_modes & left.doubt) != 0) return left.if_unknown;
    if (left.differs) return left.if_differs;
  }
  return !r.begin.changes_tool && state.tool != 0 ? "the tool was changed" : std::string_view();
}

/// M99 and M47 of a main program repeat it without its first state.
void check_repetition(const Block& block, const Reading& r) {
  const std::string_view why = state_left(r);
  if (why.empty()) return;
  for (const FoundM& m : r.sorted.m)
    if (m.action == MAction::return_from_call)
      refuse_word(
          block, r, *m.word,
          fmt::format("M{} repeats the program, but at its end {}, which the blocks before its first "
                      "move do not set again: the second pass may cut at another place; set this state "
                      "before the first move, or end with M30",
                      m.code, why));
}

struct FlowLine {
  std::string name;
  std::string_view keyword;
  bool is(std::string_view wanted) const { return is_word(keyword, wanted); }
};

bool opens(const FlowLine& line) {
  return line.is("IF") || line.is("WHILE") || line.is("DO") || line.is("REPEAT");
}

bool closes(const FlowLine& line) {
  return line.is("ENDIF") || line.is("ENDWHILE") || line.is("ENDREPEAT") || line.is("ENDSUB");
}

/// Whether the line ends the outermost definition, as LinuxCNC looks for its end: by the name alone.
bool ends_definition(const Reading& r, const FlowLine& line) {
  if (!line.is("ENDSUB") || !r.body.subprogram) return false;
  const std::string begun = normal_name(r.body.open.front().name), ended = normal_name(line.name);
  const bool is_computed = begun.empty() || ended.empty();
  return is_computed ? r.body.open.size() == 1 : begun == ended;
}

[[noreturn]] void refuse_end(const Block& block, const Reading& r, const FlowLine& line) {
  refuse(r.program.file, block, block.flow_keyword.begin, fmt::format("'{}' has no beginning", line.keyword));
}

void read_o_word(const Block& block, Reading& r, const FlowLine& line) {
  const std::string opened_do = line.name + " DO";
  if (line.is("CALL")) return call(block, r, called_program(line.name));
  if (line.is("SUB")) return open_definition(block, r, line.name);
  if (ends_definition(r, line)) return close_definition(block, r);
  if (closes(line)) {
    if (r.body.open.empty()) refuse_end(block, r, line);
    return close_body(r);
  }
  if (line.is("WHILE") && !r.body.open.empty() && r.body.open.back().name == opened_do) return close_body(r);
  if (opens(line)) return open_body(r, line.is("DO") ? opened_do : line.name);
  note_differences(r);
}

/// IF jumps or assigns. Jumps make the whole program a body.
void read_macro_word(const Block& block, Reading& r, const FlowLine& line) {
  if (line.is("WHILE") || line.is("DO")) return open_body(r, "DO");
  if (!line.is("END")) return;
  if (r.body.open.empty()) refuse_end(block, r, line);
  close_body(r);
}

bool opens_structure(const FlowLine& line) {
  return line.is("IF") || line.is("WHILE") || line.is("FOR") || line.is("LOOP") || line.is("REPEAT");
}

/// IF to ENDIF, FOR to ENDFOR, LOOP to ENDLOOP, REPEAT to UNTIL of a Sinumerik.
void read_structure(const Block& block, Reading& r, const FlowLine& line) {
  if (opens_structure(line)) return open_body(r, std::string(line.keyword));
  if (line.is("ELSE")) return note_differences(r);
  if (r.body.open.empty()) refuse_end(block, r, line);
  close_body(r);
}

}  // namespace

void read_flow(const Block& block, Reading& r) {
  r.body.begun = 0;
  const std::string_view text = r.program.text;
  const FlowLine line{std::string(part(text, block.flow_name)), part(text, block.flow_keyword)};
  if (r.dialect.sinumerik_words) return read_structure(block, r, line);
  r.dialect.o_words ? read_o_word(block, r, line) : read_macro_word(block, r, line);
}

void read_program_number(const Block& block, Reading& r) {
  const Word* o = r.sorted.word('O');
  if (o == nullptr) return;
  const std::vector<bool>& known = r.outline.subprograms;
  bool subprogram = false;
  if (is_numbered(part(r.program.text, block.span))) {
    subprogram = r.program_numbers < known.size() && known[r.program_numbers];
    ++r.program_numbers;
  }
  const bool misplaced =
      !begins_with_program_number(block) || (!subprogram && r.program.block_count > 1 && !r.after_subprogram);
  if (misplaced || !r.body.open.empty())
    refuse_word(block, r, *o,
                fmt::format("O{}: a program number must be alone in its line, first in the file or behind "
                            "the end of a program",
                            o->value));
  if (subprogram) open_subprogram(r, std::string(subprogram_by_number));
}

void note_begin_of_program(const Block& block, Reading& r) {
  if (r.program.before || r.in_body() || !empty(block.block_delete)) return;
  if (r.sorted.has(MAction::tool_change) && !r.begin.changes_tool)
    r.begin.changes_tool = std::ranges::none_of(
        r.program.moves, [](const Move& move) { return move.motion == Motion::feed || move.cycle; });
  if (!r.program.moves.empty()) return;
  // LinuxCNC and Mach3 store G52 and G92 in the same place.
  const std::uint16_t shift_bits = r.dialect.macro_words ? shifted : shifted | set_position;
  const bool all_axes = r.sorted.word('X') && r.sorted.word('Y') && r.sorted.word('Z');
  for (const FoundG& g : r.sorted.g) {
    r.begin.groups |= std::uint32_t{1} << static_cast<unsigned>(g.code->group);
    if (g.code->action == Action::end_displace && ends_all_axes(r, *g.code)) r.begin.ended |= g.code->bit;
    if (g.code->action == Action::shift && all_axes) r.begin.ended |= shift_bits;
  }
  r.begin.offsets = r.offsets;
}

void return_from_call(const Block& block, Reading& r) {
  if (r.body.subprogram && r.body.open.size() == 1) {
    close_body(r);
    r.after_subprogram = true;
  } else if (r.body.open.empty()) {
    if (!r.body.jumps) check_repetition(block, r);
    r.ended = !r.body.jumps || r.sorted.word('P') == nullptr;  // M99 P10 jumps to N10
  } else {
    note_differences(r);
  }
}

void mark_differences_unknown(const Dialect& dialect, const ModalState& before, ModalState& now) {
  now.level_is_stated = now.level_is_stated && before.level_is_stated;
  now.unknown_modes |= differences(before, now);
  mark_speeds_unknown(before, now);
  now.displaced |= before.displaced;
  now.mirrored_axes |= before.mirrored_axes;
  now.modal_macros = std::max(now.modal_macros, before.modal_macros);
  now.displaced |= different_shifts(dialect, before, now);
  now.offsets_set |= before.offsets_set;
  if (now.tool_length != before.tool_length) {
    now.tool_length.reset();
    now.tool_length_mm.reset();
    now.known[2] = false;
    now.cycle.initial.reset();
  }
  if (now.cutter_diameter_mm != before.cutter_diameter_mm) now.cutter_diameter_mm.reset();
  if (now.tool != before.tool) now.tool = 0;
  if (now.tool_chosen != before.tool_chosen) now.tool_chosen.reset();
  now.exact_stop = now.exact_stop || before.exact_stop;
}

}  // namespace counterflex
