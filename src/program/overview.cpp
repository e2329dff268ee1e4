#include "counterflex/program/overview.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/gcode/remarks.hpp"

namespace counterflex {
namespace {

bool is_plunge(const Move& move) {
  return move.motion == Motion::feed && !move.arc && !move.cycle && all_known(move.known_start) &&
         all_known(move.known_end) && move.start_mm.head<2>() == move.end_mm.head<2>() &&
         move.end_mm.z() < move.start_mm.z();
}

void add_tool(std::vector<long>& tools, long tool) {
  const auto at = std::lower_bound(tools.begin(), tools.end(), tool);
  if (at == tools.end() || *at != tool) tools.insert(at, tool);
}

/// Whether a coordinate of the start or of the end of a move is known.
bool has_place(const Move& move) {
  const auto is_known = [](bool known) { return known; };
  return std::ranges::any_of(move.known_start, is_known) || std::ranges::any_of(move.known_end, is_known);
}

/// Fast path: most moves have the tool of the move before.
void add_tools_and_offsets(Overview& overview, const std::vector<Move>& moves) {
  const Move* before = nullptr;
  for (const Move& move : moves) {
    int& frame_line = overview.frame_lines[move.frame];
    const bool is_selected = move.frame != 0;
    if (frame_line == 0 && (is_selected || has_place(move))) frame_line = move.line;
    if (before == nullptr || move.tool != before->tool) add_tool(overview.tools, move.tool);
    before = &move;
  }
}

void add_move(Overview& overview, const Move& move) {
  const bool moves = moves_tool(move);
  overview.moves += moves;
  overview.plunges += is_plunge(move);
  overview.rapids += moves && move.motion == Motion::rapid;
  overview.last_block_number = std::max(overview.last_block_number, move.block_number.value_or(0));
  const bool is_hole = move.cycle || move.makes_hole;
  if ((move.motion == Motion::feed || is_hole) && move.tool == 0 && !overview.first_cut_without_tool)
    overview.first_cut_without_tool = move.line;
  if (is_hole && !overview.first_cycle_line) overview.first_cycle_line = move.line;
  overview.turns_tool = overview.turns_tool || move.orientation;
  if (!move.force) return;
  if (!overview.first_force_line) overview.first_force_line = move.line;
  overview.commented_force = overview.commented_force || !move.force->isZero(0);
}

void add_text(Overview& overview, const std::string& text) {
  overview.bytes += text.size();
  overview.text_lines += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  if (!text.empty() && text.back() != '\n') ++overview.text_lines;
}

}  // namespace

void add_window(Overview& overview, const Program& window) {
  overview.file = window.file;
  overview.dialect = window.dialect;
  overview.blocks = window.block_count;
  overview.frames = window.frames;
  overview.frame_lines.resize(window.frames.size());
  overview.remarks = window.remarks;
  overview.external_axes_move = window.external_axes_move;
  overview.external_axes = window.external_axes;
  overview.zones = window.zones;
  overview.path_tolerances = window.path_tolerances;
  add_text(overview, window.text);
  for (const Move& move : window.moves) add_move(overview, move);
  add_tools_and_offsets(overview, window.moves);
  for (const LeftAlone& block : window.left_alone)
    list(block.machine_position ? overview.machine_positions : overview.left_alone, block);
  const int last_move = window.moves.empty() ? 0 : window.moves.back().line;
  overview.lines = window.expansion.file_lines > 0
                       ? window.expansion.file_lines
                       : std::max({overview.lines, overview.text_lines, last_move});
}

std::optional<int> first_unread_call(const Overview& overview) {
  for (const Remark& remark : overview.remarks)
    if (remark.what.starts_with(assumption_of_calls)) return remark.line;
  return std::nullopt;
}

std::string zones_in_words(const Zones& zones) {
  if (zones.count == 0) return "";
  const std::string size =
      zones.largest_mm > 0 ? fmt::format("largest {:.6g} mm, line {}", zones.largest_mm, zones.largest_line)
                           : "their length is not known";
  return fmt::format("round {} target{}, {}", zones.count, zones.count == 1 ? "" : "s", size);
}

Overview overview_of(const Program& whole) {
  Overview overview;
  add_window(overview, whole);
  return overview;
}

}  // namespace counterflex
