#include "run/joint_kinematics.hpp"

#include <cmath>
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
  explicit Robot(const Machine& machine) : machine_(machine), axes_(program_axes(machine)) {}

  /// May be called from several threads.
  std::optional<Pose> place_of(const JointPlace& place, std::int32_t tool, const ProgramFrame& frame) {
    const std::scoped_lock lock(mutex_);
    const auto X_MW = known_frame(machine_, frame);
    if (!X_MW || !has_tool(place, tool)) return std::nullopt;
    for (const Actuator& axis : axes_)
      if (!place.external.at(static_cast<std::size_t>(axis.program_axis - 1))) return std::nullopt;
    const Model& model = model_of(place.external, tool);
    const Mechanism& mechanism = model.mechanism;
    if (mechanism.travel.size() != place.joints.size()) return std::nullopt;
    const Eigen::VectorXd shown = Eigen::Map<const Eigen::VectorXd>(place.joints.data(), 6);
    const NominalResult result = nominal_forward(model, model.home, joint_values(mechanism.shown, shown));
    if (result.status != Status::converged) return std::nullopt;
    const Pose X_MT = tip(mechanism, result.configuration);
    if (!is_on_branch_of_home(model, X_MT, actuator_values(mechanism, result.configuration)))
      return std::nullopt;
    Pose X_WT = inverse(*X_MW) * X_MT;
    X_WT.p /= mm;
    return X_WT;
  }

 private:
  /// A tool that the program defines must be [tool]. A second tool must be one of [tools].
  bool has_tool(const JointPlace& place, std::int32_t tool) const {
    constexpr double same_mm = 0.01, same_rad = 1e-4;
    if (tool != 0 && machine_.tools.contains(tool)) return true;
    if (place.other_tool) return false;
    if (!place.tcp_mm) return true;
    const Matrix3 R = machine_.X_PT.R * tool_axes(machine_.spindle_axis).transpose();
    return (place.tcp_mm->p - machine_.X_PT.p / mm).norm() < same_mm &&
           rotation_between(place.tcp_mm->R, R).norm() < same_rad;
  }

  /// A run solves its places on the branch of home. Elsewhere the errors act in another way.
  static bool is_on_branch_of_home(const Model& model, const Pose& X_MT, const Eigen::VectorXd& q) {
    constexpr double same = 1e-6;  // rad
    const NominalResult followed = follow(model, model.home, X_MT);
    if (followed.status != Status::converged) return false;
    const Eigen::VectorXd there = actuator_values(model.mechanism, followed.configuration);
    for (Eigen::Index i = 0; i < q.size(); ++i)
      if (std::abs(std::remainder(q[i] - there[i], 2 * pi)) > same) return false;
    return true;
  }

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
  std::vector<Actuator> axes_;
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
