#include "commands/kinematics.hpp"

#include <fmt/format.h>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/kinematics.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(ErrorKind::usage, {}, what);
}

std::string_view writer_of(const AnalyzeOptions& options) {
  return options.as ? std::string_view(*options.as) : "fanuc";
}

/// Options of an analysis have no effect on kinematics.
void refuse_analysis_options(const Options& options) {
  const AnalyzeOptions& analyze = options.analyze;
  const std::string_view unused = !analyze.at.empty() ? "--at"
                                  : analyze.force     ? "--force"
                                  : analyze.full      ? "--full"
                                  : analyze.hold      ? "--hold"
                                  : analyze.curve     ? "--curve"
                                  : options.output    ? "--output"
                                                      : "";
  if (!unused.empty())
    refuse(fmt::format("--joints and --pose print kinematics only: {} must not be given with them", unused));
}

/// (m, rad).
Eigen::VectorXd shown_of(const std::string& text, const std::vector<Travel>& travel) {
  const std::vector<double> values = numbers_of("--joints", text);
  if (values.size() != travel.size())
    refuse(fmt::format("--joints: '{}' has {} numbers, must be one for each of the {} actuators", text,
                       values.size(), travel.size()));
  Eigen::VectorXd shown(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    shown[static_cast<Eigen::Index>(i)] = values[i] * (travel[i].kind == JointKind::prismatic ? mm : deg);
  return shown;
}

}  // namespace

bool asks_for_kinematics(const Options& options) {
  const AnalyzeOptions& analyze = options.analyze;
  if (analyze.as) choice_of("--as", *analyze.as, pose_writers);
  if (analyze.as && analyze.poses.empty()) refuse("--as needs --pose: it is how the pose is written");
  if (analyze.joints.empty() && analyze.poses.empty()) {
    if (analyze.at.empty())
      refuse("analyze needs a pose: --at X,Y,Z, --joints J1,J2,... or --pose X,Y,Z,A,B,C");
    return false;
  }
  refuse_analysis_options(options);
  for (const std::string& text : analyze.joints) numbers_of("--joints", text);
  for (const std::string& text : analyze.poses) written_pose_of("--pose", text, writer_of(analyze));
  return true;
}

void warn_of_uncontrolled(const Pose& found, const Pose& wanted, bool has_orientation,
                          const std::string& option, Console& console) {
  const Vector6 off = deviation(found, wanted);
  if (off.head<3>().norm() < 1e-9 && !(has_orientation && off.tail<3>().norm() > 1e-9)) return;
  console.warning(option, 0,
                  "the machine does not control all components of this pose; the others are those of the "
                  "nominal machine");
}

std::optional<ErrorKind> run_kinematics(const Options& options, const Model& model, SpindleAxis spindle_axis,
                                        const std::string& tool, Console& console) {
  const AnalyzeOptions& analyze = options.analyze;
  KinematicsReport report{version, model.mechanism.name, tool, model.mechanism.travel, {}, spindle_axis};
  std::vector<std::string> asked;
  for (const std::string& text : analyze.joints) {
    report.places.push_back(place_at_values(model, shown_of(text, report.travel)));
    asked.push_back("--joints " + text);
  }
  for (const std::string& text : analyze.poses) {
    Pose X_MT = written_pose_of("--pose", text, writer_of(analyze));
    X_MT.R = X_MT.R * tool_axes(spindle_axis);
    report.places.push_back(place_at_tip(model, X_MT));
    asked.push_back("--pose " + text);
    if (report.places.back().status == Status::converged)
      warn_of_uncontrolled(report.places.back().X_MT, X_MT, true, asked.back(), console);
  }
  write_result(options.json ? to_json(report) : to_text(report));
  std::optional<ErrorKind> error;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const KinematicPlace& place = report.places[i];
    if (place.status == Status::converged) continue;
    console.error(fmt::format("{}: error: {}: {}", asked[i], to_string(place.status), place.why));
    if (error != ErrorKind::not_compensated)
      error = place.status == Status::outside_travel ? ErrorKind::limit : ErrorKind::not_compensated;
  }
  return error;
}

}  // namespace counterflex::cli
