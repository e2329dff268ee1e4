#include "report/text/control.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

// Ratio of plunges to rapids above which the post has probably turned rapids into feed moves.
constexpr std::size_t suspicious_plunges = 3;

constexpr double same_time = 1e-9;  // relative: rounding of coordinates; the first of equal moves is reported

std::string shown(double value, int decimals) {
  return format_fixed(value, decimals);
}

Remark short_block_warning(const ShortBlocks& blocks) {
  return {0, fmt::format(
                 "{} of the corrected program take{} less than {} ms at the programmed feed, first in its "
                 "line {}; the shortest takes {} ms (line {}): a control that reads blocks more slowly "
                 "stutters or slows down (--min-block-ms)",
                 blocks.count == 1 ? "one feed move" : fmt::format("{} feed moves", blocks.count),
                 blocks.count == 1 ? "s" : "", fmt::format("{:.6g}", blocks.limit_ms), blocks.first_line,
                 shown(blocks.shortest_ms, 3), blocks.shortest_line)};
}

Remark long_line_warning(const LineLengths& lines) {
  return {0,
          fmt::format("{} of the corrected program {} more than 90 % of the {} characters that the control "
                      "reads, first line {}; the longest has {} (line {})",
                      lines.near == 1 ? "one line" : fmt::format("{} lines", lines.near),
                      lines.near == 1 ? "has" : "have", lines.limit, lines.first_near, lines.longest,
                      lines.longest_line)};
}

/// Compares the largest correction with a path tolerance. The reader's remark explains the tolerance.
Remark tolerance_warning(const PathTolerance& tolerance, double correction_mm) {
  const std::string largest = fmt::format("the largest correction, {} mm,", shown(correction_mm, 4));
  if (!tolerance.path_mm)
    return {tolerance.line, largest + " may vanish: the control may leave the path by any distance"};
  const double most = std::max(*tolerance.path_mm, tolerance.merge_mm.value_or(0));
  return {tolerance.line,
          correction_mm <= most
              ? fmt::format("{} may vanish within the {:.6g} mm that G64 allows", largest, most)
              : fmt::format("{} is more than the {:.6g} mm that G64 allows: only smaller ones may vanish",
                            largest, most)};
}

Remark plunge_warning(const ControlFacts& control) {
  return {0, fmt::format("{} plunges at feed, but {} rapids: if the post has turned rapids into feed moves, "
                         "the cutting force acts in the air, too",
                         control.plunges, control.rapids)};
}

}  // namespace

void add_short_blocks(ShortBlocks& blocks, const Program& window) {
  for (const Move& move : window.moves) {
    const double ms = 1e3 * duration_of(move);
    if (ms <= 0 || ms >= blocks.limit_ms) continue;
    if (blocks.count++ == 0) blocks.first_line = move.line;
    if (blocks.count > 1 && ms >= blocks.shortest_ms * (1 - same_time)) continue;
    blocks.shortest_ms = ms;
    blocks.shortest_line = move.line;
  }
}

ControlFacts control_facts(const Overview& program, const RunTally& tally) {
  return {tally.short_blocks(),    tally.lines(),   tally.zones().value_or(program.zones),
          program.path_tolerances, program.plunges, program.rapids};
}

std::vector<Remark> control_warnings(const ControlFacts& control, const std::optional<Largest>& correction) {
  std::vector<Remark> warnings;
  if (control.short_blocks && control.short_blocks->count > 0)
    warnings.push_back(short_block_warning(*control.short_blocks));
  if (control.lines && control.lines->near > 0) warnings.push_back(long_line_warning(*control.lines));
  if (correction && correction->mm > 0)
    for (const PathTolerance& tolerance : control.tolerances)
      warnings.push_back(tolerance_warning(tolerance, correction->mm));
  if (control.plunges > suspicious_plunges * std::max<std::size_t>(control.rapids, 1))
    warnings.push_back(plunge_warning(control));
  return warnings;
}

}  // namespace counterflex
