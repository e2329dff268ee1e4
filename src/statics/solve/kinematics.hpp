#pragma once
/// Closures of the nominal machine, linearised and solved: Gauss-Newton with steps of minimum norm. EQUATIONS.md, section 1.

#include "statics/theory/whole_system.hpp"
#include "statics/model/tolerances.hpp"

namespace counterflex {

/// What moves in a kinematic solve besides passive joints and groups.
struct Moving {
  bool actuators, platform;
};

/// The matrix from steps of the controlled components to actuator steps (SI), and the condition of its inverse (lengths in
/// units of l; infinite where the controlled components or the actuators are not determined).
struct InverseJacobian {
  Eigen::MatrixXd matrix;
  double condition = 0;
};

/// The kinematic equations of one mechanism, with memory for their last linearisation.
class Kinematics {
 public:
  Kinematics(const Mechanism& mechanism, Moving moving);

  /// Moves `configuration` until its closures close and, where `X_MT` is given, its tip is there; begins with the last
  /// linearisation while that contracts. Returns the final norm of what is left (m and rad).
  double solve(const Pose* X_MT, Configuration& configuration);

  void linearise(const Configuration& configuration, const Pose* X_MT);
  bool is_linearised() const { return is_linearised_; }

  /// At the last linearisation, which must have had a target.
  InverseJacobian inverse_jacobian() const;

  /// Matrix from actuator steps to the controlled components by the closures alone, at the last linearisation; infinite
  /// condition where a zero mode moves the platform while actuators are held.
  static WholeSystem closures(const Mechanism& mechanism, std::vector<SeriesWork>& works,
                              const Configuration& configuration, const Units& units);

 private:
  Eigen::VectorXd errors(const Pose* X_MT, const Configuration& configuration);
  double step(const Eigen::VectorXd& x, Configuration& configuration) const;
  bool has_free_motion() const;

  const Mechanism& mechanism_;
  Moving moving_;
  std::vector<SeriesWork> works_;
  bool is_linearised_ = false;
  std::vector<int> columns_;           ///< of the whole system, those that move
  std::vector<int> actuator_columns_;  ///< by actuator: index into columns_
  Eigen::Index variables_ = 0, closures_ = 0;
  Eigen::MatrixXd J_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition_;
};

inline constexpr double rank_threshold = 1e-10;

/// Columns of a whole system that move in a kinematic solve.
std::vector<int> moving_columns(const WholeSystem& system, Moving moving);

}  // namespace counterflex
