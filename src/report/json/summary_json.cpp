#include "report/json/summary_json.hpp"

#include <fmt/format.h>

#include "report/json/uncertainty_json.hpp"

namespace counterflex {
namespace {

constexpr int summary_digits = 7;  // 1e-7 mm, 1e-7 deg

}  // namespace

Json optional_number(const std::optional<double>& value) {
  return value ? number(*value, summary_digits) : Json(nullptr);
}

namespace {

Json statistics_json(const DeviationStatistics& s) {
  Json json = {{"max_mm", number(s.max_mm, summary_digits)},
               {"rms_mm", optional_number(s.rms_mm)},
               {"mean_mm", optional_number(s.mean_mm)},
               {"p95_mm", optional_number(s.p95_mm)},
               {"max_line", s.max_line},
               {"max_axis_mm", numbers(s.max_axis_mm, summary_digits)},
               {"max_rotation_deg", number(s.max_rotation_deg, summary_digits)},
               {"max_along_mm", number(s.max_along_mm, summary_digits)},
               {"max_across_mm", number(s.max_across_mm, summary_digits)},
               {"max_tool_axis_mm", number(s.max_tool_axis_mm, summary_digits)}};
  if (s.bands) json["band"] = bands_json(*s.bands);
  return json;
}

}  // namespace

Json optional_statistics(const std::optional<DeviationStatistics>& s) {
  return s ? statistics_json(*s) : Json(nullptr);
}

namespace {

Json largest_json(const std::optional<Largest>& largest) {
  if (!largest) return nullptr;
  return {{"max_mm", number(largest->mm, summary_digits)}, {"line", largest->line}};
}

}  // namespace

Json sources_at_json(const SourcesAtWorst& at, const std::function<bool(const Cause&)>& shown) {
  Json json = {{"line", at.line},
               {"place_mm", numbers(at.place_mm, summary_digits)},
               {"geometry_mm", nullptr},
               {"load_mm", nullptr},
               {"gravity_mm", nullptr},
               {"preloads_mm", nullptr},
               {"superposition_mm", numbers(at.superposition_mm, summary_digits)},
               {"before_mm", numbers(at.before_mm, summary_digits)}};
  for (const Cause& cause : all_causes)
    if (shown(cause)) json[fmt::format("{}_mm", cause.name)] = numbers(at.*cause.at_worst_mm, summary_digits);
  return json;
}

namespace {

Json at_worst_json(const Sources& sources, const std::optional<SourcesAtWorst>& worst) {
  if (!worst) return nullptr;
  return sources_at_json(*worst, [&](const Cause& cause) { return (sources.*cause.statistics).has_value(); });
}

Json sources_json(const RunReport& report) {
  const std::optional<Sources>& sources = report.sources;
  if (!sources) return nullptr;
  Json json = {{"geometry", nullptr}, {"load", nullptr},
               {"gravity", nullptr},  {"superposition", statistics_json(sources->superposition)},
               {"preloads", nullptr}, {"at_worst", at_worst_json(*sources, report.at_worst)}};
  for (const Cause& cause : all_causes)
    if (const auto& s = (*sources).*cause.statistics) json[std::string(cause.name)] = statistics_json(*s);
  return json;
}

/// Null if part of the path is unknown: its largest value would be misleading.
Json other_force_json(const UnderOtherForce& other) {
  return other.unsolved > 0 ? Json(nullptr) : statistics_json(other.deviation);
}

Json sensitivity_json(const std::optional<Sensitivity>& sensitivity) {
  if (!sensitivity) return nullptr;
  return {{"force_plus_30", other_force_json(sensitivity->higher)},
          {"force_minus_30", other_force_json(sensitivity->lower)},
          {"without_force", statistics_json(sensitivity->without)}};
}

Json common_shift_json(const std::optional<CommonShift>& shift) {
  if (!shift) return nullptr;
  Json offsets = Json::array();
  for (const CommonShift::OfOffset& offset : shift->offsets)
    offsets.push_back({{"work", offset.work.empty() ? Json(nullptr) : Json(offset.work)},
                       {"shift_mm", numbers(offset.shift_mm, summary_digits)}});
  return {{"max_mm", number(shift->largest_mm(), summary_digits)},
          {"offsets", std::move(offsets)},
          {"rest", statistics_json(shift->rest)}};
}

Json work_shift_json(const BestOffsets::OfWork& work) {
  return {{"work", work.work.empty() ? Json(nullptr) : Json(work.work)},
          {"shift_mm", numbers(work.shift_mm, summary_digits)},
          {"turn_deg", work.turn_deg ? numbers(*work.turn_deg, summary_digits) : Json(nullptr)},
          {"words", work.words},
          {"before_max_mm", number(work.before_mm, summary_digits)},
          {"rest_max_mm", number(work.rest_mm, summary_digits)}};
}

}  // namespace

Json best_offsets_json(const BestOffsets& best) {
  Json work = Json::array(), tools = Json::array();
  for (const BestOffsets::OfWork& of : best.work) work.push_back(work_shift_json(of));
  for (const BestOffsets::OfTool& tool : best.tools)
    tools.push_back({{"tool", tool.tool},
                     {"length_mm", optional_number(tool.length_mm)},
                     {"radius_mm", optional_number(tool.radius_mm)},
                     {"words", tool.words}});
  return {{"work", std::move(work)},
          {"tools", std::move(tools)},
          {"before", statistics_json(best.before)},
          {"rest", statistics_json(best.rest)},
          {"least_max_mm", number(best.least_mm, summary_digits)},
          {"is_enough", best.is_enough},
          {"passes", best.passes},
          {"notes", best.notes}};
}

namespace {

Json tool_deviation_json(const std::optional<ToolDeviation>& off) {
  if (!off) return nullptr;
  return {{"tip_mm", number(off->tip_mm, summary_digits)},
          {"rim_mm", optional_number(off->rim_mm)},
          {"flank_mm", optional_number(off->flank_mm)},
          {"tilt_deg", number(off->tilt_deg, summary_digits)},
          {"line", off->line}};
}

Json tools_off_json(const std::vector<ToolReport>& tools) {
  const auto in_mm = [](const std::optional<double>& length) {
    return length ? number(*length / mm, summary_digits) : Json(nullptr);
  };
  Json list = Json::array();
  for (const ToolReport& tool : tools)
    list.push_back({{"tool", tool.size.number},
                    {"diameter_mm", in_mm(tool.size.diameter)},
                    {"flute_mm", in_mm(tool.size.flute)},
                    {"before", tool_deviation_json(tool.before)},
                    {"after", tool_deviation_json(tool.after)}});
  return list;
}

}  // namespace

Json summary_json(const RunReport& report) {
  return {
      {"before", optional_statistics(report.before)},
      {"after", optional_statistics(report.after)},
      {"sources", sources_json(report)},
      {"sensitivity", sensitivity_json(report.sensitivity)},
      {"air", largest_json(report.air)},
      {"correction", largest_json(report.correction)},
      {"corrected_percent", optional_number(report.corrected_percent)},
      {"path_mm", report.before || !report.failure ? number(report.path_mm, summary_digits) : Json(nullptr)},
      {"common_shift", common_shift_json(report.common_shift)},
      {"tool_deviations", tools_off_json(report.tools_off)}};
}

}  // namespace counterflex
