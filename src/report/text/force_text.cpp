#include "report/text/force_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

constexpr std::size_t shown_reasons = 4;

// The deviation of `program` if the force is higher or lower than given.
std::string other_force_text(const UnderOtherForce& other, const char* program) {
  if (other.unsolved > 0)
    return fmt::format("the machine has no stable equilibrium in {}, the first in line {}",
                       counted(other.unsolved, "place"), other.first_line);
  return fmt::format("the {} is off by up to {} mm, line {}", program, mm4(other.deviation.max_mm),
                     other.deviation.max_line);
}

std::string sensitivity_text(const RunReport& report) {
  if (!report.sensitivity) return "";
  const Sensitivity& s = *report.sensitivity;
  const char* program = report.after ? "corrected program" : "program";
  const std::string others =
      fmt::format("With the force {0} % higher (wear, override) {1}; with it {0} % lower {2}.",
                  std::lround(100 * force_change), other_force_text(s.higher, program),
                  other_force_text(s.lower, program));
  const std::string text = wrapped("  ", others, 2);
  if (s.without.max_mm <= 0) return text;
  const std::string without = fmt::format(
      "Without the force (dry run, spring pass, broken insert) the {} is off by up to {} mm, line {}.",
      program, mm4(s.without.max_mm), s.without.max_line);
  return text + wrapped("  ", without, 2);
}

/// Of all moves, or of the moves of one reason.
std::string length_text(const auto& sum) {
  if (sum.unknown_length == sum.moves) return "length unknown";
  const std::string known = format_fixed(sum.length_mm, 3) + " mm";
  return sum.unknown_length == 0 ? known : fmt::format("{}, {} of unknown length", known, sum.unknown_length);
}

std::string without_force_text(const WithoutForce& without) {
  if (without.moves == 0) return "";
  std::string text = fmt::format("  {}, {}, cut without a force\n", counted(without.moves, "feed move"),
                                 length_text(without));
  const std::size_t shown = std::min(shown_reasons, without.reasons.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const WithoutForceReason& reason = without.reasons[i];
    text += wrapped("    ",
                    fmt::format("{}, {}, from line {} on: {}", counted(reason.moves, "move"),
                                length_text(reason), reason.first_line, reason.why),
                    6);
  }
  if (without.reasons.size() > shown)
    text += fmt::format("    and for {} more\n", counted(without.reasons.size() - shown, "reason"));
  return text;
}

}  // namespace

std::string largest_wrench(const ForceSummary& forces) {
  const std::string force = format_fixed(forces.largest_N, 1) + " N",
                    moment = format_fixed(forces.largest_Nm, 2) + " N m";
  if (forces.largest_Nm == 0) return force;
  return forces.largest_N == 0 ? moment : force + " and " + moment;
}

std::string force_text(const RunReport& report, const Ink& ink) {
  const ForceSummary& forces = report.forces;
  if (!report.before) return "";
  std::string text = line_break() + ink.bold("Cutting force") + "\n";
  if (forces.largest_N == 0 && forces.largest_Nm == 0)
    return text + (report.gravity.empty()
                       ? "  no cutting force given: only geometric errors count\n"
                       : "  no cutting force given: only geometric errors and weight count\n");
  text +=
      fmt::format("  up to {} {}\n", largest_wrench(forces),
                  forces.at_platform ? "at the platform's reference point (at = platform)" : "on the tool");
  if (forces.ramps > 0)
    text += fmt::format("  {} of the profile acting as ramps\n", counted(forces.ramps, "step"));
  if (forces.jumps > 0)
    text += fmt::format("  {} of the profile acting as jumps\n", counted(forces.jumps, "step"));
  if (forces.ramps + forces.jumps > 0)
    text += fmt::format("  largest step {} N\n", format_fixed(forces.largest_step_N, 1));
  return text + without_force_text(forces.without) + sensitivity_text(report);
}

}  // namespace counterflex
