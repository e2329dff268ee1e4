#include <fmt/format.h>

#include "commands.hpp"
#include "counterflex/files/numbers.hpp"
#include "counterflex/machine/tool.hpp"
#include "counterflex/report/analysis.hpp"
#include "counterflex/statics/tool_models.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "values.hpp"
#include "version.hpp"

namespace counterflex::cli {
namespace {

/// The poses asked for; without an orientation, home's.
std::vector<Pose> wanted_poses(const Options& options, const Model& model) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  std::vector<Pose> poses;
  for (const std::string& text : options.at) {
    const PoseText at = pose_of("--at", text);
    poses.push_back(at.has_orientation ? at.X : Pose{R_home, at.X.p});
  }
  return poses;
}

/// What `--at` says of components that the machine does not control, and where it stands instead.
void warn_of_uncontrolled(const PoseAnalysis& pose, const Pose& asked, const std::string& at,
                          Console& console) {
  const Vector6 difference = deviation(pose.X_MT, asked);
  const bool turned = pose_of("--at", at).has_orientation && difference.tail<3>().norm() > 1e-9;
  if (difference.head<3>().norm() < 1e-9 && !turned) return;
  console.warning(
      "--at " + at, 0,
      "the machine does not control all components of this pose; those of the nominal machine are taken");
}

/// Says which poses were not solved; the exit status that they ask for.
Exit judge(const AnalysisReport& report, const std::vector<Pose>& asked, const Options& options,
           Console& console) {
  Exit exit = Exit::done;
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    const bool corrected = !pose.corrected || pose.corrected->status == Status::converged;
    const Status status =
        pose.status == Status::converged && !corrected ? pose.corrected->status : pose.status;
    if (pose.status != Status::converged)
      console.error(fmt::format("--at {}: error: {}{}", options.at[i], to_string(pose.status),
                                pose.why.empty() ? "" : ": " + pose.why));
    else if (!corrected)
      console.error(
          fmt::format("--at {}: error: no target corrects this pose: {}", options.at[i], to_string(status)));
    else
      warn_of_uncontrolled(pose, asked[i], options.at[i], console);
    if (status == Status::converged || exit == Exit::not_compensated) continue;
    exit = status == Status::outside_travel ? Exit::limit : Exit::not_compensated;
  }
  return exit;
}

/// Throws (Exit::usage) naming the tools that there are.
const std::pair<const long, Tool>& tool_named(const std::string& text, const Machine& machine) {
  const std::optional<long> number = read_tool_number(text);
  if (!number)
    throw InputError(Exit::usage, {}, fmt::format("--tool is '{}', must be T and its number, as T3", text));
  std::string known;
  for (const auto& entry : machine.tools) {
    if (entry.first == 0) continue;  // no known tool: what [tool] says
    if (entry.first == *number) return entry;
    known += fmt::format("{}T{}", known.empty() ? "" : ", ", entry.first);
  }
  throw InputError(Exit::usage, {},
                   fmt::format("--tool {}: the machine file has no such tool; it has {}", text,
                               known.empty() ? "none" : known));
}

}  // namespace

Exit run_analyze(const Options& options, Console& console) {
  for (const std::string& text : options.at) pose_of("--at", text);  // before files are read
  const MachineInput input = read_machine_input(options);
  const Load load{options.force.value_or(Vector6::Zero()), false};
  console.progress("solving");
  const auto* tool = options.tool ? &tool_named(*options.tool, input.machine) : nullptr;
  const Model with_tool = tool ? prepare_with_tool(input.machine, input.model, tool->second) : Model{};
  const Model& model = tool ? with_tool : input.model;
  const std::vector<Pose> asked = wanted_poses(options, model);
  AnalysisReport report = analyze(model, asked, load, options.method, version);
  if (tool) report.tool = fmt::format("tool T{}: {}", tool->first, stiffness_phrase(tool->second));
  write_result(options.json ? to_json(report) : to_text(report));
  return judge(report, asked, options, console);
}

}  // namespace counterflex::cli
