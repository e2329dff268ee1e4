#include "program/gcode/moves/other_moves.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/expand/expand.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/remarks.hpp"
#include "program/siemens/names.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {

void add_machine_move(const Block& block, Reading& r, const FoundG& found) {
  const bool reference = found.code->action == Action::reference_move;
  // SUPA has the effect of G153.
  const std::string_view word = part(r.program.text, found.word->span);
  const std::string code = upper(word[0]) == 'G' ? fmt::format("G{}", found.word->value) : upper_case(word);
  if (!reference && !has_axis_word(r.sorted) && !r.sorted.has_any("ABCUVW") && !r.in_body())
    refuse_word(block, r, *found.word, code + " has no axis word");
  const bool all = !has_axis_word(r.sorted);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (all || r.sorted.word(letters_of_axes[axis]) != nullptr) move_by_machine(r, axis);
  if (all || r.sorted.has_any("ABC")) r.state.known_angles.fill(false);
  end_contour(r);
  r.run_begin = r.program.moves.size();
  r.last_reason = code + " moves to a position of the machine";
  // G53 of Fanuc is a rapid under any motion.
  const bool feeds =
      !reference && r.state.motion == MotionMode::feed && (r.dialect.family & fanuc_family) == 0;
  r.program.left_alone.push_back({block.line, r.last_reason, true, block.text_line, feeds});
}

void apply_retract(const Block& block, Reading& r) {
  move_by_machine(r, 2);
  end_contour(r);
  r.run_begin = r.program.moves.size();
  r.last_reason = "M25 may move Z to a position of the machine";
  r.program.left_alone.push_back({block.line, r.last_reason, true, block.text_line});
}

void read_held(const Block& block, Reading& r, std::string_view what, bool end_known) {
  Move& move = start_move(block, r, Motion::feed);
  place_words(block, r, move);
  move.handling = Handling::held;
  move.may_insert_words = false;
  if (end_known)
    forget_way(move);
  else
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (r.sorted.word(letters_of_axes[axis]) != nullptr) r.state.known[axis] = false;
  if (why_not_followed(r).empty()) note_uncorrected(block, r, what);
  finish_move(r, move);
}

void read_own_way(const Block& block, Reading& r, const FoundG& found) {
  Move& move = start_move(block, r, Motion::feed);
  for (std::size_t axis = 0; axis < 3; ++axis) fix_axis(r, move, axis);
  const bool known = found.code->bit != unknown;
  note_uncorrected(block, r,
                   known ? fmt::format("G{} has a motion defined by the control", found.word->value)
                         : fmt::format("G{} is not known in dialect {}", found.word->value, r.dialect.name));
  finish_move(r, move);
}

void read_engraving(const Block& block, Reading& r, const FoundG& found) {
  bool plain = !r.state.relative && why_not_followed(r).empty();
  for (const char letter : {'X', 'Y', 'Z', 'R'})
    if (const Word* word = r.sorted.word(letter)) plain = plain && word->literal;
  const Word* plane = r.sorted.word('R');
  if (!plain || r.sorted.word('Z') == nullptr || plane == nullptr) return read_own_way(block, r, found);
  Move& move = start_move(block, r, Motion::feed);
  place_words(block, r, move);
  move.handling = Handling::held;
  CycleMove& text = move.cycle.emplace();
  text.bottom_mm = r.state.position_mm.z();
  text.bottom_word = move.words[2];
  text.retract_mm = length_mm(r, *plane);
  text.retract_word = AxisWord{plane->number, plane->decimals};
  text.may_insert_bottom = false;
  move.words[2].reset();
  // The end of the text is unknown, and so are the words of an interrupted cycle.
  r.state.known.fill(false);
  r.state.cycle = {};
  note_uncorrected(block, r, "the control engraves text");
  finish_move(r, move);
}

void read_pocket(const Block& block, Reading& r) {
  Move& move = start_move(block, r, Motion::feed);
  place_words(block, r, move);
  move.handling = Handling::held;
  move.may_insert_words = false;
  forget_way(move);
  if (why_not_followed(r).empty()) note_uncorrected(block, r, "the control cuts a round pocket");
  finish_move(r, move);
}

namespace {

/// A word of Sinumerik that is not read: "AP" beside other words or as the position of an axis. Empty for the
/// call of a subprogram.
std::string_view word_not_read(const Block& block, const Reading& r) {
  const std::string_view text = part(r.program.text, block.statement_text);
  const std::size_t size = std::find_if_not(text.begin(), text.end(), is_identifier_character) - text.begin();
  const std::string_view name = text.substr(0, size);
  const bool beside_words =
      std::any_of(block.words.begin(), block.words.end(), [](const Word& w) { return w.letter != 'N'; });
  return is_position_name(name) || beside_words ? name : std::string_view();
}

/// Modal states that text which is not read may set by a code of its dialect. No code of the others sets
/// G90.1 and G91.1, or on a Sinumerik G98 and G99.
std::uint16_t modes_of(const Dialect& dialect) {
  constexpr unsigned with_centres = linuxcnc_family | grbl_family | mach3_family;
  unsigned modes = all_unknown_modes;
  if ((dialect.family & with_centres) == 0) modes &= ~unsigned{unknown_centres};
  if (dialect.sinumerik_words) modes &= ~unsigned{unknown_level};
  return static_cast<std::uint16_t>(modes);
}

/// Whether the words of the block move the tool to a known place before M98 calls.
bool moves_before_call(const Block& block, Reading& r, Move& move) {
  const bool line = (r.state.motion == MotionMode::rapid || r.state.motion == MotionMode::feed) &&
                    std::ranges::all_of(r.sorted.g, [](const FoundG& g) {
                      return g.code->group == CodeGroup::motion || g.code->group == CodeGroup::distance;
                    });
  const bool follows = r.sorted.has(MAction::call) && line && !move.block_delete && has_axis_word(r.sorted) &&
                       !may_turn_tool(r) && why_not_followed(r).empty();
  for (const char letter : letters_of_axes)
    if (const Word* word = r.sorted.word(letter); follows && word != nullptr && !word->literal) return false;
  if (!follows) return false;
  place_words(block, r, move);
  return !any_axis(move.fixed) && all_known(r.state.known);
}

/// The block may move any axis and set modal states, but not coordinates.
void leave_to_control(const Block& block, Reading& r, std::string_view why) {
  Move& move = start_move(block, r, Motion::rapid);
  move.calls_at_end = moves_before_call(block, r, move);
  for (std::size_t axis = 0; axis < 3; ++axis) fix_axis(r, move, axis);
  move.relative = false;
  note_uncorrected(block, r, why);
  finish_move(r, move);
  end_contour(r);
  forget_speeds(r.state);
  constexpr std::uint16_t not_assumed =
      unknown_motion | unknown_distance | unknown_plane | unknown_centres | unknown_level;
  r.state.unknown_modes |= static_cast<std::uint16_t>(not_assumed & modes_of(r.dialect));
}

}  // namespace

void read_call(const Block& block, Reading& r, std::string_view program) {
  r.variables.clear();
  const bool is_own = r.outline.own_programs.contains(upper_case(program));
  if (!is_own && is_stated_harmless(r.program, r.options, block.line, program)) return;
  std::string why(why_not_expanded(r.program.expansion, block.text_line));
  if (!why.empty()) why = ", not expanded: " + why;
  if (!r.options.expand_subprograms && may_expand(r.dialect))
    why = " (--expand-subprograms replaces the call by its text)";
  const std::string_view word = word_not_read(block, r);
  leave_to_control(
      block, r, word.empty() ? "a subprogram is called" + why : fmt::format("'{}' is not supported", word));
  if (word.empty()) assume_of_calls(r.program, block.line);
}

void read_unknown_word(const Block& block, Reading& r, std::string_view name) {
  r.variables.clear();
  if (is_stated_harmless(r.program, r.options, block.line, name)) return;
  leave_to_control(block, r,
                   fmt::format("'{}=' is not supported; a variable needs DEF in this program, or its name in "
                               "harmless_calls of the machine file",
                               name));
  assume_of_calls(r.program, block.line);
}

void read_anything(const Block& block, Reading& r, std::string_view why) {
  r.state.unknown_modes = modes_of(r.dialect);
  r.variables.clear();
  forget_speeds(r.state);
  Move& move = start_move(block, r, Motion::rapid);
  for (std::size_t axis = 0; axis < 3; ++axis) fix_axis(r, move, axis);
  note_uncorrected(block, r, why);
  finish_move(r, move);
}

}  // namespace counterflex
