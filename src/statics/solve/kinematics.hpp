#pragma once
/// Closures of the nominal machine, linearised and solved: Gauss-Newton with steps of minimum norm.
/// EQUATIONS.md, section 1.
#include "statics/model/tolerances.hpp"
#include "statics/theory/whole_system.hpp"

namespace counterflex {

/// What moves in a kinematic solve besides passive joints and groups.
struct Moving {
  bool actuators, platform;
};

/// The kinematic equations of one mechanism, with memory for their last linearisation.
class Kinematics {
 public:
  Kinematics(const Mechanism& mechanism, Moving moving);

  /// Moves `configuration` until its closures close and, where `X_MT` is given, its tip is there; begins with
  /// the last linearisation while that contracts. Returns the final norm of what is left (m and rad).
  double solve(const Pose* X_MT, Configuration& configuration);

  /// The closures of the nominal machine.
  Closures closures(const Configuration& configuration, const Units& units);

  /// Columns of the closures that move.
  std::vector<int> columns(const Closures& closures) const;

 private:
  struct Equations {
    Closures closures;
    std::optional<Controlled> tip;
    Eigen::VectorXd errors() const;
  };
  Equations equations(const Pose* X_MT, const Configuration& configuration);
  void linearise(const Equations& equations);
  double step(const Eigen::VectorXd& x, const Closures& closures, Configuration& configuration) const;

  const Mechanism& mechanism_;
  Moving moving_;
  std::vector<SeriesWork> works_;
  bool is_linearised_ = false;
  Decomposition decomposition_;
};

}  // namespace counterflex
