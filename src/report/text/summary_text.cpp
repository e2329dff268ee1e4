// The summary of a run in at most twelve lines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/report/formats.hpp"
#include "report/names.hpp"
#include "report/tally/causes.hpp"
#include "report/text/force_text.hpp"
#include "report/text/offsets_text.hpp"
#include "report/text/report_text.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {
namespace {

constexpr std::size_t label_width = 14;
constexpr std::size_t shown_files = 4;

/// A labelled paragraph, cut after two lines.
std::string item(std::string_view label, const std::string& text) {
  std::string lines = wrapped(fmt::format("  {:<{}}", label, label_width - 2), text, label_width);
  const std::size_t second = lines.find('\n', lines.find('\n') + 1);
  if (second + 1 >= lines.size() || second == std::string::npos) return lines;
  lines.resize(second);
  return lines + " ...\n";
}

std::string headline(const RunReport& report, const Ink& ink) {
  const std::string method =
      report.method == Method::direct ? "" : fmt::format(", method {}", to_string(report.method));
  return ink.bold(what_was_done(report)) + " on " + without_controls(machine_in_words(report)) + method +
         "\n" + (report.unmeasured.empty() ? "" : item("machine", report.unmeasured));
}

std::string causes_text(const SourcesAtWorst& at) {
  std::string text;
  for (const Cause& cause : all_causes) {
    const Vector3& part_mm = at.*cause.at_worst_mm;
    if (!text.empty() && part_mm.isZero(1e-9)) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", cause.in_short, mm4(part_mm.norm()));
  }
  return text;
}

std::string before_text(const RunReport& report) {
  if (!report.before) return "";
  std::string text = fmt::format("{} mm{}, line {}", mm4(report.before->max_mm), band_text(*report.before),
                                 report.before->max_line);
  if (report.at_worst) text += ": " + causes_text(*report.at_worst);
  if (report.common_shift)
    text += fmt::format("; without the common shift {}", mm4(report.common_shift->rest.max_mm));
  return item(report.after ? "before" : "deviation", text);
}

std::string after_text(const RunReport& report) {
  if (!report.after || !report.before) return "";
  const double before = report.before->max_mm, after = report.after->max_mm;
  std::string text =
      fmt::format("{} mm{}, line {}", mm4(after), band_text(*report.after), report.after->max_line);
  if (const std::string times = times_smaller(before, after); !times.empty())
    text += fmt::format(" ({} smaller)", times);
  return item("after", text + fmt::format("; by the model, tolerance {} mm", mm4(report.tolerance_mm)));
}

std::string uncertainty_line(const RunReport& report) {
  if (!report.uncertainty || !report.before || !report.before->bands) return "";
  std::vector<std::string> parts;
  if (const auto& at = report.uncertainty->at_worst)
    parts.push_back(fmt::format("+- {} mm (k = 2) is machine {}, force {}, others {}", mm4(at->all_mm),
                                mm4(at->parameters_mm), mm4(at->force_mm), mm4(at->others_mm)));
  if (const auto& below = report.before->bands->below_percent)
    parts.push_back(fmt::format("on {} % of the length the correction is below its own uncertainty",
                                format_fixed(*below, 0)));
  if (const auto& sampled = report.uncertainty->sampled)
    parts.push_back(fmt::format("{} samples: {} % inside of the bands", sampled->samples,
                                format_fixed(sampled->covered_percent, 1)));
  return parts.empty() ? "" : item("uncertainty", fmt::format("{}", fmt::join(parts, "; ")));
}

std::string other_force(const UnderOtherForce& other) {
  return other.unsolved > 0 ? "no stable equilibrium" : mm4(other.deviation.max_mm) + " mm";
}

std::string force_line(const RunReport& report) {
  if (!report.before) return "";
  const ForceSummary& forces = report.forces;
  if (forces.largest_N == 0 && forces.largest_Nm == 0)
    return item("force", report.gravity.empty() ? "none acts: geometric errors only"
                                                : "none acts: geometric errors and weight only");
  std::string text = "up to " + largest_wrench(forces);
  if (forces.without.moves > 0)
    text += fmt::format(", {} without", counted(forces.without.moves, "feed move"));
  if (const auto& s = report.sensitivity)
    text += fmt::format("; {0} % more: {1}, {0} % less: {2}, none: {3} mm", std::lround(100 * force_change),
                        other_force(s->higher), other_force(s->lower), mm4(s->without.max_mm));
  return item("force", text);
}

/// "fanuc; ", as the program was read.
std::string dialect_text(const RunReport& report) {
  for (const OptionValue& option : report.facts.options)
    if (const auto* name = std::get_if<std::string>(&option.value);
        option.name == "dialect" && name != nullptr)
      return *name + "; ";
  return "";
}

std::string moves_line(const RunReport& report) {
  const BlockCounts& blocks = report.blocks;
  if (report.failure) return "";
  if (report.command != Command::compensate)
    return item("program",
                dialect_text(report) +
                    fmt::format("{} mm of feed moves, {}{}", format_fixed(report.path_mm, 1),
                                counted(blocks.moves, "move"),
                                report.reversals ? ", " + counted(report.reversals->count, "reversal") : ""));
  const std::string others = blocks.others ? others_text(*blocks.others) : "";
  std::string text =
      dialect_text(report) + fmt::format("{} of {} {}{}", blocks.corrected, counted(blocks.moves, "move"),
                                         done_word(report), others.empty() ? "" : " individually, " + others);
  text += fmt::format(", {} added", counted(blocks.inserted, "point"));
  if (report.reversals) text += ", " + counted(report.reversals->count, "reversal");
  if (report.correction && report.correction->mm > 0)
    text += fmt::format(", largest correction {} mm", mm4(report.correction->mm));
  if (const auto& brief = report.control.short_blocks; brief && brief->count > 0)
    text += fmt::format(", shortest block {} ms", format_fixed(brief->shortest_ms, 1));
  return item("program", text);
}

/// The checks that did not pass, by name; details are in the other text.
std::string sanity_line(const RunReport& report, const Ink& ink) {
  if (report.sanity.empty()) return "";
  const auto passed = [](const SanityCheck& check) { return check.state == SanityState::ok; };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(report.sanity, passed));
  if (count == report.sanity.size()) return item("checks", fmt::format("all {} passed", count));
  std::string text;
  for (const SanityCheck& check : report.sanity)
    if (!passed(check)) text += (text.empty() ? "" : "; ") + check.name + ": " + check.text;
  std::string lines = item(fmt::format("checks {}/{}", count, report.sanity.size()), text);
  return ink.colour ? ink.warning(lines) : lines;
}

/// For each offset and tool a line and its words, which can be copied; then what they leave.
std::string offsets_lines(const RunReport& report) {
  if (!report.best_offsets) return "";
  std::string text;
  const auto row = [&](const std::string& what) {
    text +=
        wrapped(fmt::format("  {:<{}}", text.empty() ? "offsets" : "", label_width - 2), what, label_width);
  };
  for (const ChangeInWords& change : changes_in_words(*report.best_offsets)) {
    row(change.change);
    for (const std::string& words : change.words)
      text += std::string(label_width + 2, ' ') + without_controls(words) + "\n";
  }
  row(rest_in_words(*report.best_offsets, report.tolerance_mm));
  return text;
}

std::string spin_line(const RunReport& report) {
  return report.facts.free_spin ? item("spin", spin_words(*report.facts.free_spin)) : "";
}

std::string left_line(const RunReport& report) {
  return report.as_programmed ? item("left", as_programmed_words(*report.as_programmed)) : "";
}

std::string guard_line(const RunReport& report) {
  return report.facts.guard ? item("guard", guard_words(*report.facts.guard)) : "";
}

std::string files_line(const RunReport& report, const std::vector<std::string>& files) {
  const bool no_program = report.command == Command::compensate && report.error_kind;
  std::string text = no_program ? "no corrected program" : "";
  for (std::size_t i = 0; i < std::min(files.size(), shown_files + 1); ++i)
    text += (text.empty() ? "" : ", ") + without_controls(files[i]);
  if (files.size() > shown_files + 1) text += fmt::format(" and {} more", files.size() - shown_files - 1);
  return text.empty() ? "" : wrapped(fmt::format("  {:<{}}", "written", label_width - 2), text, label_width);
}

std::string more_line(const RunReport& report) {
  std::string text = "-v shows all numbers";
  if (report.before && !report.facts.attribution) text += ", --report NAME draws them";
  if (report.warnings.count > 0) text = counted(report.warnings.count, "warning") + "; " + text;
  return item("more", text);
}

}  // namespace

std::string summary_text(const RunReport& report, const std::vector<std::string>& files, bool colour) {
  const Ink ink{colour};
  return verdict_line(report, ink) + headline(report, ink) + spin_line(report) + before_text(report) +
         after_text(report) + uncertainty_line(report) + left_line(report) + offsets_lines(report) +
         force_line(report) + moves_line(report) + guard_line(report) + sanity_line(report, ink) +
         files_line(report, files) + more_line(report);
}

}  // namespace counterflex
