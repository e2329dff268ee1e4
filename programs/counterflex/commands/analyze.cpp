#include <fmt/format.h>

#include "commands/commands.hpp"
#include "commands/kinematics.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/report/analysis.hpp"
#include "counterflex/statics/nominal.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/command_outputs.hpp"
#include "run/inputs.hpp"
#include "run/run_files.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

/// The poses of `--at`. A pose without an orientation has that of home.
std::vector<Pose> wanted_poses(const Options& options, const Model& model) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  std::vector<Pose> poses;
  for (const std::string& text : options.analyze.at) {
    const PoseText at = pose_of("--at", text);
    poses.push_back(at.has_orientation ? at.X : Pose{R_home, at.X.p});
  }
  return poses;
}

/// Reports the poses that were not solved. Returns the kind of error, or none.
std::optional<ErrorKind> judge(const AnalysisReport& report, const std::vector<Pose>& wanted,
                               const Options& options, Console& console) {
  std::optional<ErrorKind> error;
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    const bool corrected = !pose.corrected || pose.corrected->status == Status::converged;
    const Status status =
        pose.status == Status::converged && !corrected ? pose.corrected->status : pose.status;
    if (pose.status != Status::converged)
      console.error(fmt::format("--at {}: error: {}{}", options.analyze.at[i], to_string(pose.status),
                                pose.why.empty() ? "" : ": " + pose.why));
    else if (!corrected)
      console.error(fmt::format("--at {}: error: no target corrects this pose: {}", options.analyze.at[i],
                                to_string(status)));
    else
      warn_of_uncontrolled(pose.X_MT, wanted[i], pose_of("--at", options.analyze.at[i]).has_orientation,
                           "--at " + options.analyze.at[i], console);
    if (status == Status::converged || error == ErrorKind::not_compensated) continue;
    error = status == Status::outside_travel ? ErrorKind::limit : ErrorKind::not_compensated;
  }
  return error;
}

/// Throws (ErrorKind::usage) for wrong values or combinations, before files are read.
void check_values(const Options& options) {
  for (const std::string& text : options.analyze.at) pose_of("--at", text);
  if (options.analyze.hold) pose_of("--hold", *options.analyze.hold);
  if (options.analyze.curve) curve_of("--curve", *options.analyze.curve);
  if (!options.output) return;
  if (!options.analyze.curve)
    throw InputError(ErrorKind::usage, {},
                     "--output of analyze writes the points of --curve, which is not given");
  if (!options.output->ends_with(".csv"))
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("--output of analyze writes a file that ends in .csv, not '{}'", *options.output));
  check_output(options, curve_mark);
}

AnalysisExtras extras_of(const Options& options, const Model& machine, const Model& model) {
  AnalysisExtras extras{&machine.mechanism, options.analyze.full, {}, {}};
  if (options.analyze.hold) {
    const PoseText held = pose_of("--hold", *options.analyze.hold);
    extras.hold = held.has_orientation ? held.X : Pose{tip(model.mechanism, model.home).R, held.X.p};
  }
  if (options.analyze.curve) {
    const CurveText curve = curve_of("--curve", *options.analyze.curve);
    extras.curve = CurveRequest{curve.direction, curve.from, curve.to, curve.steps};
  }
  return extras;
}

/// Reports the states of --hold and --curve that were not found.
std::optional<ErrorKind> judge_extras(const AnalysisReport& report, const Options& options,
                                      Console& console) {
  std::optional<ErrorKind> error;
  const auto fail = [&](const std::string& what) {
    console.error(what);
    error = ErrorKind::not_compensated;
  };
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    if (pose.held && pose.held->status != Status::converged)
      fail(fmt::format("--hold {}: error: {}: {}", *options.analyze.hold, to_string(pose.held->status),
                       pose.held->why));
    if (pose.curve && pose.curve->status != Status::converged)
      fail(fmt::format("--curve {}: error: {} at --at {}: {} of {} points were found{}",
                       *options.analyze.curve, to_string(pose.curve->status), options.analyze.at[i],
                       pose.curve->points.size(), report.curve->steps + 1,
                       pose.curve->rigid ? "; " + reason(*pose.curve) : ""));
  }
  return error;
}

void write_curve(const AnalysisReport& report, const Options& options) {
  if (!options.output) return;
  FileWriter file(*options.output);
  file.write(to_csv(report));
  check_output(options, curve_mark);  // again: a foreign file may have appeared
  publish_together({&file});
}

}  // namespace

std::optional<ErrorKind> run_analyze(const Options& options, Console& console) {
  const bool kinematics = asks_for_kinematics(options);
  check_values(options);
  const MachineInput input = read_machine_input(options);
  const Load load{options.analyze.force.value_or(Vector6::Zero()), false};
  console.progress("solving");
  const auto* tool = options.analyze.tool ? &tool_named(*options.analyze.tool, input.machine) : nullptr;
  const Model with_tool = tool ? prepare_with_tool(input.machine, input.model, tool->second) : Model{};
  const Model& model = tool ? with_tool : input.model;
  const std::string tool_text =
      tool ? fmt::format("tool T{}: {}", tool->first, stiffness_phrase(tool->second)) : "";
  if (kinematics) return run_kinematics(options, model, input.machine.spindle_axis, tool_text, console);
  const std::vector<Pose> wanted = wanted_poses(options, model);
  AnalysisReport report =
      analyze(model, wanted, load, options.method, version, extras_of(options, input.model, model));
  report.tool = tool_text;
  write_result(options.json ? to_json(report) : to_text(report));
  write_curve(report, options);
  const auto error = judge(report, wanted, options, console), extras = judge_extras(report, options, console);
  return error ? error : extras;
}

}  // namespace counterflex::cli
