#pragma once
/// Whether the nominal machine goes along a path on one branch, in one configuration, within its travel.
#include <vector>

#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// The actuators along the path of a window that turns the tool (m, rad), rotary ones counted on over full
/// turns: those of a single place are only known but for full turns.
struct ActuatorWay {
  struct Extreme {
    double value = 0;
    int line = 0;
  };
  Eigen::VectorXd first{}, last{};  ///< empty where the window has no such path
  std::vector<Extreme> least{}, most{};
};

struct FollowedPath {
  std::optional<Failure> failure{};
  ActuatorWay way{};
};

/// Follows the path of a window from place to place. Fails at the first place that the nominal machine does
/// not reach, or to which it does not come on its branch, and where an arm that is given orientations is
/// within 1 degree of another configuration.
FollowedPath follow_branch(const Job& job);

/// Whether the rotary axes of an arm keep what a target states of their turns if they go from `from` to `to`,
/// by `room` (rad): values that the control shows, counted on from `from` to `to`.
bool keeps_stated_turns(StatedTurns turns, const Mechanism& mechanism, const Eigen::VectorXd& from,
                        const Eigen::VectorXd& to, double room);

/// The failure of the first commanded target at which a rotary axis of the nominal machine leaves the turn
/// that the target states.
std::optional<Failure> stated_turns_failure(const Job& job, const std::vector<Piece>& pieces);

/// Counts full turns on from `last`, where the window before ended, and sets `last` to the end of this one.
/// The failure of an actuator that leaves its travel.
std::optional<Failure> turns_failure(const Job& job, const ActuatorWay& way, Eigen::VectorXd& last);

}  // namespace counterflex
