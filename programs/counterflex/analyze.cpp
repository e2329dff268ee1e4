#include <fmt/format.h>

#include "commands.hpp"
#include "counterflex/report/analysis.hpp"
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

/// Says which poses were not solved; whether there was none.
bool all_solved(const AnalysisReport& report, const Options& options, Console& console) {
  bool all = true;
  for (std::size_t i = 0; i < report.poses.size(); ++i) {
    const PoseAnalysis& pose = report.poses[i];
    if (pose.status != Status::converged) {
      console.error(fmt::format("--at {}: error: {}{}", options.at[i], to_string(pose.status),
                                pose.why.empty() ? "" : ": " + pose.why));
      all = false;
    } else if (pose.corrected && pose.corrected->status != Status::converged) {
      console.warning("--at " + options.at[i], 0,
                      fmt::format("no target corrects this pose: {}", to_string(pose.corrected->status)));
    }
  }
  return all;
}

}  // namespace

Exit run_analyze(const Options& options, Console& console) {
  for (const std::string& text : options.at) pose_of("--at", text);  // before files are read
  const MachineInput input = read_machine_input(options);
  const Load load{options.force.value_or(Vector6::Zero()), false};
  console.progress("solving");
  const AnalysisReport report =
      analyze(input.model, wanted_poses(options, input.model), load, options.method, version);
  write_result(options.json ? to_json(report) : to_text(report));
  return all_solved(report, options, console) ? Exit::done : Exit::not_compensated;
}

}  // namespace counterflex::cli
