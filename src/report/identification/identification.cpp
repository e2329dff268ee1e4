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

/// "  26.3 N/um": the stiffness that a compliance is, which people know; else empty.
std::string stiffness_words(const IdentifiedParameter& p) {
  if (p.kind != ParameterKind::compliance || !(p.value > 0)) return "";
  if (p.name.ends_with("_m_per_N")) return fmt::format("  {:.3g} N/um", um / p.value);
  return fmt::format("  {:.3g} N m/rad", 1 / p.value);
}

/// All parameters, or those that the data identify.
std::string parameter_lines(const Identification& found, bool all) {
  std::size_t width = 9;
  bool is_any = false;
  for (const IdentifiedParameter& p : found.parameters) {
    if (!all && !p.is_identified) continue;
    width = std::max(width, p.name.size());
    is_any = true;
  }
  if (!is_any)
    return found.parameters.empty() && !found.ladder.empty()
               ? "\nno parameter changes: no set was kept (--all keeps rejected sets, too)\n"
               : "\nno parameter is identified (-v lists them)\n";
  std::string text =
      fmt::format("\n{:<{}} {:>12} {:>12} {:>11}\n", "parameter", width, "before", "after", "sigma");
  for (const IdentifiedParameter& p : found.parameters)
    if (all || p.is_identified)
      text += fmt::format("{:<{}} {:>12.5g} {:>12.5g} {:>11.2g}{}\n", p.name, width, p.before / p.unit,
                          shown_value(p) / p.unit, p.sigma / p.unit,
                          p.is_identified ? stiffness_words(p) : "  not identified");
  return text;
}

/// "XY.x_mm y_mm, spindle.rx_deg": names with their slot once.
std::string free_names(const Identification& found) {
  std::string text;
  std::string_view slot;
  for (const IdentifiedParameter& p : found.parameters) {
    if (p.is_identified) continue;
    const std::string_view name = p.name;
    const std::size_t dot = name.rfind('.');
    const std::string_view its_slot = dot == std::string_view::npos ? "" : name.substr(0, dot);
    if (!text.empty() && !its_slot.empty() && its_slot == slot)
      text += fmt::format(" {}", name.substr(dot + 1));
    else
      text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
    slot = its_slot;
  }
  return text;
}

/// In stated deviations: more than noise explains.
constexpr double large_misfit = 3;

std::string misfit_lines(const Identification& found) {
  std::string text = "residuals    " + residual_words(found);
  text += found.noise.empty() ? "; without repeats that differ, noise and lack of fit are not known\n" : "\n";
  for (const SessionNoise& noise : found.noise)
    text += fmt::format("noise        {}, {}: {}\n", noise.session, name_of(noise.kind), noise_words(noise));
  if (found.misfit.value_or(0) > large_misfit)
    text +=
        "             this is more than noise: check signs, units and columns of the rows, the tool and the "
        "kinds of errors\n             that the machine file has, or state larger deviations\n";
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

Json json_of(const LeftRange& left) {
  const double unit = left.turns ? deg : mm;
  const std::string name = left.turns ? "deg" : "mm";
  return {{"group", left.group},
          {"actuator", left.actuator},
          {"trained_" + name, {left.trained_min / unit, left.trained_max / unit}},
          {"tested_" + name, {left.tested_min / unit, left.tested_max / unit}}};
}

Json json_of(const SessionNoise& noise) {
  return {{"session", noise.session},
          {"kind", name_of(noise.kind)},
          {"noise_mm", noise.noise / mm},
          {"degrees_of_freedom", noise.freedoms},
          {"misfit_of_means_mm", noise.misfit / mm},
          {"noise_of_means_mm", noise.noise_of_means / mm},
          {"lack_of_fit_mm", noise.lack_of_fit / mm},
          {"lacks", noise.is_lacking}};
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

Json parameters_json(const Identification& found) {
  Json all = Json::array();
  for (const IdentifiedParameter& p : found.parameters)
    all.push_back({{"name", p.name},
                   {"before", p.before / p.unit},
                   {"value", p.value / p.unit},
                   {"sigma", p.sigma / p.unit},
                   {"prior_sigma", p.prior / p.unit},
                   {"prior_is_default", p.is_default_prior},
                   {"identified", p.is_identified}});
  return all;
}

/// In the units of the parameters' names.
Json covariance_json(const Identification& found) {
  Json all = Json::array();
  for (std::size_t i = 0; i < found.parameters.size(); ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < found.parameters.size(); ++j)
      row.push_back(found.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) /
                    (found.parameters[i].unit * found.parameters[j].unit));
    all.push_back(std::move(row));
  }
  return all;
}

Json json_of(const LadderStep& step) {
  Json json{{"set", name_of(step.set)},
            {"gain", step.is_tested ? Json(step.gain) : Json()},
            {"standard_error", step.is_tested ? Json(step.gain_scatter) : Json()},
            {"tested", step.is_tested},
            {"kept", step.is_kept}};
  if (!step.untested.empty()) json["untested_parameters"] = step.untested;
  if (step.left) json["left_range"] = json_of(*step.left);
  return json;
}

Json json_of(const HeldOutGroup& group) {
  const ErrorUnit unit = unit_of(group.kind, group.is_length);
  Json json{{"name", group.name},
            {"kind", name_of(group.kind)},
            {"unit", unit.name},
            {"before", json_of(group.before, unit.si)},
            {"after", json_of(group.after, unit.si)},
            {"in_95_percent_interval", group.in_interval}};
  if (group.angle_after.count > 0) {
    json["angle_deg_before"] = json_of(group.angle_before, deg);
    json["angle_deg_after"] = json_of(group.angle_after, deg);
  }
  return json;
}

}  // namespace

std::string to_text(const Identification& found, bool all_parameters) {
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
  if (found.held_out.empty() && found.untested_rows == 0)
    text +=
        "held out     nothing: there are not two groups (sessions, regions or parts) with enough rows; see "
        "--hold-out\n";
  if (found.untested_rows > 0)
    text += fmt::format("not tested   {} rows: the others do not determine what they show\n",
                        found.untested_rows);
  for (const LadderStep& step : found.ladder) {
    if (step.is_tested)
      text += fmt::format("{:<12} {}: removes {:.1f} % of the held-out error, standard error {:.1f} %\n",
                          step.is_kept ? "kept" : "rejected", name_of(step.set), 100 * step.gain,
                          100 * step.gain_scatter);
    if (step.left) text += fmt::format("             not tested there: {}\n", range_words(*step.left));
    if (!step.is_tested || !step.untested.empty())
      text += fmt::format("not tested   {}: {}\n", name_of(step.set), untested_words(step));
  }
  text += misfit_lines(found);
  text += parameter_lines(found, all_parameters);
  if (const std::string free = free_names(found); !free.empty())
    text +=
        "\nnot identified (the measurements leave more than half of the prior deviation):\n  " + free + "\n";
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
  json["parameters"] = parameters_json(found);
  json["covariance"] = covariance_json(found);
  json["ladder"] = Json::array();
  for (const LadderStep& step : found.ladder) json["ladder"].push_back(json_of(step));
  json["held_out"] = Json::array();
  for (const HeldOutGroup& group : found.held_out) json["held_out"].push_back(json_of(group));
  json["untested_rows"] = found.untested_rows;
  json["lack_of_fit_mm"] = found.lack_of_fit ? Json(*found.lack_of_fit / mm) : Json(nullptr);
  if (found.misfit) json["misfit"] = *found.misfit;
  json["repeatability_mm"] = found.repeatability ? Json(*found.repeatability / mm) : Json(nullptr);
  json["noise"] = Json::array();
  for (const SessionNoise& noise : found.noise) json["noise"].push_back(json_of(noise));
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
