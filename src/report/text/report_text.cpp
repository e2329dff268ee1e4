#include "report/text/report_text.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "counterflex/files/text.hpp"
#include "counterflex/report/formats.hpp"
#include "report/names.hpp"
#include "report/tally/causes.hpp"
#include "report/text/force_text.hpp"
#include "report/text/loads_text.hpp"
#include "report/text/offsets_text.hpp"
#include "report/text/sanity_text.hpp"
#include "report/text/text_layout.hpp"
#include "report/text/tool_words.hpp"

namespace counterflex {

namespace {

constexpr std::size_t shown_blocks = 5;
constexpr std::size_t shown_warnings = 8;
constexpr std::size_t shown_worst = 5;

std::string file_name(const RunReport& report, const std::string& role) {
  for (const InputFile& input : report.facts.inputs)
    if (input.name == role) return input.path == "-" ? "standard input" : without_controls(input.path);
  return "the program";
}

std::string title(const RunReport& report, const Ink& ink) {
  std::string text = ink.bold(what_was_done(report)) + "\n";
  text += wrapped("  ", fmt::format("on {}", machine_in_words(report)), 2);
  if (!report.unmeasured.empty()) text += wrapped("  ", report.unmeasured, 2);
  if (report.command == Command::predict) return text;
  const std::string method =
      report.command == Command::compensate ? fmt::format("method {}, ", to_string(report.method)) : "";
  return text + fmt::format("  {}tolerance {} mm\n", method, mm4(report.tolerance_mm));
}

std::string failure_text(const RunReport& report, const Ink& ink) {
  const std::optional<Failure> ended = report.failure ? report.failure : refusal_of(report);
  if (!ended) return "";
  const Failure& failure = *ended;
  std::string where = failure.line > 0 ? fmt::format("line {}: ", failure.line) : "";
  if (report.command == Command::verify && failure.corrected_line > 0)
    where += fmt::format("line {} of the corrected program: ", failure.corrected_line);
  std::string text = line_break() + ink.bad(report.failure ? "Failed" : "Refused") +
                     fmt::format(" (exit status {})\n", report.exit_status);
  text += wrapped("  ", where + failure.what, 4);
  if (report.failure && report.command == Command::compensate)
    text += "  No corrected program was written.\n";
  return text;
}

std::string row(const std::string& label, const RunReport& report, double DeviationStatistics::*value) {
  return before_after_row(label, mm4(*report.before.*value), report.after ? mm4(*report.after.*value) : "");
}

/// No row where a program without a cutting length has no such number.
std::string row(const std::string& label, const RunReport& report,
                std::optional<double> DeviationStatistics::*value) {
  if (!(*report.before.*value)) return "";
  return before_after_row(label, mm4(*report.before.*value), report.after ? mm4(*report.after.*value) : "");
}

std::string axis_row(const char* label, const RunReport& report, int axis) {
  return before_after_row(label, mm4(report.before->max_axis_mm[axis]),
                          report.after ? mm4(report.after->max_axis_mm[axis]) : "");
}

std::string factor(const RunReport& report) {
  const std::string times = times_smaller(report.before->max_mm, report.after->max_mm);
  return times.empty() ? "" : fmt::format("  The largest deviation becomes {} smaller.\n", times);
}

std::string band_rows(const RunReport& report) {
  if (!report.before->bands) return "";
  const auto row = [&](const char* label, auto value, int decimals) {
    const auto shown = [&](const std::optional<DeviationStatistics>& s) {
      const std::optional<double> number =
          s && s->bands ? std::optional<double>(*s->bands.*value) : std::nullopt;
      return number ? format_fixed(*number, decimals) : std::string();
    };
    const std::string before = shown(report.before);
    return before.empty() ? "" : before_after_row(label, before, shown(report.after));
  };
  return row("band of the largest, k = 2: +-", &BandStatistics::at_max_mm, 4) +
         row("widest band", &BandStatistics::largest_mm, 4) +
         row("root mean square of the bands", &BandStatistics::rms_mm, 4) +
         row("below its band, % of the length", &BandStatistics::below_percent, 0);
}

std::string deviation_table(const RunReport& report, const Ink& ink) {
  if (!report.before) return "";
  const bool corrected = report.after.has_value();
  std::string text =
      line_break() + ink.bold("Deviation of the tool tip") +
      (report.path_mm > 0 ? fmt::format(" on {} mm of feed moves, in mm\n", format_fixed(report.path_mm, 3))
                          : " at holes, in mm\n");
  text += before_after_row("", "before", corrected ? "after *" : "");
  text += row("largest", report, &DeviationStatistics::max_mm);
  text += before_after_row("  in program line", std::to_string(report.before->max_line),
                           corrected ? std::to_string(report.after->max_line) : "");
  if (const auto& shift = report.common_shift) {
    text += before_after_row("common shift (datum not stated)", mm4(shift->largest_mm()), "");
    text += before_after_row("largest without the common shift", mm4(shift->rest.max_mm), "");
  }
  text += row("95 % of the length is below", report, &DeviationStatistics::p95_mm);
  text += row("root mean square", report, &DeviationStatistics::rms_mm);
  text += row("mean", report, &DeviationStatistics::mean_mm);
  text += axis_row("largest in x", report, 0) + axis_row("largest in y", report, 1) +
          axis_row("largest in z", report, 2);
  text += row("largest across the path", report, &DeviationStatistics::max_across_mm);
  text += row("largest along the tool axis", report, &DeviationStatistics::max_tool_axis_mm);
  text += row("along the path (matters at ends)", report, &DeviationStatistics::max_along_mm);
  text += row("largest rotation, in deg", report, &DeviationStatistics::max_rotation_deg);
  text += tool_rows(report) + band_rows(report);
  if (report.facts.free_spin) text += wrapped("  spin ", spin_words(*report.facts.free_spin), 4);
  if (!corrected) return text;
  return text + "  * model residual: what the model leaves, not the accuracy of the part\n" + factor(report);
}

std::string uncertainty_text(const RunReport& report, const Ink& ink) {
  if (!report.uncertainty) return "";
  const UncertaintyReport& of = *report.uncertainty;
  std::string text = line_break() + ink.bold("Uncertainty") + ", bands have k = 2\n";
  text +=
      wrapped("  ",
              fmt::format("{} of {} parameters of the machine have a standard deviation; the others count "
                          "as exact. Standard deviations: force {:.3g} %, tool length {:.3g} um, "
                          "repeatability {:.3g} um, temperature {:.3g} K.",
                          of.known_parameters, of.parameters, 100 * of.stated.force,
                          of.stated.tool_length / um, of.stated.repeatability / um, of.stated.temperature),
              2);
  if (const auto& at = of.at_worst)
    text +=
        wrapped("  ",
                fmt::format("Where the deviation before is largest: +- {} mm; machine {}, force {}, "
                            "others {}.",
                            mm4(at->all_mm), mm4(at->parameters_mm), mm4(at->force_mm), mm4(at->others_mm)),
                2);
  if (const auto& sampled = of.sampled)
    text +=
        wrapped("  ",
                fmt::format("{} samples at {} places: {} % of their deviations are inside of the bands; "
                            "standard deviations are {} to {} of the computed ones{}.",
                            sampled->samples, sampled->places, format_fixed(sampled->covered_percent, 1),
                            format_fixed(sampled->least_ratio, 3), format_fixed(sampled->largest_ratio, 3),
                            sampled->unsolved > 0 ? fmt::format("; {} were not solved", sampled->unsolved)
                                                  : std::string()),
                2);
  return text;
}

std::string source_row(std::string_view label, const DeviationStatistics& s) {
  return fmt::format("  {:<34}{:>12}{:>12}{:>12}{:>12}\n", label, mm4(s.max_axis_mm.x()),
                     mm4(s.max_axis_mm.y()), mm4(s.max_axis_mm.z()), mm4(s.max_mm));
}

std::string source_row(std::string_view label, const Vector3& d_mm) {
  return fmt::format("  {:<34}{:>12}{:>12}{:>12}{:>12}\n", label, mm4(d_mm.x()), mm4(d_mm.y()), mm4(d_mm.z()),
                     mm4(d_mm.norm()));
}

std::string at_worst_text(const RunReport& report, const char* together) {
  if (!report.at_worst) return "";
  const Sources& sources = *report.sources;
  const SourcesAtWorst& at = *report.at_worst;
  std::string text = fmt::format("  where the deviation is largest, line {}:\n", at.line);
  for (const Cause& cause : all_causes)
    if (sources.*cause.statistics) text += source_row(cause.name, at.*cause.at_worst_mm);
  return text + source_row("sum of these", at.superposition_mm) + source_row(together, at.before_mm);
}

std::string sources_text(const RunReport& report, const Ink& ink) {
  if (report.before && !report.facts.attribution)
    return line_break() + "For causes along the path add --report NAME or --json.\n";
  if (!report.sources) return "";
  const Sources& sources = *report.sources;
  const bool two = !sources.gravity && !sources.preloads && !sources.fixture;
  const char* const together = two ? "both acting together" : "all acting together";
  std::string text =
      line_break() + ink.bold("Causes of the deviation") + ", in mm; largest values, each at its own place\n";
  text += fmt::format("  {:<34}{:>12}{:>12}{:>12}{:>12}\n", "", "x", "y", "z", "in space");
  for (const Cause& cause : all_causes)
    if (const auto& s = sources.*cause.statistics) text += source_row(cause.words, *s);
  text += source_row("superposition: sums at each place", sources.superposition);
  return text + source_row(together, *report.before) + at_worst_text(report, together);
}

std::string worst_text(const RunReport& report, const Ink& ink) {
  if (report.worst.size() < 2) return "";
  std::string text = line_break() + ink.bold("Worst lines") + ", largest deviation in mm\n";
  text += before_after_row("", "before", report.after ? "after *" : "");
  for (std::size_t i = 0; i < std::min(shown_worst, report.worst.size()); ++i) {
    const WorstRow& worst = report.worst[i];
    const int corrected = report.command == Command::verify ? worst.at_after.corrected_line : 0;
    text += before_after_row(
        fmt::format("line {}", worst.line) + (corrected > 0 ? fmt::format(" (corrected {})", corrected) : ""),
        mm4(worst.before_mm), report.after ? mm4(worst.after_mm) : "");
  }
  return text;
}

std::string zones_text(const RunReport& report) {
  const std::string zones = zones_in_words(report.control.zones);
  if (zones.empty()) return "";
  return wrapped("  ",
                 fmt::format("zones{} {}: the guarantee is for the lines between targets",
                             report.text_after ? " of the corrected program" : "", zones),
                 4);
}

std::string program_text(const RunReport& report, const Ink& ink) {
  const BlockCounts& blocks = report.blocks;
  if (report.failure) return "";
  std::string text = line_break() + ink.bold("Program") + "\n";
  if (report.command == Command::predict)
    return text + fmt::format("  {}, {}\n", counted(blocks.total, "block"), counted(blocks.moves, "move")) +
           zones_text(report);
  const std::string others = blocks.others ? others_text(*blocks.others) : "";
  text += fmt::format("  {} of {} {}{}, {} added\n", blocks.corrected, counted(blocks.moves, "move"),
                      done_word(report), others.empty() ? "" : " individually",
                      counted(blocks.inserted, "point"));
  if (!others.empty()) text += wrapped("  ", others, 2);
  if (report.text_after)
    text += fmt::format("  {} -> {} blocks, {} -> {} bytes\n", report.text_before.blocks,
                        report.text_after->blocks, report.text_before.bytes, report.text_after->bytes);
  if (report.as_programmed) text += wrapped("  left ", as_programmed_words(*report.as_programmed), 4);
  if (report.facts.guard) text += wrapped("  guard ", guard_words(*report.facts.guard), 4);
  if (report.correction && report.correction->mm > 0)
    text += fmt::format("  largest correction {} mm, line {}\n", mm4(report.correction->mm),
                        report.correction->line);
  return text + zones_text(report);
}

std::string line_prefix(int line) {
  return line > 0 ? fmt::format("  line {}: ", line) : "  ";
}

std::string more(std::size_t shown, std::size_t count) {
  return count > shown ? fmt::format("  and {} more\n", count - shown) : "";
}

std::string rows_text(const Capped<LeftAlone>& list) {
  const std::size_t shown = std::min(shown_blocks, list.rows.size());
  std::string text;
  for (std::size_t i = 0; i < shown; ++i)
    text += wrapped(line_prefix(list.rows[i].line), list.rows[i].why, 4);
  return text + more(shown, list.count);
}

std::string left_alone_text(const RunReport& report, const Ink& ink) {
  const Capped<LeftAlone>& list = report.blocks.left_alone;
  if (list.count == 0) return "";
  const OtherMoves others = report.blocks.others.value_or(OtherMoves{});
  const std::size_t moves = others.grouped + others.held + others.in_part + others.left;
  const std::string heading =
      moves > 0
          ? fmt::format("Not corrected individually: {}, first lines and reasons", counted(moves, "move"))
          : "Not or partly corrected: first lines and reasons";
  std::string text = line_break() + ink.warning(heading) + "\n";
  return text + rows_text(list);
}

std::string machine_positions_text(const RunReport& report, const Ink& ink) {
  const Capped<LeftAlone>& list = report.blocks.machine_positions;
  if (list.count == 0) return "";
  return line_break() + ink.bold("In machine coordinates, not changed: " + counted(list.count, "block")) +
         "\n" + rows_text(list);
}

std::string warnings_text(const RunReport& report, const Ink& ink) {
  const Capped<Remark>& list = report.warnings;
  if (list.count == 0) return "";
  std::string text = line_break() + ink.warning(counted(list.count, "warning")) + "\n";
  const std::size_t shown = std::min(shown_warnings, list.rows.size());
  for (std::size_t i = 0; i < shown; ++i)
    text += wrapped(line_prefix(list.rows[i].line), list.rows[i].what, 4);
  return text + more(shown, list.count);
}

// The phrases up to their colon; the page shows all of them.
std::string not_modelled_text(const RunReport& report) {
  std::string text;
  for (const std::string& phrase : report.not_modelled)
    text += (text.empty() ? "Not modelled: " : "; ") + phrase.substr(0, phrase.find(':'));
  return text.empty() ? "" : wrapped("  ", text + ".", 2);
}

std::string already_corrected_text(const RunReport& report) {
  if (report.already_corrected.empty()) return "";
  std::string names;
  for (const std::string& name : report.already_corrected) names += (names.empty() ? "" : ", ") + name;
  return wrapped("  ", fmt::format("The control corrects {} by itself; the model is without it.", names), 2);
}

std::string assumptions_text(const RunReport& report, const Ink& ink) {
  return line_break() + ink.bold("Assumptions") + "\n" + wrapped("  ", report.work, 2) +
         (report.datum.empty() ? "" : wrapped("  ", report.datum, 2)) +
         (report.tools.empty() ? "" : wrapped("  ", report.tools_assumed, 2)) +
         (report.gravity.empty() ? "" : wrapped("  ", report.gravity, 2)) +
         (report.thermal.empty() ? "" : wrapped("  ", report.thermal, 2)) + already_corrected_text(report) +
         not_modelled_text(report);
}

}  // namespace

std::string what_was_done(const RunReport& report) {
  const std::string program = file_name(report, "program");
  if (report.command == Command::verify)
    return fmt::format("verify {} for {}", file_name(report, "corrected"), program);
  return fmt::format("{} {}", name_of(report.command), program);
}

std::string machine_in_words(const RunReport& report) {
  const std::string machine = report.machine.empty() ? "an unnamed machine" : report.machine;
  return report.temperature_C ? fmt::format("{} at {:.6g} degrees Celsius", machine, *report.temperature_C)
                              : machine;
}

std::string verdict_line(const RunReport& report, const Ink& ink) {
  const std::string text = verdict_text(report.verdict, report.verdict_reason) + "\n";
  if (report.verdict == Verdict::ok) return ink.good(text);
  if (report.verdict == Verdict::predicted) return ink.bold(text);
  return report.verdict == Verdict::partly ? ink.warning(text) : ink.bad(text);
}

std::string band_text(const DeviationStatistics& s) {
  return s.bands ? " +- " + mm4(s.bands->at_max_mm) : "";
}

std::string_view done_word(const RunReport& report) {
  return report.as_programmed ? "followed" : "corrected";
}

std::string others_text(const OtherMoves& moves) {
  std::string text;
  const auto add = [&](std::size_t count, const char* handling) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, handling);
  };
  add(moves.grouped, "with one shift for their contour");
  add(moves.in_part, "in part");
  add(moves.held, "held");
  add(moves.left, "not corrected");
  return text;
}

std::string details_text(const RunReport& report, bool colour, bool marks) {
  const Ink ink{colour, marks};
  std::string text = verdict_line(report, ink) + title(report, ink) + failure_text(report, ink);
  text += deviation_table(report, ink) + uncertainty_text(report, ink) + offsets_text(report, ink) +
          sources_text(report, ink) + worst_text(report, ink);
  text += program_text(report, ink) + force_text(report, ink) + loads_text(report, ink);
  text += left_alone_text(report, ink) + machine_positions_text(report, ink) + warnings_text(report, ink);
  return text + sanity_text(report.sanity, ink) + assumptions_text(report, ink);
}

std::string one_line(const RunReport& report) {
  std::string text = fmt::format("{}: {}, ", file_name(report, "program"),
                                 verdict_text(report.verdict, report.verdict_reason));
  if (!report.before) return text + "not solved";
  text += mm4(report.before->max_mm) + " mm before";
  if (report.after) text += fmt::format(", {} mm after (model residual)", mm4(report.after->max_mm));
  return text;
}

}  // namespace counterflex
