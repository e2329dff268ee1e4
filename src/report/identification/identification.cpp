#include "counterflex/report/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "counterflex/geometry/types.hpp"
#include "report/identification/units.hpp"

namespace counterflex {
namespace {

using Json = nlohmann::ordered_json;

std::string pair_of(const ErrorSummary& before, const ErrorSummary& after, double unit) {
  return fmt::format("mean {:.3g} -> {:.3g}, 95 % {:.3g} -> {:.3g}, largest {:.3g} -> {:.3g}",
                     before.mean / unit, after.mean / unit, before.p95 / unit, after.p95 / unit,
                     before.largest / unit, after.largest / unit);
}

std::string place(const Location& at) {
  return fmt::format("{}:{}", at.file, at.line);
}

std::string parameter_lines(const Identification& found) {
  std::size_t width = 9;
  for (const IdentifiedParameter& p : found.parameters) width = std::max(width, p.name.size());
  std::string text =
      fmt::format("\n{:<{}} {:>12} {:>12} {:>11}\n", "parameter", width, "before", "after", "sigma");
  for (const IdentifiedParameter& p : found.parameters)
    text += fmt::format("{:<{}} {:>12.5g} {:>12.5g} {:>11.2g}{}\n", p.name, width, p.before / p.unit,
                        shown_value(p) / p.unit, p.sigma / p.unit, p.is_identified ? "" : "  not identified");
  return text;
}

std::string program_lines(const ProgramUncertainty& program) {
  std::string text =
      fmt::format("\nprogram      {}: the standard deviation of its deviations is {:.3g} um rms\n",
                  program.program, program.sigma / um);
  double before = program.sigma;
  for (const NextMeasurement& next : program.next) {
    text +=
        fmt::format("{} {}: {:.3g} -> {:.3g} um\n", before == program.sigma ? "measure next" : "       then ",
                    next.what, before / um, next.sigma_after / um);
    before = next.sigma_after;
  }
  if (program.next.empty()) text += "             no push and no tracker point would shrink it\n";
  return text;
}

Json json_of(const ProgramUncertainty& program) {
  Json json{{"name", program.program}, {"sigma_um", program.sigma / um}, {"next", Json::array()}};
  for (const NextMeasurement& next : program.next)
    json["next"].push_back({{"kind", name_of(next.kind)},
                            {"what", next.what},
                            {"sigma_row_um", next.row.sigma / um},
                            {"sigma_after_um", next.sigma_after / um}});
  return json;
}

/// Of a parameter's name, in SI.
double unit_named(std::string_view name, const Identification& found) {
  for (const IdentifiedParameter& p : found.parameters)
    if (p.name == name) return p.unit;
  return 1;
}

/// "x.mount.x_mm by 0.1, x.arm.x_mm by -0.1"
std::string changes_of(const FreeCombination& free, const Identification& found) {
  std::string text;
  for (const FreeCombination::Term& term : free.terms)
    text += fmt::format("{}{} by {:.2g}", text.empty() ? "" : ", ", term.name,
                        term.change / unit_named(term.name, found));
  return text;
}

Json json_of(const ErrorSummary& summary, double unit) {
  return {{"count", summary.count},
          {"mean", summary.mean / unit},
          {"rms", summary.rms / unit},
          {"p95", summary.p95 / unit},
          {"largest", summary.largest / unit}};
}

}  // namespace

std::string to_text(const Identification& found) {
  std::string text;
  for (const HeldOutGroup& group : found.held_out) {
    const ErrorUnit unit = unit_of(group.kind, group.is_length);
    text += fmt::format("held out     {}, {}: {} ({}, {} rows, {:.0f} % in their 95 % intervals)\n",
                        group.name, name_of(group.kind), pair_of(group.before, group.after, unit.si),
                        unit.name, group.after.count, 100 * group.in_interval);
    if (group.angle_after.count > 0)
      text += fmt::format("             orientation: {} (deg)\n",
                          pair_of(group.angle_before, group.angle_after, deg));
  }
  if (found.held_out.empty()) text += "held out     nothing: there are too few rows to test the fit\n";
  for (const LadderStep& step : found.ladder)
    text += fmt::format("{:<12} {}: removes {:.1f} % of the held-out error, standard error {:.1f} %\n",
                        step.is_kept ? "kept" : "rejected", name_of(step.set), 100 * step.gain,
                        100 * step.gain_scatter);
  text += fmt::format("lack of fit  {:.4g} mm rms of all rows", found.lack_of_fit / mm);
  text += found.repeatability
              ? fmt::format("; repeated states scatter by {:.4g} mm\n", *found.repeatability / mm)
              : "; no state was repeated, so that noise is not known\n";
  text += parameter_lines(found);
  std::string free;
  for (const IdentifiedParameter& p : found.parameters)
    if (!p.is_identified) free += (free.empty() ? "" : ", ") + p.name;
  if (!free.empty())
    text += "\nnot identified (the measurements leave more than half of the prior deviation): " + free + "\n";
  for (const FreeCombination& combination : found.free)
    text += fmt::format("free together {}\n", changes_of(combination, found));
  if (!found.is_converged)
    text += fmt::format("not converged: after {} steps the fit still moves; do not use the result\n",
                        found.iterations);
  for (const Correlation& c : found.correlations)
    text += fmt::format("correlation  {} and {}: {:.3f}\n", c.a, c.b, c.value);
  if (found.outlier_count > 0) {
    text += fmt::format("\noutliers     {} rows do not fit and were left out\n", found.outlier_count);
    for (std::size_t i = 0; i < std::min<std::size_t>(found.outliers.size(), 10); ++i)
      text += fmt::format("  {} ({}): {:.4g} mm, {:.0f} times the deviation of its session\n",
                          place(found.outliers[i].at), found.outliers[i].session,
                          found.outliers[i].error / mm, found.outliers[i].ratio);
  }
  if (found.program) text += program_lines(*found.program);
  return text;
}

std::string to_json(const Identification& found) {
  Json json{{"schema", "counterflex-identification 1"}};
  json["parameters"] = Json::array();
  for (const IdentifiedParameter& p : found.parameters)
    json["parameters"].push_back({{"name", p.name},
                                  {"before", p.before / p.unit},
                                  {"value", p.value / p.unit},
                                  {"sigma", p.sigma / p.unit},
                                  {"prior_sigma", p.prior / p.unit},
                                  {"prior_is_default", p.is_default_prior},
                                  {"identified", p.is_identified}});
  json["covariance"] = Json::array();
  for (std::size_t i = 0; i < found.parameters.size(); ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < found.parameters.size(); ++j)
      row.push_back(found.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) /
                    (found.parameters[i].unit * found.parameters[j].unit));
    json["covariance"].push_back(std::move(row));
  }
  json["ladder"] = Json::array();
  for (const LadderStep& step : found.ladder)
    json["ladder"].push_back({{"set", name_of(step.set)},
                              {"gain", step.gain},
                              {"standard_error", step.gain_scatter},
                              {"kept", step.is_kept}});
  json["held_out"] = Json::array();
  for (const HeldOutGroup& group : found.held_out) {
    const ErrorUnit unit = unit_of(group.kind, group.is_length);
    Json entry{{"name", group.name},
               {"kind", name_of(group.kind)},
               {"unit", unit.name},
               {"before", json_of(group.before, unit.si)},
               {"after", json_of(group.after, unit.si)},
               {"in_95_percent_interval", group.in_interval}};
    if (group.angle_after.count > 0) {
      entry["angle_deg_before"] = json_of(group.angle_before, deg);
      entry["angle_deg_after"] = json_of(group.angle_after, deg);
    }
    json["held_out"].push_back(std::move(entry));
  }
  json["lack_of_fit_mm"] = found.lack_of_fit / mm;
  json["repeatability_mm"] = found.repeatability ? Json(*found.repeatability / mm) : Json(nullptr);
  json["correlations"] = Json::array();
  for (const Correlation& c : found.correlations)
    json["correlations"].push_back({{"a", c.a}, {"b", c.b}, {"value", c.value}});
  json["free_together"] = Json::array();
  for (const FreeCombination& free : found.free) {
    Json terms = Json::array();
    for (const FreeCombination::Term& term : free.terms)
      terms.push_back({{"name", term.name}, {"change", term.change / unit_named(term.name, found)}});
    json["free_together"].push_back(std::move(terms));
  }
  json["converged"] = found.is_converged;
  json["outliers"] = found.outlier_count;
  json["outlier_rows"] = Json::array();
  for (const Outlier& outlier : found.outliers)
    json["outlier_rows"].push_back({{"file", outlier.at.file},
                                    {"line", outlier.at.line},
                                    {"session", outlier.session},
                                    {"error_mm", outlier.error / mm},
                                    {"ratio", outlier.ratio}});
  json["worst_rows"] = Json::array();
  for (const Location& at : found.worst) json["worst_rows"].push_back({{"file", at.file}, {"line", at.line}});
  if (found.program) json["program"] = json_of(*found.program);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace counterflex
