#include "program/klartext_read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/force_comment.hpp"

namespace counterflex {
namespace {

/// The number behind `key` in `squeezed_text`, where it is plain.
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

/// `TOOL CALL 5 Z S3000 F500`, `TOOL CALL "MILL" Z S3000`, `TOOL CALL S500` of the speed alone.
void read_tool_call(const KlartextBlock& block, KlartextReading& r) {
  std::string rest = squeezed(after_head(r.program.text, block));
  if (!rest.starts_with("CALL")) return;
  rest.erase(0, 4);
  std::size_t end = 0;
  if (rest.starts_with('"')) {
    end = rest.find('"', 1) == std::string::npos ? rest.size() : rest.find('"', 1) + 1;
  } else if (rest.starts_with('Q')) {
    end = std::min(rest.find_first_of("XYZ"), rest.size());
  } else {
    end = std::min(rest.find_first_not_of("0123456789."), rest.size());
  }
  KlartextState& state = r.state;
  if (end > 0) {
    state.tool = 0;
    std::from_chars(rest.data(), rest.data() + end, state.tool);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (r.tool_change_axes[axis]) take_away(r, axis);
    state.run_begin = r.program.moves.size();
    state.contour = state.after_contour = false;
    rest.erase(0, end);
    if (!rest.empty() && rest[0] >= 'U' && rest[0] <= 'Z') state.tool_along_z = rest[0] == 'Z';
  }
  if (const auto speed = number_behind(rest, 'S')) state.spindle_rpm = *speed;
  const double unit = state.unit == LengthUnit::inches ? 2.54 : 1.0;
  if (const auto feed = number_behind(rest, 'F')) state.tool_feed_mm_min = state.feed_mm_min = *feed * unit;
}

/// A corner that RND or CHF makes of the end of one move and the beginning of the next: neither is divided.
void read_corner(const KlartextBlock&, KlartextReading& r) {
  if (!r.program.moves.empty()) r.program.moves.back().may_split = r.program.moves.back().may_jump = false;
  r.state.rounds_next = true;
}

void read_call(const KlartextBlock& block, KlartextReading& r) {
  add_unfollowed_move(block, r, "a subprogram or a part of the program is called");
}

void read_approach(const KlartextBlock& block, KlartextReading& r) {
  add_unfollowed_move(block, r, "APPR and DEP are not followed");
  r.state.elsewhere.erase(0);
  if (block.head == "APPR") r.state.elsewhere[0] = "a contour that APPR has entered is not corrected";
}

void read_plane(const KlartextBlock& block, KlartextReading& r) {
  const std::string rest = squeezed(after_head(r.program.text, block));
  const bool resets = rest.starts_with("RESET");
  // Without MOVE rotary axes alone turn back, if any.
  if (!resets || rest.find("MOVE") != std::string::npos)
    add_unfollowed_move(block, r, "PLANE turns coordinates");
  if (r.state.elsewhere.erase(19) > 0) r.state.known.fill(false), r.state.run_begin = r.program.moves.size();
  if (!resets) r.state.elsewhere[19] = "coordinates are tilted";
}

/// FN9 to FN12 jump, the others calculate, print or read; none moves an axis.
void read_nothing(const KlartextBlock&, KlartextReading&) {}

/// The words of a cycle are parameters: one that is calculated is no longer what its definition says.
void read_parameter(const KlartextBlock& block, KlartextReading& r) {
  if (after_head(r.program.text, block).find("203") != std::string_view::npos) r.state.surface.reset();
}

void read_end(const KlartextBlock&, KlartextReading& r) {
  r.ended = true;
}

struct KnownStatement {
  std::string_view head;
  void (*read)(const KlartextBlock&, KlartextReading&);
};

constexpr std::array statements{
    KnownStatement{"L", read_klartext_motion},
    KnownStatement{"C", read_klartext_motion},
    KnownStatement{"CR", read_klartext_motion},
    KnownStatement{"CT", read_klartext_motion},
    KnownStatement{"CP", read_klartext_motion},
    KnownStatement{"CC", read_klartext_pole},
    KnownStatement{"M", read_klartext_codes},
    KnownStatement{"CYCL", read_klartext_cycle},
    KnownStatement{"CYCLE", read_klartext_cycle},
    KnownStatement{"TOOL", read_tool_call},
    KnownStatement{"RND", read_corner},
    KnownStatement{"CHF", read_corner},
    KnownStatement{"CALL", read_call},
    KnownStatement{"APPR", read_approach},
    KnownStatement{"DEP", read_approach},
    KnownStatement{"PLANE", read_plane},
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

void refuse_conflict_marker(const KlartextBlock& block, const KlartextReading& r) {
  const std::string_view line = part(r.program.text, block.parts[0]);
  for (const std::string_view marker : {"<<<<<<<", "=======", ">>>>>>>", "|||||||"})
    if (line.starts_with(marker))
      refuse_klartext(r.program.text, r.program.file, block, block.parts[0].begin,
                      fmt::format("'{}' is a conflict marker of a version control system", marker));
}

/// A comment that stands alone names the operation; so does the text of a structure line, "* - POCKET".
void read_comments(const KlartextBlock& block, KlartextReading& r) {
  Block place;
  place.line = block.line;
  place.span = block.span;
  for (const Span& comment : block.comments) {
    if (const auto force = read_force_comment(r.program.text, r.program.file, place, comment))
      r.state.force = force->F;
    else if (block.parts.empty())
      r.operation.name(part(r.program.text, comment));
  }
}

void read_statement(const KlartextBlock& block, KlartextReading& r) {
  read_comments(block, r);
  if (block.parts.empty()) return;
  ++r.program.block_count;
  const auto known = std::find_if(statements.begin(), statements.end(),
                                  [&](const KnownStatement& s) { return s.head == block.head; });
  if (known != statements.end()) return known->read(block, r);
  refuse_conflict_marker(block, r);
  add_unfollowed_move(block, r, fmt::format("{} is not read", block.head.empty() ? "the block" : block.head));
}

}  // namespace

void leave_alone(KlartextReading& r, int line, std::string why) {
  std::vector<LeftAlone>& all = r.program.left_alone;
  if (all.empty() || all.back().why != why) all.push_back({line, std::move(why)});
}

void add_unfollowed_move(const KlartextBlock& block, KlartextReading& r, std::string why) {
  Move move = begin_klartext_move(block, r);
  move.fixed.fill(true);
  r.state.known.fill(false);
  r.state.contour = r.state.after_contour = false;
  r.state.pole.reset();
  r.state.surface.reset();
  r.program.moves.push_back(std::move(move));
  r.state.run_begin = r.program.moves.size();
  leave_alone(r, block.line, std::move(why));
}

void add_cycle_call(const KlartextBlock& block, KlartextReading& r) {
  if (!r.state.cycle_acts_here || !r.state.elsewhere.empty() || holds(r.doubtful, block.line))
    return add_unfollowed_move(block, r, "cycles are left as they are");
  Move move = begin_klartext_move(block, r);
  move.fixed[2] = !hold_hole(r, move);
  move.known_end = r.state.known;
  r.state.known[2] = move.known_end[2] = false;
  r.program.moves.push_back(move);
  r.state.run_begin = r.program.moves.size();
  leave_alone(r, block.line, move.fixed[2] ? "cycles are left as they are" : "holes are held");
}

void read_klartext(Program& program, const ReadOptions& options,
                   const std::array<bool, 3>& tool_change_axes) {
  KlartextReading reading{program, options, tool_change_axes, doubtful_stretches(program.text),
                          poles_used_otherwise(program.text)};
  reading.state.unit = options.unit;
  KlartextBlock block;
  while (!reading.ended && next_klartext_block(program.text, block)) read_statement(block, reading);
}

bool is_corrected_klartext(std::string_view text) {
  KlartextBlock block;
  while (next_klartext_block(text, block)) {
    for (const Span& comment : block.comments)
      if (is_header_comment(part(text, comment))) return true;
    if (!block.parts.empty() && block.head != "BEGIN") return false;
  }
  return false;
}

}  // namespace counterflex
