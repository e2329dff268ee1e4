#include "control.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/numbers.hpp"

namespace counterflex {
namespace {

// Plunges to one rapid, from which on the post has probably turned rapids into feed moves.
constexpr std::size_t suspicious_plunges = 3;

bool is_plunge(const Move& move) {
  return move.motion == Motion::feed && !move.arc && !move.cycle && all_known(move.known_start) &&
         all_known(move.known_end) && move.start_mm.head<2>() == move.end_mm.head<2>() &&
         move.end_mm.z() < move.start_mm.z();
}

/// The corrected program as the control reads it; nothing where the text is not one.
std::optional<Program> read_again(const Job& job, const std::string& text) {
  try {
    ReadOptions read = job.read;
    read.dialect = job.program.dialect;
    Program program = read_program(text, job.program.file, read);
    if (!job.program.moves.empty()) ignore_axes(program, job.program.moves.front().ignored);
    return program;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

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

Remark tolerance_warning(const PathTolerance& tolerance, double correction_mm) {
  if (!tolerance.path_mm)
    return {tolerance.line,
            fmt::format("G64 without P lets the control leave the path by any distance; the largest "
                        "correction is {} mm",
                        shown(correction_mm, 4))};
  const double most = std::max(*tolerance.path_mm, tolerance.merge_mm.value_or(0));
  return {tolerance.line,
          fmt::format(
              "G64 lets the control leave the path by {:.6g} mm and merge moves within {:.6g} mm of a line: "
              "the largest correction, {} mm, {}",
              *tolerance.path_mm, tolerance.merge_mm.value_or(*tolerance.path_mm), shown(correction_mm, 4),
              correction_mm <= most ? "may vanish" : "stays, smaller ones may vanish")};
}

Remark plunge_warning(const ControlFacts& control) {
  return {
      0, fmt::format("{} plunges at feed stand against {} rapids: where the post has turned rapids into feed "
                     "moves, the cutting force acts in the air, too",
                     control.plunges, control.rapids)};
}

}  // namespace

ShortBlocks short_blocks(const Program& program, double limit_ms) {
  ShortBlocks blocks;
  blocks.limit_ms = limit_ms;
  for (const Segment& segment : build_toolpath(program, one_frame(program, {})).segments) {
    const double ms = 1e3 * (segment.t_end - segment.t_start);
    if (ms <= 0 || ms >= limit_ms) continue;
    if (blocks.count++ == 0) blocks.first_line = segment.line;
    if (blocks.count > 1 && ms >= blocks.shortest_ms) continue;
    blocks.shortest_ms = ms;
    blocks.shortest_line = segment.line;
  }
  return blocks;
}

ControlFacts control_facts(const Job& job, const RunFacts& facts, const std::string* corrected) {
  ControlFacts control;
  control.tolerances = job.program.path_tolerances;
  for (const Move& move : job.program.moves) {
    control.plunges += is_plunge(move);
    control.rapids += move.motion == Motion::rapid;
  }
  if (corrected == nullptr) return control;
  control.lines = line_lengths(*corrected, job.program.dialect);
  if (const auto again = read_again(job, *corrected))
    control.short_blocks = short_blocks(*again, facts.min_block_ms);
  return control;
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
