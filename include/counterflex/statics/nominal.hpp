#pragma once
/// Models, and nominal kinematics: the rigid, perfect machine of which the controller knows. Springs,
/// compliances and errors are identities, passive joints are free. EQUATIONS.md, section 1.
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

enum class Status {
  converged,
  not_converged,
  unreachable,     ///< no nominal configuration on the branch of home
  singular,        ///< the whole static system, or the matrix from actuators to controlled components
  unstable,        ///< a negative eigenvalue of the reduced Hessian at the solution or on the way to it
  outside_travel,  ///< an actuator leaves its range
};

std::string_view to_string(Status status);

/// A mechanism with its home configuration, on whose branch all nominal configurations lie.
struct Model {
  Mechanism mechanism;
  Configuration home;
  Status home_status = Status::not_converged;  ///< unreachable: home misses its closures by `home_gap`
  double home_gap = 0;                         ///< m and rad
  /// Else: why no offsets hold the tip at home under the machine's weight.
  Status gravity_status = Status::converged;
};

/// Compiles `machine`, finds its home configuration, and fills what is relative to it: rest values of passive
/// springs that are relaxed at home, the machine's length l, and, where the controller's zero was set under
/// the machine's own weight at home, the actuators' offsets: those with which the perfect, preloaded machine
/// without a load has the controlled components of its tip at home's pose. They act where gravity does;
/// configurations keep the commanded values. Source: src/statics/EQUATIONS.md, sections 1 and 10.
Model prepare(const Machine& machine);

struct NominalResult {
  Status status = Status::unreachable;
  Configuration configuration;  ///< x_nominal equals x throughout
};

/// Inverse kinematics: the nominal configuration whose tip has the controlled components of `X_MT` (all six
/// where the machine controls none), on the branch of `from`: the straight segment from there is followed,
/// halved on failure and where an actuator step differs from its prediction by more than half. `unreachable`
/// where closures cannot be met, `singular` at a branch jump or where the matrix from actuators to controlled
/// components has a condition above 1e6.
NominalResult follow(const Model& model, const Configuration& from, const Pose& X_MT);

/// The matrix from actuator steps to steps of the controlled components (SI), at a nominal configuration, and
/// its condition (lengths in units of l; infinite where a zero mode of the closures moves the platform).
struct ActuatorJacobian {
  Eigen::MatrixXd J;
  double condition = 0;
};
ActuatorJacobian actuator_jacobian(const Model& model, const Configuration& nominal);

/// The same from target to target; it keeps what it learned at the last one. Where a target is not reached
/// the configuration stays.
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

/// Whether every actuator is in its range. `rho` has the values of all actuators.
bool within_travel(const Mechanism& mechanism, const Eigen::Ref<const Eigen::VectorXd>& rho);

/// Full turns (rad) to add to `rho`, the values of all actuators, so that rotary ones are nearest to `near`.
Eigen::VectorXd full_turns(const Mechanism& mechanism, const Eigen::VectorXd& rho,
                           const Eigen::VectorXd& near);

/// Deviation of a pose from a wanted one: position (m), rotation vector of R_actual R_target' (rad), axes of
/// M.
Vector6 deviation(const Pose& actual, const Pose& wanted);

/// By tool number. A tool that is not in it leaves the machine as it is with [tool].
using ToolModels = std::map<long, Model>;

/// The model of `machine` with `tool` in its spindle; its home is that of `base`, the model of `machine`: the
/// same joints, on the same branch.
Model prepare_with_tool(const Machine& machine, const Model& base, const Tool& tool);

/// Of those of `numbers` that are in [tools] and change the model. Number 0 means that no tool is known, and
/// has none.
ToolModels prepare_tools(const Machine& machine, const Model& base, const std::vector<long>& numbers);

/// The nominal path of a machine whose tools change: it starts at home, again where the model changes, and
/// its tip keeps the orientation that it has at that home.
class NominalToolPath {
 public:
  explicit NominalToolPath(const Model& model) { begin(model); }

  /// Moves the tip of `model` to `p_MT` (m, in M), in the orientation `R_MT` or else home's; `model` outlives
  /// the path. As `NominalPath::go_to`.
  Status go_to(const Model& model, const Vector3& p_MT, const std::optional<Matrix3>& R_MT = {});

  const Configuration& configuration() const { return path_->configuration(); }

  /// Orientation of the tip at the current configuration, in M.
  Matrix3 orientation() const;

 private:
  void begin(const Model& model);

  const Model* model_ = nullptr;
  Matrix3 R_home_ = Matrix3::Identity();
  std::optional<NominalPath> path_;
};

}  // namespace counterflex
