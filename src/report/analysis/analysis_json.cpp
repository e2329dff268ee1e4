#include <fmt/core.h>

#include "counterflex/compensation/options.hpp"
#include "counterflex/geometry/types.hpp"
#include "report/analysis/analysis_parts.hpp"
#include "report/json/json_numbers.hpp"
#include "report/names.hpp"

namespace counterflex {

namespace {

Json actuators(const Eigen::VectorXd& rho, const AnalysisReport& report) {
  const std::vector<Travel>& travel = report.travel;
  const Eigen::VectorXd shown = shown_values(report.shown, rho);
  Json list = Json::array();
  for (Eigen::Index k = 0; k < shown.size(); ++k)
    list.push_back(number(shown[k] / unit_of(travel[k].kind).si, analysis_digits));
  return list;
}

Json corrected_json(const PoseAnalysis& pose, const AnalysisReport& report) {
  if (!pose.corrected) return nullptr;
  const CorrectedTarget& corrected = *pose.corrected;
  const std::string status(to_string(corrected.status));
  if (!has_values(corrected.status))
    return {{"target_mm", nullptr}, {"rpy_deg", nullptr}, {"actuators", nullptr}, {"status", status}};
  return {{"target_mm", numbers(Vector3(corrected.X_MT.p / mm), analysis_digits)},
          {"rpy_deg", numbers(Vector3(to_rpy(corrected.X_MT.R) / deg), analysis_digits)},
          {"actuators", actuators(corrected.rho, report)},
          {"status", status}};
}

Json chain_json(const ChainLoads& chain) {
  Json json = {{"name", chain.name}, {"wrench_N_Nm", numbers(chain.wrench, analysis_digits)}};
  for (const LoadKind kind : load_kinds) {
    const LoadName& name = name_of(kind);
    json[std::string(name.key)] = number(chain[kind] / name.si, analysis_digits);
  }
  return json;
}

Json chains_json(const std::vector<ChainLoads>& chains) {
  Json list = Json::array();
  for (const ChainLoads& chain : chains) list.push_back(chain_json(chain));
  return list;
}

Json standard_json(const PoseAnalysis& pose, const AnalysisReport& report) {
  const bool known = has_values(pose.status), stiff = known && pose.stiffness_available;
  const bool soft = known && pose.softest_stiffness != 0;
  const bool direction = !pose.weakest.isZero(0);
  const auto if_known = [&](Json value) { return known ? value : Json(nullptr); };
  return {{"target_mm", numbers(Vector3(pose.X_MT.p / mm), analysis_digits)},
          {"target_rpy_deg", numbers(Vector3(to_rpy(pose.X_MT.R) / deg), analysis_digits)},
          {"method", std::string(to_string(pose.method))},
          {"status", to_string(pose.status)},
          {"why", pose.why.empty() ? Json(nullptr) : Json(pose.why)},
          {"displacement_mm", if_known(numbers(Vector3(pose.deviation.head<3>() / mm), analysis_digits))},
          {"rotation_deg", if_known(numbers(Vector3(pose.deviation.tail<3>() / deg), analysis_digits))},
          {"stiffness_si", stiff ? matrix_json(pose.K) : Json(nullptr)},
          {"tip_stiffness_si", pose.tip_stiffness ? matrix_json(*pose.tip_stiffness) : Json(nullptr)},
          {"tip_compliance_si", pose.tip_compliance ? matrix_json(*pose.tip_compliance) : Json(nullptr)},
          {"weakest_direction", direction ? six_json(pose.weakest) : Json(nullptr)},
          {"weakest_stiffness_N_per_m",
           stiff ? significant(pose.weakest_stiffness, analysis_significant_digits) : Json(nullptr)},
          {"softest_direction", soft ? numbers(pose.softest, analysis_digits) : Json(nullptr)},
          {"softest_stiffness_N_per_m",
           soft ? significant(pose.softest_stiffness, analysis_significant_digits) : Json(nullptr)},
          {"indeterminate_wrenches", pose.indeterminate},
          {"condition", if_known(significant(pose.condition, analysis_significant_digits))},
          {"stability", if_known(significant(pose.stability, analysis_significant_digits))},
          {"actuators", known || pose.rho.size() > 0 ? actuators(pose.rho, report) : Json(nullptr)},
          {"corrected", corrected_json(pose, report)},
          {"chains", chains_json(pose.chains)}};
}

Json pose_json(const PoseAnalysis& pose, const AnalysisReport& report) {
  Json json = standard_json(pose, report);
  if (!pose.details.empty()) json["full"] = details_json(pose.details);
  if (pose.held) json["held"] = held_json(*pose.held);
  if (pose.curve) json["curve"] = curve_json(*pose.curve);
  return json;
}

}  // namespace

Json six_json(const Vector6& values) {
  Json list = Json::array();
  for (double value : values) list.push_back(significant(value, analysis_significant_digits));
  return list;
}

Json matrix_json(const Matrix6& K) {
  Json rows = Json::array();
  for (int i = 0; i < 6; ++i) rows.push_back(six_json(K.row(i).transpose()));
  return rows;
}

std::string to_json(const AnalysisReport& report) {
  Json poses = Json::array();
  for (const PoseAnalysis& pose : report.poses) poses.push_back(pose_json(pose, report));
  Json document = {{"schema", "counterflex-analysis 1"},
                   {"tool", fmt::format("counterflex {}", report.version)},
                   {"machine", report.machine},
                   {"wrench_N_Nm", numbers(report.load.F, analysis_digits)},
                   {"wrench_at", report.load.at_platform ? "platform" : "tip"},
                   {"poses", std::move(poses)}};
  if (!report.tool.empty()) document["machine_tool"] = report.tool;
  return dump(document);
}

}  // namespace counterflex
