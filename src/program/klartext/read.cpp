#include "program/klartext/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/dialect.hpp"
#include "program/expand/control_flow.hpp"
#include "program/expand/expand.hpp"
#include "program/gcode/remarks.hpp"
#include "program/text/force_comment.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// The plain number behind `key` in `squeezed_text`.
std::optional<double> number_behind(std::string_view squeezed_text, char key) {
  for (std::size_t at = 0; at + 1 < squeezed_text.size(); ++at) {
    if (squeezed_text[at] != key) continue;
    std::string number;
    for (std::size_t i = at + 1; i < squeezed_text.size(); ++i) {
      const char c = squeezed_text[i];
      if ((c < '0' || c > '9') && c != '.' && c != ',') break;
      number += c == ',' ? '.' : c;
    }
    if (const auto value = read_number(number)) return value;
  }
  return std::nullopt;
}

void read_begin(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  if (rest.ends_with("MM")) r.state.unit = LengthUnit::millimetres;
  if (rest.ends_with("INCH")) r.state.unit = LengthUnit::inches;
}

/// F, FU or FZ of TOOL CALL, behind its "F": "500", "U0.1", "Z0.02", "Q3".
KlartextFeed feed_of_tool_call(const KlartextBlock& block, KlartextReading& r, std::string_view text) {
  const bool per_turn = text.starts_with('U'), inches = r.state.unit == LengthUnit::inches;
  if (per_turn) text.remove_prefix(1);
  const double value = std::max(klartext_value(block, r, text).value_or(0), 0.0);
  if (per_turn) return {value * mm_per(inches ? LengthUnit::inches : LengthUnit::millimetres), true};
  // Whether F is per minute or per turn under M136 is not known.
  return {r.state.feed_per_turn == false ? value * (inches ? 2.54 : 1.0) : 0, false};
}

/// S and F of TOOL CALL: a word begins with its letter and ends before the next letter that is not a Q
/// parameter's. "S(VC=120)" is a cutting speed, whose spindle speed is unknown.
void read_speeds_of_tool_call(const KlartextBlock& block, KlartextReading& r, std::string_view rest) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  while (!rest.empty()) {
    std::size_t key = std::min(rest.find_first_not_of(letters), rest.size());
    if (const std::size_t q = rest.find('Q'); q < key) key = q;  // SQ7, FUQ3, SQL2
    std::size_t end = std::min(rest.find_first_not_of(letters, key), rest.size());
    end = std::min(rest.find_first_of(letters, end), rest.size());
    const std::string_view name = rest.substr(0, key);
    if (name == "S") r.state.spindle_rpm = klartext_value(block, r, rest.substr(1, end - 1)).value_or(0);
    if (name.starts_with('F'))
      r.state.tool_feed = r.state.feed = feed_of_tool_call(block, r, rest.substr(1, end - 1));
    rest.remove_prefix(end);
  }
}

/// Number of characters of the tool at the begin of `rest`: 5, "MILL", Q5, QS5.
std::size_t size_of_tool(std::string_view rest) {
  constexpr std::string_view digits = "0123456789.";
  if (rest.starts_with('"')) return std::min(rest.find('"', 1), rest.size() - 1) + 1;
  const std::size_t number = rest.starts_with('Q') ? rest.find_first_of(digits) : 0;
  return std::min(rest.find_first_not_of(digits, number), rest.size());
}

/// `TOOL CALL 5 Z S3000 F500`, `TOOL CALL "MILL" Z S3000`, and `TOOL CALL S500`, which sets only the speed.
void read_tool_call(const KlartextBlock& block, KlartextReading& r) {
  std::string rest = squeezed(after_head(r.program.text, block));
  if (!rest.starts_with("CALL")) return;
  for (std::size_t i = 1; i < block.parts.size(); ++i) rest += squeezed(part(r.program.text, block.parts[i]));
  rest.erase(0, 4);
  const std::size_t end = size_of_tool(rest);
  KlartextState& state = r.state;
  if (end > 0) {
    state.tool = 0;
    std::from_chars(rest.data(), rest.data() + end, state.tool);
    if (rest[0] == '"' || rest[0] == 'Q')
      add_remark(r.program, line_of_file(r.program.expansion, block.line), std::string(tool_without_number));
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (r.tool_change_axes[axis]) move_by_machine(r, axis);
    state.run_begin = r.program.moves.size();
    state.contour = state.after_contour = false;
    rest.erase(0, end);
    if (!rest.empty() && rest[0] >= 'U' && rest[0] <= 'Z') state.tool_along_z = rest[0] == 'Z';
  }
  if (!rest.empty() && rest[0] >= 'U' && rest[0] <= 'Z') rest.erase(0, 1);
  read_speeds_of_tool_call(block, r, rest);
}

/// A corner by RND or CHF between the end of one move and the beginning of the next, which lie in one plane.
void read_corner(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  const CornerKind kind = block.head == "RND" ? CornerKind::round : CornerKind::side;
  const std::optional<double> size =
      kind == CornerKind::round ? number_behind(rest, 'R') : number_behind('=' + rest, '=');
  const double unit = mm_per(r.state.unit.value_or(LengthUnit::millimetres));
  r.state.corner = CornerSize{may_not_run(block, r) ? NAN : size.value_or(NAN) * unit, kind};
  if (r.program.moves.empty()) return;
  Move& last = r.program.moves.back();
  last.may_split = last.may_jump = false;
  expect_corner_behind(last);
}

/// "TNC:\\SPINDLE.H" of CALL PGM TNC:\\SPINDLE.H; empty for labels.
std::string_view called_program(const KlartextBlock& block, const KlartextReading& r) {
  const std::string_view call = trimmed_text(after_head(r.program.text, block));
  return is_word(call.substr(0, 3), "PGM") ? trimmed_text(call.substr(3)) : std::string_view();
}

void read_call(const KlartextBlock& block, KlartextReading& r) {
  const int line = line_of_file(r.program.expansion, block.line);
  if (is_stated_harmless(r.program, r.options, line, called_program(block, r))) return;
  const std::string_view why_left = why_not_expanded(r.program.expansion, block.line);
  std::string why = "a subprogram or a part of the program is called";
  if (!why_left.empty())
    why += fmt::format(" and cannot be put in the place of its call: {}", why_left);
  else if (squeezed(after_head(r.program.text, block)).starts_with("LBL"))
    why += " (--expand-subprograms replaces the call by its text)";
  add_unfollowed_move(block, r, why);
  forget_klartext_speeds(r.state);
  assume_of_calls(r.program, line);
}

/// What a probing cycle sets behind its measurement; empty for one that only measures.
std::string_view set_by_probe(int cycle) {
  if (cycle >= 400 && cycle <= 405) return "turns the coordinates (basic rotation)";
  if (cycle >= 408 && cycle <= 419) return "sets the datum";
  if (cycle >= 450 && cycle <= 453) return "may change the kinematics of the machine";
  if (cycle >= 1400 && cycle <= 1499) return "may set the datum or turn the coordinates";
  return {};
}

/// `TCH PROBE 411 DATUM OUTS. RECTAN. ~`
void read_probe(const KlartextBlock& block, KlartextReading& r) {
  constexpr int displacement_of_probe = 1400;
  const std::string rest = squeezed(after_head(r.program.text, block));
  int cycle = 0;
  const std::size_t digit = std::min(rest.find_first_of("0123456789"), rest.size());
  std::from_chars(rest.data() + digit, rest.data() + rest.size(), cycle);
  const std::string_view sets = set_by_probe(cycle);
  forget_klartext_speeds(r.state);
  add_unfollowed_move(block, r,
                      sets.empty() ? fmt::format("TCH PROBE {} is not supported", cycle)
                                   : fmt::format("TCH PROBE {} {}: coordinates are unknown", cycle, sets));
  if (!sets.empty()) r.state.displacements[displacement_of_probe] = r.last_reason;
}

/// PLANE SPATIAL SPA+0 SPB+0 SPC+0: the plane without a tilt.
bool is_plane_of_zeros(std::string_view plane) {
  constexpr std::string_view spatial = "SPATIAL";
  if (!plane.starts_with(spatial)) return false;
  plane.remove_prefix(spatial.size());
  for (const std::string_view angle : {"SPA", "SPB", "SPC"}) {
    if (!plane.starts_with(angle)) return false;
    plane.remove_prefix(angle.size());
    const std::size_t end = std::min(plane.find_first_not_of("+-.,0"), plane.size());
    if (plane.substr(0, end).find('0') == std::string_view::npos) return false;
    plane.remove_prefix(end);
  }
  return plane.empty() || !is_digit(plane[0]);
}

/// MOVE, TURN or STAY behind the angles. Without MOVE only rotary axes turn, and MB retracts before.
void read_plane(const KlartextBlock& block, KlartextReading& r) {
  std::string rest;
  for (const Span& line : block.parts) rest += squeezed(part(r.program.text, line));
  rest.erase(0, block.head.size());
  const bool resets = rest.starts_with("RESET") || is_plane_of_zeros(rest);
  if (!resets || rest.find("MOVE") != std::string::npos)
    add_unfollowed_move(block, r, "PLANE turns coordinates");
  else if (rest.find("MB") != std::string::npos)
    retract_klartext(block, r, "PLANE with MB retracts from the part along the tool");
  if (r.state.displacements.erase(19) > 0)
    r.state.known.fill(false), r.state.run_begin = r.program.moves.size();
  if (!resets) r.state.displacements[19] = "coordinates are tilted";
}

/// FUNCTION is not followed. That of parallel axes, of turning and of TCPM act until they are reset.
void read_function(const KlartextBlock& block, KlartextReading& r) {
  constexpr int tcpm = 128, parallel_axes = 1029, turning = 1030;  // numbers of displacements
  const std::string rest = squeezed(after_head(r.program.text, block));
  const auto acts = [&](int number) { return r.state.displacements.contains(number); };
  // Ends what does not act.
  if ((rest == "RESETTCPM" && !acts(tcpm)) || (rest == "MODEMILL" && !acts(turning))) return;
  forget_klartext_speeds(r.state);
  add_unfollowed_move(block, r, "FUNCTION is not supported");
  if (rest.starts_with("PARAXMODE"))
    set_displacement(r, parallel_axes, !rest.ends_with("OFF"), "FUNCTION PARAXMODE selects other axes");
  if (rest.starts_with("MODE"))
    set_displacement(r, turning, !rest.starts_with("MODEMILL"),
                     "FUNCTION MODE selects another machining mode");
  if (rest.starts_with("TCPM"))
    set_displacement(r, tcpm, true, "FUNCTION TCPM moves the linear axes with the rotary axes");
  if (rest.starts_with("RESETTCPM")) set_displacement(r, tcpm, false, "");
}

void read_nothing(const KlartextBlock&, KlartextReading&) {}

/// FN 17 and FN 25 write data of the control, such as the datum.
void watch_system_data(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  const bool writes = rest.starts_with("17:"), sets_datum = rest.starts_with("25:");
  if (block.head != "FN" || (!writes && !sets_datum)) return;
  const char* const what = writes ? "FN 17: SYSWRITE may change the coordinates"
                                  : "FN 25: PRESET sets the datum: coordinates are unknown";
  set_displacement(r, writes ? 1017 : 1025, true, what);
  add_remark(r.program, line_of_file(r.program.expansion, block.line), what);
}

/// The words of a cycle are parameters: if one is computed, it differs from its definition.
void read_parameter(const KlartextBlock& block, KlartextReading& r) {
  take_parameter(block, r);
  watch_system_data(block, r);
  if (block.head == "Q") return read_cycle_parameter(block, r);
  const std::string_view computed = after_head(r.program.text, block);
  if (computed.find("201") != std::string_view::npos) r.state.depth_mm.reset();
  if (computed.find("203") != std::string_view::npos) r.state.surface.reset();
  if (computed.find("206") != std::string_view::npos) r.state.plunging_feed_mm_min = 0;
}

void read_end(const KlartextBlock&, KlartextReading& r) {
  r.ended = true;
}

struct KnownStatement {
  std::string_view head;
  void (*read)(const KlartextBlock&, KlartextReading&);
};

constexpr std::array statement_readers{
    KnownStatement{"L", read_klartext_motion},
    KnownStatement{"C", read_klartext_motion},
    KnownStatement{"CR", read_klartext_motion},
    KnownStatement{"CT", read_klartext_motion},
    KnownStatement{"CP", read_klartext_motion},
    KnownStatement{"LP", read_klartext_motion},
    KnownStatement{"CC", read_klartext_pole},
    KnownStatement{"M", read_klartext_codes},
    KnownStatement{"CYCL", read_klartext_cycle},
    KnownStatement{"CYCLE", read_klartext_cycle},
    KnownStatement{"TOOL", read_tool_call},
    KnownStatement{"RND", read_corner},
    KnownStatement{"CHF", read_corner},
    KnownStatement{"CALL", read_call},
    KnownStatement{"APPR", read_klartext_approach},
    KnownStatement{"DEP", read_klartext_approach},
    KnownStatement{"PLANE", read_plane},
    KnownStatement{"TRANS", read_transformation},
    KnownStatement{"TCH", read_probe},
    KnownStatement{"PRESET", read_preset},
    KnownStatement{"FUNCTION", read_function},
    KnownStatement{"BEGIN", read_begin},
    KnownStatement{"END", read_end},
    KnownStatement{"BLK", read_nothing},
    KnownStatement{"STOP", read_nothing},
    KnownStatement{"LBL", read_nothing},
    KnownStatement{"FN", read_parameter},
    KnownStatement{"Q", read_parameter},
    KnownStatement{"QL", read_nothing},
    KnownStatement{"QR", read_nothing},
    KnownStatement{"QS", read_nothing},
    KnownStatement{"DECLARE", read_nothing},
    KnownStatement{"IF", read_nothing},
    KnownStatement{"ERROR", read_nothing},
};

/// Coordinates in a block that does not move: the control refuses it.
void refuse_coordinate(const KlartextBlock& block, const KlartextReading& r) {
  constexpr std::array<std::string_view, 5> heads{"RND", "CHF", "STOP", "LBL", "TOOL"};
  if (std::find(heads.begin(), heads.end(), block.head) == heads.end()) return;
  const std::size_t at = find_coordinate(r.program.text, block);
  if (at == std::string_view::npos) return;
  refuse_klartext(r.program.text, r.program.file, block, at,
                  fmt::format("{} is not allowed in a block with {}: write it in a block of its own with L",
                              upper(r.program.text[at]), block.head));
}

void refuse_conflict_marker(const KlartextBlock& block, const KlartextReading& r) {
  const std::string_view line = part(r.program.text, block.parts[0]);
  for (const std::string_view marker : {"<<<<<<<", "=======", ">>>>>>>", "|||||||"})
    if (line.starts_with(marker))
      refuse_klartext(r.program.text, r.program.file, block, block.parts[0].begin,
                      fmt::format("'{}' is a conflict marker of a version control system", marker));
}

/// A structure line, "* - POCKET", is always a title.
void name_operation(std::string_view comment, KlartextReading& r) {
  if (comment.starts_with('*')) r.operation.expect_title();
  r.operation.name(comment, as_tool(r.state.tool));
}

/// A comment alone in its line names the operation, and so does a structure line.
void read_comments(const KlartextBlock& block, KlartextReading& r) {
  if (block.comments.empty() && block.parts.empty()) r.operation.expect_title();
  Block place;
  place.line = block.line;
  place.span = block.span;
  for (const Span& comment : block.comments) {
    if (const auto force = read_force_comment(r.program.text, r.program.file, place, comment))
      r.state.force = force->F, r.force_line = block.line;
    else if (block.parts.empty())
      name_operation(part(r.program.text, comment), r);
  }
}

/// A block that is neither a move nor a cycle may set parameters of the defined cycle.
void mark_definition_changed(const KlartextBlock& block, KlartextReading& r) {
  constexpr std::array<std::string_view, 11> harmless{"L",  "LP",  "C",   "CP",   "CR", "CT",
                                                      "CC", "RND", "CHF", "CYCL", "M"};
  if (r.state.surface && std::find(harmless.begin(), harmless.end(), block.head) == harmless.end())
    r.state.surface->repeatable = false;
}

void read_known_or_not(const KlartextBlock& block, KlartextReading& r) {
  const auto known = std::find_if(statement_readers.begin(), statement_readers.end(),
                                  [&](const KnownStatement& s) { return s.head == block.head; });
  refuse_coordinate(block, r);
  if (known != statement_readers.end()) return known->read(block, r);
  refuse_conflict_marker(block, r);
  forget_klartext_speeds(r.state);
  add_unfollowed_move(block, r,
                      fmt::format("{} is not supported", block.head.empty() ? "the block" : block.head));
}

}  // namespace

void read_statement(const KlartextBlock& block, KlartextReading& r) {
  read_comments(block, r);
  if (block.parts.empty()) return;
  ++r.program.block_count;
  mark_definition_changed(block, r);
  if (!may_not_run(block, r)) return read_known_or_not(block, r);
  const KlartextState before = r.state;
  read_known_or_not(block, r);
  mark_changes_unknown(before, r.state);
}

bool may_not_run(const KlartextBlock& block, const KlartextReading& r) {
  return !empty(block.block_delete) || may_skip_or_repeat(r);
}

bool may_skip_or_repeat(const KlartextReading& r) {
  return contains(r.outline.uncertain, r.place);
}

void add_move(KlartextReading& r, Move move) {
  r.program.moves.push_back(std::move(move));
  ++r.moves_read;
}

void note_uncorrected(KlartextReading& r, int line, std::string why) {
  if (r.last_reason != why) add_uncorrected(r, {.line = line, .why = std::move(why)});
}

void add_uncorrected(KlartextReading& r, LeftAlone left) {
  if (!r.program.expansion.lines.empty()) left.text_line = left.line;
  left.line = line_of_file(r.program.expansion, left.line);
  r.last_reason = left.why;
  r.program.left_alone.push_back(std::move(left));
}

void add_unfollowed_move(const KlartextBlock& block, KlartextReading& r, std::string why) {
  Move move = begin_klartext_move(block, r);
  move.fixed.fill(true);
  r.state.known.fill(false);
  r.state.contour = r.state.after_contour = false;
  r.state.pole.reset();
  r.state.surface.reset();
  r.variables.clear();  // the unknown block may set them
  add_move(r, std::move(move));
  r.state.run_begin = r.program.moves.size();
  note_uncorrected(r, block.line, std::move(why));
}

void call_relative_cycle(const KlartextBlock& block, KlartextReading& r, Move& move) {
  if (r.state.cycle_returns) {
    move.makes_hole = true;
    if (move.motion == Motion::rapid) move.feed_mm_min = 0;  // that of the definition is not read
    return note_uncorrected(r, block.line, "holes are held");
  }
  move.mills_at_end = true;
  r.state.known.fill(false);
  note_uncorrected(r, block.line, std::string(milled_as_a_whole));
}

void add_cycle_call(const KlartextBlock& block, KlartextReading& r) {
  const bool followed = r.state.displacements.empty() && !may_skip_or_repeat(r) && empty(block.block_delete);
  if (r.state.cycle_is_relative && followed) {
    if (!r.program.moves.empty()) call_relative_cycle(block, r, r.program.moves.back());
    return;
  }
  if (!r.state.cycle_acts_here || !r.state.displacements.empty() || may_skip_or_repeat(r)) {
    if (!r.state.cycle_acts_here) forget_klartext_speeds(r.state);  // it may be a program
    return add_unfollowed_move(block, r, "cycles are not corrected");
  }
  Move move = begin_klartext_move(block, r);
  r.state.known[2] = false;
  move.fixed[2] = !take_hole(r, move);
  move.may_position = !move.fixed[2] && r.state.known[0] && r.state.known[1];
  move.known_end = r.state.known;
  add_move(r, move);
  r.state.run_begin = r.program.moves.size();
  if (move.fixed[2]) note_uncorrected(r, block.line, "cycles are not corrected");
  if (!move.fixed[2]) note_hole(block, r, move);
}

void note_hole(const KlartextBlock& block, KlartextReading& r, const Move& move) {
  if (move.mills_at_end) return note_uncorrected(r, block.line, std::string(milled_as_a_whole));
  if (move.handling == Handling::held) note_uncorrected(r, block.line, "holes are held");
}

}  // namespace counterflex
