#pragma once
/// Reference numbers, kept as JSON beside the tests that use them. Everything in SI once read.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/geometry/pose.hpp"

namespace counterflex::test {

/// The state of a machine at given actuators, as far as the file has it.
struct ExpectedState {
  std::optional<Vector3> dp;            ///< actual minus wanted tip (m)
  std::optional<Vector3> drot;          ///< rotation vector of R_actual R_target' (rad)
  std::vector<Vector6> chain_wrenches;  ///< on the ends of the first chains, at the reference point (N, N m)
  std::optional<Eigen::VectorXd> compliance_loads;  ///< of all compliances in order (N, N m)
  std::vector<Vector6> springs;                     ///< theta of all springs in order (m, rad)
};

/// The actuator values that move the tip of the loaded machine to its target.
struct ExpectedCompensation {
  Eigen::VectorXd rho;                         ///< m, rad
  std::optional<Vector3> correction;           ///< nominal tip at `rho` minus target (m)
  std::optional<Vector3> correction_rotation;  ///< rotation vector of R_nominal R_target' (rad)
  std::optional<Vector3> drot;                 ///< rotation that remains of the loaded machine (rad)
};

struct ReferenceCase {
  std::string id;
  std::string machine;               ///< name of the machine file, without .toml
  Pose X_MT;                         ///< target
  std::optional<Vector3> tool;       ///< replaces the machine's (m)
  Vector6 wrench = Vector6::Zero();  ///< at the tip (N, N m)
  double error_scale = 1;
  std::optional<Eigen::VectorXd> rho;  ///< inverse kinematics of the target (m, rad)
  std::optional<ExpectedState> unloaded, loaded, loaded_perfect;
  std::optional<ExpectedCompensation> compensated, compensated_perfect;
};

/// The cases of `tests/statics/data/NAME.json`. Throws if the file is incomplete.
std::vector<ReferenceCase> reference_cases(const std::string& name);

/// Path of a machine file of the reference.
std::string reference_machine_file(const std::string& machine);

}  // namespace counterflex::test
