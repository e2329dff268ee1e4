#include <fmt/core.h>

#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "report/analysis/analysis_parts.hpp"

namespace counterflex {

namespace {

Json point_json(const CurvePoint& point) {
  return {{"displacement_mm", number(point.displacement / mm, analysis_digits)},
          {"force_N", significant(point.force, analysis_significant_digits)},
          {"stiffness_N_per_m", significant(point.stiffness, analysis_significant_digits)},
          {"stable", point.stable},
          {"tip_mm", numbers(Vector3(point.X_MT.p / mm), analysis_digits)}};
}

Json points_json(const std::vector<CurvePoint>& points) {
  Json list = Json::array();
  for (const CurvePoint& point : points) list.push_back(point_json(point));
  return list;
}

/// What acts where the curve begins.
std::string begin_in_words(const AnalysisReport& report) {
  std::string loads = own_loads(report);
  if (!report.load.F.isZero(0)) loads = loads.empty() ? "--force" : "--force and " + loads;
  return loads.empty() ? "without force" : "under " + loads + ", to which this force adds";
}

std::string curve_text(std::size_t index, const ForceCurve& curve) {
  std::string text;
  for (const CurvePoint& point : curve.points)
    text += fmt::format("  {:>3}{:>18}{:>18}{:>18}   {}\n", index, format_fixed(point.displacement / mm, 6),
                        format_fixed(point.force, 4),
                        std::isfinite(point.stiffness) ? format_fixed(point.stiffness * um, 4) : "rigid",
                        point.stable ? "stable" : "unstable");
  for (const CurvePoint& point : curve.critical)
    text += fmt::format("      critical load {} N at {} mm; beyond it unstable under a constant force\n",
                        format_fixed(point.force, 4), format_fixed(point.displacement / mm, 6));
  if (curve.status != Status::converged)
    text += fmt::format("      {}: {}\n", to_string(curve.status), reason(curve));
  return text;
}

}  // namespace

std::string reason(const ForceCurve& curve) {
  if (curve.status == Status::converged) return "";
  if (curve.rigid) return "the machine is rigid along this direction: a force along it does not move the tip";
  return curve.points.empty() ? "the state without the force was not found"
                              : "the other points were not found";
}

Json curve_json(const ForceCurve& curve) {
  const std::string why = reason(curve);
  return {{"status", to_string(curve.status)},
          {"why", why.empty() ? Json(nullptr) : Json(why)},
          {"points", points_json(curve.points)},
          {"critical", points_json(curve.critical)}};
}

std::string curves_text(const AnalysisReport& report) {
  if (!report.curve) return "";
  const Vector3& d = report.curve->direction;
  std::string text = fmt::format(
      "\nForce over displacement of the tip along ({}, {}, {}), from its place {}\n", format_fixed(d.x(), 3),
      format_fixed(d.y(), 3), format_fixed(d.z(), 3), begin_in_words(report));
  text += fmt::format("  {:>3}{:>18}{:>18}{:>18}\n", "", "mm", "N", "tangent, N/um");
  for (std::size_t i = 0; i < report.poses.size(); ++i)
    if (report.poses[i].curve) text += curve_text(i + 1, *report.poses[i].curve);
  return text;
}

std::string to_csv(const AnalysisReport& report) {
  std::string text = std::string(curve_mark) + ",stiffness_N_per_m,stable,x_mm,y_mm,z_mm\n";
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    if (!report.poses[i].curve) continue;
    for (const CurvePoint& point : report.poses[i].curve->points) {
      // A force of less than a micronewton is what rounding leaves of zero.
      text += fmt::format("{},{},{:.12g},{},{}", i + 1, format_fixed(point.displacement / mm, 9),
                          rounded(point.force, 6),
                          std::isfinite(point.stiffness) ? fmt::format("{:.12g}", point.stiffness) : "",
                          point.stable ? 1 : 0);
      for (const double x : point.X_MT.p) text += "," + format_fixed(x / mm, 9);
      text += "\n";
    }
  }
  return text;
}

}  // namespace counterflex
