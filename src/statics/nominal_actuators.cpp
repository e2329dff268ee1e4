#include "counterflex/statics/nominal_actuators.hpp"

namespace counterflex {

std::optional<Eigen::VectorXd> NominalActuators::at(const Model& model, const LaneMachine* lanes,
                                                    const Vector3& p_MT) {
  if (lanes != machine_) {
    machine_ = lanes;
    lanes_.reset();
    if (lanes != nullptr) lanes_.emplace(*lanes);
  }
  if (Eigen::VectorXd rho; lanes_ && lanes_->nominal_actuators(p_MT, rho)) return rho;
  if (!path_) path_.emplace(home_of(model));
  if (path_->go_to(model, p_MT) != Status::converged) return std::nullopt;
  return actuator_values(model.mechanism, path_->configuration());
}

}  // namespace counterflex
