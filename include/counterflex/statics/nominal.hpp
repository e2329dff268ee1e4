#pragma once
/// Nominal kinematics: the rigid, perfect machine of which the controller knows. Springs, compliances and errors are
/// identities, passive joints are free. EQUATIONS.md, section 1.
#include <memory>

#include "counterflex/statics/configuration.hpp"
#include "counterflex/statics/status.hpp"

namespace counterflex {

/// A mechanism with its home configuration, on whose branch all nominal configurations lie.
struct Model {
  Mechanism mechanism;
  Configuration home;
  Status home_status = Status::not_converged;  ///< unreachable: home misses its closures by `home_gap`
  double home_gap = 0;                         ///< m and rad
  Status gravity_status = Status::converged;   ///< else: why no offsets hold the tip at home under the machine's weight
};

/// Compiles `machine`, finds its home configuration, and fills what is relative to it: rest values of passive springs that
/// are relaxed at home, the machine's length l, and, where the controller's zero was set under the machine's own weight at
/// home, the actuators' offsets: those with which the perfect, preloaded machine without a load has the controlled
/// components of its tip at home's pose. They act where gravity does; configurations keep the commanded values. Source: MODEL section 2, "Nominal kinematics".
Model prepare(const Machine& machine);

/// Fills what is relative to home in a compiled model whose home configuration is known.
void settle_at_home(Model& model);

struct NominalResult {
  Status status = Status::unreachable;
  Configuration configuration;  ///< x_nominal equals x throughout
};

/// Inverse kinematics: the nominal configuration whose tip has the controlled components of `X_MT` (all six where the machine
/// controls none), on the branch of `from`: the straight segment from there is followed, halved on failure and where an
/// actuator step differs from its prediction by more than half. `unreachable` where closures cannot be met, `singular` at
/// a branch jump or where the matrix from actuators to controlled components has a condition above 1e6.
NominalResult follow(const Model& model, const Configuration& from, const Pose& X_MT);

/// The same from target to target; it keeps what it learned at the last one. Where a target is not reached the
/// configuration stays.
class NominalPath {
 public:
  NominalPath(const Model& model, Configuration start);
  ~NominalPath();
  NominalPath(NominalPath&&) noexcept;
  NominalPath& operator=(NominalPath&&) noexcept;
  Status go_to(const Pose& X_MT);
  const Configuration& configuration() const { return configuration_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  Configuration configuration_;
};

/// Forward kinematics: the nominal configuration of actuator values `rho`, on the branch of `from`.
NominalResult nominal_forward(const Model& model, const Configuration& from, const Eigen::VectorXd& rho);

/// Pose of the tip of a configuration.
Pose tip(const Mechanism& mechanism, const Configuration& configuration);

/// Whether every actuator is in its range.
bool within_travel(const Mechanism& mechanism, const Eigen::VectorXd& rho);

/// The matrix from actuator steps to steps of the controlled components (SI), at a nominal configuration, and its condition
/// (lengths in units of l; infinite where a zero mode of the closures moves the platform).
struct ActuatorJacobian {
  Eigen::MatrixXd J;
  double condition = 0;
};
ActuatorJacobian actuator_jacobian(const Model& model, const Configuration& nominal);

/// Deviation of a pose from a wanted one: position (m), rotation vector of R_actual R_target' (rad), axes of M.
Vector6 deviation(const Pose& actual, const Pose& wanted);

}  // namespace counterflex
