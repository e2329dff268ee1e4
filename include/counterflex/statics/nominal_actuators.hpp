#pragma once
/// Commanded actuator values along a path.
#include "counterflex/statics/lanes.hpp"
#include "counterflex/statics/tool_models.hpp"

namespace counterflex {

/// Takes values from lanes where they know the place. Elsewhere the nominal machine is followed there, from
/// the place to which it was followed last.
class NominalActuators {
 public:
  /// Values that put the tip of `model` at `p_MT` (m, in M), in m and rad; none where it is not reached.
  /// `lanes`: of the same model, or null. Both outlive this.
  std::optional<Eigen::VectorXd> at(const Model& model, const LaneMachine* lanes, const Vector3& p_MT);

 private:
  const LaneMachine* machine_ = nullptr;
  std::optional<LaneSolver> lanes_;
  std::optional<NominalToolPath> path_;
};

}  // namespace counterflex
