#include "program/siemens/statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/expand/control_flow.hpp"
#include "program/gcode/frames.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/other_moves.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/offsets.hpp"
#include "program/gcode/remarks.hpp"
#include "program/siemens/cycles.hpp"
#include "program/siemens/names.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool is_length_word(const Word& word) {
  return word.letter >= 'X' && word.letter <= 'Z';
}

/// Whether a displacement of this kind may be active.
bool is_displaced(const Reading& r, std::uint16_t bit) {
  const FrameShifts& shifts = r.state.shifts;
  const bool is_shifted = bit == framed && (shifts.turn_rad != 0 || !shifts.local_mm.isZero(0));
  return (r.state.displaced & bit) != 0 || is_shifted || (bit == modal_macro && r.called);
}

/// Begins a displacement of programmed coordinates that is not followed.
void displace_by_statement(const Block& block, Reading& r, std::uint16_t bit) {
  if (empty(block.block_delete) && !is_displaced(r, bit)) r.body.begun |= bit;
  r.state.displaced |= bit;
  if (bit != modal_macro) r.state.known.fill(false);
  end_contour(r);
  note_uncorrected(block, r, why_not_followed(r));
}

/// Ends it. A block that may not run, or not at this place, leaves it unknown, unless it ends what the blocks
/// before it have begun.
void end_displacement(const Block& block, Reading& r, std::uint16_t bit) {
  if (!is_displaced(r, bit)) return;
  const bool ends = empty(block.block_delete) && (!r.in_body() || (r.body.begun & bit) != 0);
  if (!ends) return displace_by_statement(block, r, bit);
  if ((r.state.displaced & bit) == 0) return;
  r.state.displaced &= static_cast<std::uint16_t>(~bit);
  r.state.known.fill(false);
  end_contour(r);
}

void displace_or_end(const Block& block, Reading& r, std::uint16_t bit) {
  block.statement_is_bare ? end_displacement(block, r, bit) : displace_by_statement(block, r, bit);
}

/// A modal call that is not followed calls a macro at every move.
void call_modally(const Block& block, Reading& r) {
  if (block.statement_is_bare) {
    end_displacement(block, r, modal_macro);
    r.called.reset();
    return;
  }
  if (empty(block.block_delete) && !r.in_body())
    end_displacement(block, r, modal_macro);
  else if (r.called)
    r.state.displaced |= modal_macro;
  if (!begin_modal_cycle(block, r)) displace_by_statement(block, r, modal_macro);
}

/// "$P_UIFR[2,X,TR]": the work offset with this index; empty if the index is an expression.
std::string offset_of_index(std::string_view variable) {
  constexpr int settable = 4, highest = 99;
  const std::size_t open = std::min(variable.find('['), variable.size());
  const std::string_view list = variable.substr(std::min(open + 1, variable.size()));
  const auto index = read_number(trimmed_text(list.substr(0, list.find_first_of(",]"))));
  if (!index || *index < 0 || *index > highest || *index != std::floor(*index)) return {};
  const int number = static_cast<int>(*index);
  return number > 0 && number <= settable ? fmt::format("G{}", 53 + number)
                                          : fmt::format("G{}", 500 + number);
}

/// Whether the next work offset ends the effect of the variable: the active settable frame, data of tools.
bool ends_with_work_offset(std::string_view name) {
  return is_word(name, "$P_IFRAME") || is_word(name.substr(0, 4), "$TC_");
}

/// "AX" of "AX[X]".
std::string_view name_of(std::string_view variable) {
  return variable.substr(0, variable.find_first_of(" \t["));
}

/// Coordinates may change until a statement sets them: a work offset, TRANS; for other variables to the end.
void set_control_variable(const Block& block, Reading& r, std::string_view variable) {
  const std::string_view name = name_of(variable);
  if (is_word(name, "$P_PFRAME")) return displace_by_statement(block, r, framed);
  r.state.unknown_modes |= unknown_offset;
  r.state.known.fill(false);
  if (is_word(name, "$P_UIFR"))
    note_offset_set(r, offset_of_index(variable));
  else if (!ends_with_work_offset(name))
    note_offset_set(r, {});
}

void set_control_variables(const Block& block, Reading& r) {
  const std::string_view text = r.program.text;
  if (block.assignments.empty()) set_control_variable(block, r, {});
  for (const Assignment& assignment : block.assignments)
    if (const std::string_view variable = part(text, assignment.variable);
        variable.starts_with('$') && !is_harmless_variable(name_of(variable)))
      set_control_variable(block, r, variable);
  note_uncorrected(block, r, "a variable of the control is set");
}

/// Variables of the control are `Statement::data`. Words of one letter, as R1= and H1=, have their meaning
/// from `lex_siemens`. No word of the control begins with '_'.
bool is_variable(std::string_view name, const Reading& r) {
  const bool letter = name.find_first_not_of("0123456789", 1) == std::string_view::npos;
  return letter || name[0] == '_' || name[0] == '$' || r.declared.contains(upper_case(name));
}

/// Names before '=' that are not variables.
std::vector<std::string_view> assigned_words(const Block& block, const Reading& r) {
  std::vector<std::string_view> words;
  for (const Assignment& assignment : block.assignments)
    if (const auto name = name_of(part(r.program.text, assignment.variable));
        empty(assignment.type) && !is_variable(name, r))
      words.push_back(name);
  return words;
}

/// The next moves reach their positions with another offset of the tool.
void change_tool_offset(const Block& block, Reading& r, std::string_view name) {
  r.state.known.fill(false);
  r.state.tool_length.reset();
  r.state.tool_length_mm.reset();
  end_contour(r);
  note_uncorrected(block, r, fmt::format("'{}' changes the offset of the tool by an unknown length", name));
}

void apply_assigned_words(const Block& block, Reading& r) {
  for (const std::string_view name : assigned_words(block, r)) {
    if (is_tool_offset_name(name)) {
      change_tool_offset(block, r, name);
      continue;
    }
    r.sorted = {};
    return read_unknown_word(block, r, name);
  }
}

/// "L700", and SPINDLE of CALL "SPINDLE" and EXTCALL("SPINDLE"). Empty beside words of a motion.
std::string_view called_program(const Block& block, const Reading& r) {
  if (std::any_of(block.words.begin(), block.words.end(), is_length_word)) return {};
  const std::string_view text = part(r.program.text, block.statement_text);
  const std::size_t name = std::find_if_not(text.begin(), text.end(), is_identifier_character) - text.begin();
  const std::string_view head = text.substr(0, name);
  if (!is_word(head, "CALL") && !is_word(head, "EXTCALL")) return head;
  const std::size_t quote = std::min(text.find('"'), text.size() - 1) + 1;
  return text.substr(quote, text.find('"', quote) - quote);
}

void call_subprogram(const Block& block, Reading& r) {
  const std::string_view program = called_program(block, r);
  r.sorted = {};
  read_call(block, r, program);
}

/// Measuring cycles that may write a work offset, or the kinematics of the machine, with what they measure.
bool measures_offset(const Block& block, const Reading& r) {
  constexpr auto cycles =
      std::to_array<std::string_view>({"CYCLE961", "CYCLE974", "CYCLE977", "CYCLE978", "CYCLE979", "CYCLE994",
                                       "CYCLE996", "CYCLE997", "CYCLE998"});
  return is_one_of(part(r.program.text, block.statement_text).substr(0, cycles[0].size()), cycles);
}

/// The arguments of the block's call, without blanks.
std::vector<std::string_view> arguments_of(const Block& block, const Reading& r) {
  std::string_view list = part(r.program.text, block.statement_text);
  list.remove_prefix(std::min(list.find('('), list.size() - 1) + 1);
  list = list.substr(0, list.rfind(')'));
  std::vector<std::string_view> arguments;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= list.size(); ++at) {
    if (at < list.size() && list[at] == '"') quoted = !quoted;
    if (at < list.size() && (quoted || list[at] != ',')) continue;
    arguments.push_back(trimmed_text(list.substr(begin, at - begin)));
    begin = at + 1;
  }
  return arguments;
}

bool is_zero_or_left_out(std::string_view argument) {
  return argument.empty() || read_number(argument) == 0.0;
}

/// Whether CYCLE800 has only zeros for angles and shifts, and replaces a swivel before it (_ST with 0 units).
bool swivels_by_zero(const Block& block, const Reading& r) {
  constexpr std::size_t status = 2, first_shift = 4, last_shift = 12;
  const std::vector<std::string_view> arguments = arguments_of(block, r);
  const std::optional<double> added = arguments.size() > status ? read_number(arguments[status]) : 0.0;
  bool zero = arguments.size() > status && added && std::fmod(*added, 10) == 0;
  for (std::size_t i = first_shift; i < arguments.size() && i <= last_shift; ++i)
    zero = zero && is_zero_or_left_out(arguments[i]);
  return zero;
}

/// CYCLE800 without angles and shifts may retract the tool, and turns the rotary axes to their zero.
void swivel_by_zero(const Block& block, Reading& r) {
  end_displacement(block, r, tilted);
  for (std::size_t axis = 0; axis < 3; ++axis) move_by_machine(r, axis);
  end_contour(r);
  r.run_begin = r.program.moves.size();
  r.last_reason = "CYCLE800 without angles and shifts may retract to a position of the machine";
  r.program.left_alone.push_back({block.line, r.last_reason, true, block.text_line});
}

/// Cycles move according to their arguments and restore modal states.
void run_cycle(const Block& block, Reading& r) {
  std::string_view why = why_not_followed(r);
  if (why.empty() && !empty(block.block_delete)) why = "'/' may skip this cycle";
  r.sorted = {};
  Move& move = start_move(block, r, Motion::feed);
  for (std::size_t axis = 0; axis < 3; ++axis) fix_axis(r, move, axis);
  note_uncorrected(block, r,
                   why.empty() ? "this cycle of the control is not supported; supported in G17 and mm: "
                                 "CYCLE81 to CYCLE89, CYCLE840, "
                                 "POCKET1 to POCKET4, SLOT1, SLOT2, LONGHOLE, CYCLE71, CYCLE76 and CYCLE77, "
                                 "with plain numbers for heights and centre"
                               : why);
  finish_move(r, move);
  r.run_begin = r.program.moves.size();
  if (measures_offset(block, r)) set_control_variable(block, r, {});
}

/// CYCLE800. Bare, it ends the swivel without a retraction.
void swivel(const Block& block, Reading& r) {
  const bool framed_before = is_displaced(r, framed);
  const bool runs_once = empty(block.block_delete) && !r.in_body() && r.state.unknown_modes == 0;
  if (block.statement_is_bare && !framed_before && !is_displaced(r, tilted)) return;
  if (!block.statement_is_bare && !framed_before && runs_once && swivels_by_zero(block, r))
    return swivel_by_zero(block, r);
  run_cycle(block, r);
  displace_or_end(block, r, tilted);
}

}  // namespace

void note_declarations(const Block& block, Reading& r) {
  for (const Assignment& assignment : block.assignments)
    if (!empty(assignment.type))
      r.declared.insert(upper_case(name_of(part(r.program.text, assignment.variable))));
}

bool assigns_to_word(const Block& block, const Reading& r) {
  return r.dialect.sinumerik_words && block.assigns_by_name && !assigned_words(block, r).empty();
}

void begin_statement(const Block& block, Reading& r) {
  if (block.statement == Statement::curve) r.state.unknown_modes |= unknown_motion;
}

bool has_words_of_its_own(const Block& block, const Reading&) {
  if (block.statement == Statement::curve || block.statement == Statement::smoothed) return true;
  const bool is_frame = block.statement >= Statement::shift && block.statement <= Statement::added_turn;
  const auto of_frame = [](const Word& word) {
    return std::string_view("NXYZR").find(word.letter) != std::string_view::npos;
  };
  if (is_frame && std::all_of(block.words.begin(), block.words.end(), of_frame)) return false;
  return std::none_of(block.words.begin(), block.words.end(), is_length_word);
}

namespace {

/// The displacement that a statement begins, or may begin; 0 without one.
std::uint16_t displacement_of(Statement statement) {
  if (statement >= Statement::shift && statement <= Statement::added_frame) return framed;
  if (statement == Statement::modal_call) return modal_macro;
  if (statement == Statement::tilt) return tilted;
  return statement == Statement::transformed ? tool_point : 0;
}

/// Whether axis words are before a statement that the control reads in a block of its own only.
bool has_words_before_statement(const Block& block) {
  const Statement what = block.statement;
  const bool alone = displacement_of(what) != 0 || what == Statement::cycle ||
                     what == Statement::transform_off || what == Statement::end;
  return alone && std::any_of(block.words.begin(), block.words.end(), [&](const Word& word) {
           return is_length_word(word) && word.span.begin < block.statement_text.begin;
         });
}

/// RET.
void end_by_statement(const Block& block, Reading& r) {
  if (empty(block.block_delete) && (r.body.jumps || r.body.open.empty())) r.ended = true;
}

/// Whether the words move, and whether the statement acts, is not known.
void read_words_before_statement(const Block& block, Reading& r) {
  r.sorted = {};
  read_anything(block, r, "axis words are before a statement that needs a block of its own");
  if (const std::uint16_t bit = displacement_of(block.statement)) displace_by_statement(block, r, bit);
  if (block.statement == Statement::end) end_by_statement(block, r);
}

}  // namespace

void end_statement(const Block& block, Reading& r) {
  if (has_words_before_statement(block)) return read_words_before_statement(block, r);
  // A block that is not read makes the position unknown by itself.
  if (block.assigns_by_name && block.statement != Statement::not_read) apply_assigned_words(block, r);
  switch (block.statement) {
    case Statement::call:
      return call_subprogram(block, r);
    case Statement::not_read:
      r.sorted = {};
      return read_anything(block, r, "a part of the block that is not supported has axis words or G codes");
    case Statement::cycle:
      r.sorted = {};
      if (read_called_cycle(block, r)) return;
      return run_cycle(block, r);
    case Statement::modal_call:
      return call_modally(block, r);
    case Statement::shift:
    case Statement::added_shift:
    case Statement::turn:
    case Statement::added_turn:
    case Statement::frame:
      if (!apply_frame_statement(block, r)) displace_or_end(block, r, framed);
      return;
    case Statement::added_frame:
      return displace_by_statement(block, r, framed);
    case Statement::tilt:
      return swivel(block, r);
    case Statement::transformed:
      return displace_by_statement(block, r, tool_point);
    case Statement::transform_off:
      return end_displacement(block, r, tool_point);
    case Statement::smoothed:
      return add_remark(r.program, block.line,
                        "the control smooths the path; corrections smaller than its tolerance can vanish");
    case Statement::data:
      return set_control_variables(block, r);
    case Statement::end:
      return end_by_statement(block, r);
    default:
      return;
  }
}

void apply_own_modes(const Block& block, Reading& r) {
  bool modal = r.state.relative;
  for (const Word& word : block.words)
    if (word.letter == 'G' && (word.value == 90 || word.value == 91)) modal = word.value == 91;
  if (std::none_of(block.words.begin(), block.words.end(), is_length_word)) return;
  bool all_relative = true, all_absolute = true;
  const auto relative = [&](const Word& word) {
    return word.mode == DistanceMode::modal ? modal : word.mode == DistanceMode::relative;
  };
  for (const Word& word : block.words) {
    if (!is_length_word(word)) continue;
    all_relative = all_relative && relative(word);
    all_absolute = all_absolute && !relative(word);
  }
  if (all_relative != modal) r.block_relative = all_relative;
  if (all_relative || all_absolute) return;
  for (const Word& word : block.words)
    if (is_length_word(word) && relative(word))
      r.relative_axes = (r.relative_axes | 1U << (word.letter - 'X')) & 7U;
}

void apply_tool_edge(Reading& r) {
  if (r.sorted.has(MAction::tool_change)) r.state.tool_length = 1;
  const Word* d = r.sorted.word('D');
  if (d == nullptr || (d->literal && r.state.tool_length == d->value)) return;
  r.state.known[2] = false;
  r.state.tool_length.reset();
  if (d->literal) r.state.tool_length = d->value;
}

}  // namespace counterflex
