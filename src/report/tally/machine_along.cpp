#include "counterflex/report/machine_along.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/machine/program_axes.hpp"

namespace counterflex {
namespace {

std::vector<ConstantAxis> constant_axes(const Machine& machine) {
  std::vector<ConstantAxis> axes;
  for (const Actuator& axis : program_axes(machine))
    axes.push_back({fmt::format("E{}", axis.program_axis), axis.joint.kind, axis.home});
  return axes;
}

/// The machine follows a path; where that fails it starts again at home.
class Follower {
 public:
  /// The status at the target; with another than `converged` the configuration is that of an earlier one.
  Status go_to(const LoadPlace& place) {
    if (path_ && path_of(place, *path_) == Status::converged) return Status::converged;
    path_.emplace(home_of(*place.model));
    return path_of(place, *path_);
  }
  const Configuration& configuration() const { return path_->configuration(); }
  const ActuatorJacobian& jacobian() const { return path_->jacobian(); }

 private:
  static Status path_of(const LoadPlace& place, NominalToolPath& path) {
    return path.go_to(*place.model, place.target, commanded_orientation(place.at));
  }

  std::optional<NominalToolPath> path_;
};

}  // namespace

MachineAlong machine_along(const Machine& machine, const Model& model, const std::vector<LoadPlace>& places) {
  MachineAlong along{model.mechanism.travel, constant_axes(machine), {}, {}};
  const bool turns_tool =
      std::any_of(places.begin(), places.end(), [](const LoadPlace& place) { return bool(place.at.R_MT); });
  if (turns_tool) along.least_arm_margin = least_arm_margin;
  Follower follower;
  Eigen::VectorXd rho = actuator_values(model.mechanism, model.home);
  for (const LoadPlace& place : places) {
    MachinePlace& at = along.places.emplace_back();
    at.s = place.at.s;
    at.line = place.at.line;
    at.place.status = follower.go_to(place);
    if (at.place.status != Status::converged) continue;
    const Configuration& nominal = follower.configuration();
    at.place = place_of(*place.model, nominal, rho);
    rho = joint_values(place.model->mechanism.shown, at.place.shown);
    at.conditioning = 1 / follower.jacobian().condition;
    at.lines = skeleton(place.model->mechanism, nominal);
  }
  return along;
}

}  // namespace counterflex
