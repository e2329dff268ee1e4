#pragma once
/// The state of a mechanism: every coordinate, every closure's wrench, and the platform's pose.
#include <Eigen/Core>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

struct SeriesState;

struct GroupState {
  Pose X;  ///< of the group's end in its start frame
  std::vector<SeriesState> branches;
};

struct SeriesState {
  Eigen::VectorXd x;        ///< by column (m, rad); a group's six entries are unused
  Eigen::VectorXd x_nominal;  ///< the same in the nominal configuration from which this one was continued
  Vector6 F = Vector6::Zero();  ///< wrench exerted on the end (N, N m), at the end's origin, axes of the start frame
  std::vector<GroupState> groups;
};

struct Configuration {
  Pose X_MP;
  std::vector<SeriesState> chains;
};

/// A configuration with every coordinate zero.
Configuration zero_configuration(const Mechanism& mechanism);

/// Values of all actuators (m, rad).
Eigen::VectorXd actuator_values(const Mechanism& mechanism, const Configuration& configuration);
void set_actuator_values(const Mechanism& mechanism, const Eigen::VectorXd& rho, Configuration& configuration);

/// How much of what is not nominal acts. The continuation to a loaded, imperfect machine runs from 0 to 1 in all of them.
struct Stage {
  double errors = 1;   ///< assembly errors: s p, Exp(s Log R)
  double load = 1;     ///< the applied wrench
  double preload = 1;  ///< passive springs as k (q - q_nom) + s k (q_nom - q_rest), springs as K (theta - s theta_0)
  double gravity = 1;  ///< the weights of all masses, and what the controller's zero holds against them

  bool operator==(const Stage&) const = default;
};
inline constexpr Stage nominal_stage{0, 0, 0, 0};

inline bool everything_acts(const Stage& stage) {
  return stage == Stage{};
}

}  // namespace counterflex
