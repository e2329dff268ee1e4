#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/report/identification.hpp"
#include "report/identification/units.hpp"
#include "report/plot/svg.hpp"

namespace counterflex {
namespace {

constexpr double bar_width = 260;  // px

constexpr std::string_view head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="generator" content="counterflex identification">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width">
<style>
:root { color-scheme: light dark; --muted: #777; --line: #8884; --before: #c24e00; --after: #0072b2; }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; margin: .6rem 0 1.6rem; }
th, td { padding: .2rem .9rem .2rem 0; border-bottom: 1px solid var(--line); text-align: left; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
h2 { margin-top: 2rem; font-size: 1.15rem; }
p.lead { font-size: 1.1rem; }
.free td { color: var(--muted); }
.before { fill: var(--before); } .after { fill: var(--after); }
</style>
)";

std::string row(const std::vector<std::string>& cells, std::string_view tag = "td",
                std::string_view cls = "") {
  std::string text = cls.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", cls);
  for (std::size_t i = 0; i < cells.size(); ++i)
    text += fmt::format("<{0}{1}>{2}</{0}>", tag, i == 0 ? "" : " class=\"n\"", cells[i]);
  return text + "</tr>\n";
}

/// Two bars, before above after.
std::string bars(double before, double after, double largest) {
  const auto bar = [&](double value, int y, std::string_view cls) {
    return fmt::format("<rect class=\"{}\" x=\"0\" y=\"{}\" width=\"{:.1f}\" height=\"7\"/>", cls, y,
                       largest > 0 ? bar_width * value / largest : 0);
  };
  return fmt::format(
      "<svg width=\"{:.0f}\" height=\"18\" role=\"img\" aria-label=\"before {:.3g}, after "
      "{:.3g}\">{}{}</svg>",
      bar_width, before, after, bar(before, 1, "before"), bar(after, 10, "after"));
}

std::string arrow(double before, double after) {
  return fmt::format("{:.3g} &rarr; {:.3g}", before, after);
}

/// One line as people quote it.
std::string lead(const Identification& found) {
  if (found.held_out.empty())
    return "<p class=\"lead\">No held-out row tests the fit: how well the values predict is not known.</p>\n";
  std::string text;
  for (const HeldOutGroup& group : found.held_out) {
    const ErrorUnit unit = unit_of(group.kind, group.is_length);
    text += fmt::format(
        "<p class=\"lead\">{}, {}: mean error {} {} on {} rows that the fit did not see.</p>\n",
        xml_escaped(group.name), name_of(group.kind),
        arrow(group.before.mean / unit.si, group.after.mean / unit.si), unit.name, group.after.count);
  }
  return text;
}

std::string held_out_table(const Identification& found) {
  std::string text =
      "<h2>Rows that the fit did not see</h2>\n<table>\n" +
      row({"group", "rows", "unit", "mean", "rms", "95 %", "largest", "in their 95 % intervals", ""}, "th");
  for (const HeldOutGroup& group : found.held_out) {
    const auto add = [&](const std::string& name, const ErrorSummary& a, const ErrorSummary& b,
                         ErrorUnit unit, const std::string& in_interval) {
      if (b.count == 0) return;
      text += row({name, fmt::format("{}", b.count), std::string(unit.name),
                   arrow(a.mean / unit.si, b.mean / unit.si), arrow(a.rms / unit.si, b.rms / unit.si),
                   arrow(a.p95 / unit.si, b.p95 / unit.si), arrow(a.largest / unit.si, b.largest / unit.si),
                   in_interval, bars(a.mean, b.mean, std::max(a.mean, b.mean))});
    };
    add(fmt::format("{}, {}", xml_escaped(group.name), name_of(group.kind)), group.before, group.after,
        unit_of(group.kind, group.is_length), fmt::format("{:.0f} %", 100 * group.in_interval));
    add("orientation", group.angle_before, group.angle_after, {"deg", deg}, "");
  }
  text += "</table>\n";
  if (found.ladder.empty()) return text;
  text +=
      "<table>\n" + row({"set of parameters", "removes of the held-out error", "standard error", ""}, "th");
  for (const LadderStep& step : found.ladder) {
    if (step.is_tested)
      text += row({std::string(name_of(step.set)), fmt::format("{:.1f} %", 100 * step.gain),
                   fmt::format("{:.1f} %", 100 * step.gain_scatter),
                   step.is_kept ? "kept"
                   : step.left  ? "rejected, not tested there: " + xml_escaped(range_words(*step.left))
                                : "rejected"});
    if (!step.is_tested || !step.untested.empty())
      text +=
          row({std::string(name_of(step.set)), "", "", "not tested: " + xml_escaped(untested_words(step))});
  }
  return text + "</table>\n";
}

std::string parameter_table(const Identification& found) {
  std::string text =
      "<h2>Parameters</h2>\n<table>\n" + row({"name", "before", "after", "sigma", "prior sigma", ""}, "th");
  for (const IdentifiedParameter& p : found.parameters)
    text += row({xml_escaped(p.name), fmt::format("{:.5g}", p.before / p.unit),
                 fmt::format("{:.5g}", shown_value(p) / p.unit), fmt::format("{:.2g}", p.sigma / p.unit),
                 fmt::format("{:.2g}", p.prior / p.unit), p.is_identified ? "" : "not identified"},
                "td", p.is_identified ? "" : "free");
  text += "</table>\n";
  if (found.correlations.empty()) return text;
  text += "<h2>Correlations above 0.9</h2>\n<table>\n";
  for (const Correlation& c : found.correlations)
    text += row({xml_escaped(c.a), xml_escaped(c.b), fmt::format("{:.3f}", c.value)});
  return text + "</table>\n";
}

std::string program_table(const Identification& found) {
  if (!found.program) return "";
  const ProgramUncertainty& program = *found.program;
  std::string text = fmt::format(
      "<h2>Program {}</h2>\n<p>The standard deviation of its deviations is {:.3g} um rms. These "
      "measurements, "
      "one after the other, shrink it most:</p>\n<table>\n{}",
      xml_escaped(program.program), program.sigma / um, row({"measurement", "um before and after"}, "th"));
  double before = program.sigma;
  for (const NextMeasurement& next : program.next) {
    text += row({xml_escaped(next.what), arrow(before / um, next.sigma_after / um)});
    before = next.sigma_after;
  }
  return text + "</table>\n";
}

std::string file_line(const Location& at) {
  return xml_escaped(fmt::format("{}:{}", at.file.substr(at.file.find_last_of('/') + 1), at.line));
}

std::string row_tables(const Identification& found) {
  std::string text = fmt::format(
      "<h2>Noise and lack of fit</h2>\n<p>Residuals: {}. {}</p>\n", residual_words(found),
      found.noise.empty() ? "Without repeats that differ, noise and lack of fit are not known." : "");
  for (const SessionNoise& noise : found.noise)
    text += fmt::format("<p>{}, {}: {}</p>\n", xml_escaped(noise.session), name_of(noise.kind),
                        noise_words(noise));
  text += fmt::format("<p>{} rows do not fit and were left out.</p>\n", found.outlier_count);
  if (!found.outliers.empty()) {
    text += "<table>\n" + row({"row", "session", "error", "times its deviation"}, "th");
    for (const Outlier& outlier : found.outliers)
      text += row({file_line(outlier.at), xml_escaped(outlier.session),
                   fmt::format("{:.4g} mm", outlier.error / mm), fmt::format("{:.0f}", outlier.ratio)});
    text += "</table>\n";
  }
  if (found.worst.empty()) return text;
  text += "<p>The worst rows of the fit:";
  for (std::size_t i = 0; i < found.worst.size(); ++i)
    text += (i == 0 ? " " : ", ") + file_line(found.worst[i]);
  return text + ".</p>\n";
}

}  // namespace

std::string identification_page(const Identification& found, std::string_view machine,
                                std::string_view files) {
  const std::string title =
      machine.empty() ? "Identification" : fmt::format("Identification of {}", xml_escaped(machine));
  return fmt::format(
      "{}<title>{}</title></head><body>\n<h1>{}</h1>\n<p>Measurements: {}</p>\n{}{}{}{}{}</body></html>\n",
      head, title, title, xml_escaped(files), lead(found), held_out_table(found), parameter_table(found),
      program_table(found), row_tables(found));
}

}  // namespace counterflex
