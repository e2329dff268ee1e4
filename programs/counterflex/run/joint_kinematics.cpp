#include "run/joint_kinematics.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/program_axes.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/nominal.hpp"
#include "run/work.hpp"

namespace counterflex::cli {
namespace {

/// The machine, and its models with the tools and external axes that joint targets had so far.
class Robot {
 public:
  explicit Robot(const Machine& machine) : machine_(machine) {}

  /// May be called from several threads.
  std::optional<Pose> place_of(const JointPlace& place, std::int32_t tool, const ProgramFrame& frame) {
    const std::scoped_lock lock(mutex_);
    const auto X_MW = known_frame(machine_, frame);
    if (!X_MW) return std::nullopt;
    const Model& model = model_of(place.external, tool);
    const Mechanism& mechanism = model.mechanism;
    if (mechanism.travel.size() != place.joints.size()) return std::nullopt;
    const Eigen::VectorXd shown = Eigen::Map<const Eigen::VectorXd>(place.joints.data(), 6);
    const NominalResult result = nominal_forward(model, model.home, joint_values(mechanism.shown, shown));
    if (result.status != Status::converged) return std::nullopt;
    Pose X_WT = inverse(*X_MW) * tip(mechanism, result.configuration);
    X_WT.p /= mm;
    return X_WT;
  }

 private:
  const Model& model_of(const ProgramAxisValues& external, std::int32_t tool) {
    const auto known = models_.find({external, tool});
    if (known != models_.end()) return known->second;
    const Machine placed = at_program_axes(machine_, external);
    Model model = prepare(placed);
    const auto named = machine_.tools.find(tool);
    if (tool != 0 && named != machine_.tools.end()) model = prepare_with_tool(placed, model, named->second);
    return models_.emplace(std::pair(external, tool), std::move(model)).first->second;
  }

  std::mutex mutex_{};
  Machine machine_;
  std::map<std::pair<ProgramAxisValues, std::int32_t>, Model> models_{};
};

}  // namespace

JointKinematics joint_kinematics(const Machine& machine) {
  return [robot = std::make_shared<Robot>(machine)](const JointPlace& place, std::int32_t tool,
                                                    const ProgramFrame& frame) {
    return robot->place_of(place, tool, frame);
  };
}

}  // namespace counterflex::cli
