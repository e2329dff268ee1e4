#pragma once
/// Whether the nominal machine goes along a path on one branch, in one configuration, within its travel, and
/// in which directions its actuators move.
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

/// Follows the path of a window from place to place, and sets its `way`. Fails at the first place that the
/// nominal machine does not reach, or to which it does not come on its branch, and where an arm that is given
/// orientations is within 1 degree of another configuration.
std::optional<Failure> follow_branch(const Job& job, ActuatorWay& way);

/// The first rotary axis of an arm that does not keep what a target states of its turn, by `room` (rad), if
/// it goes from `from` to `to`: values that the control shows, counted on from `from` to `to`.
std::optional<std::size_t> axis_beyond_stated_turn(StatedTurns turns, const Mechanism& mechanism,
                                                   const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                                   double room);

/// The failure of the first commanded target at which a rotary axis of the nominal machine leaves the turn
/// that the target states.
std::optional<Failure> stated_turns_failure(const Job& job, const std::vector<Piece>& pieces);

/// Counts full turns on from `last`, where the window before ended, and sets `last` to the end of this one.
/// The failure of an actuator that leaves its travel.
std::optional<Failure> turns_failure(const Job& job, const ActuatorWay& way, Eigen::VectorXd& last);

/// Follows the path of `job` from `end`, and sets `end` to where it ends. To the first place that the nominal
/// machine does not reach. Nothing for a machine without reversals.
PathDirections directions_along(const Job& job, DirectionsEnd& end);

/// Sets the directions that are not known in `first` to those of the first motions in `path`.
void add_first_motions(const PathDirections& path, Directions& first);

}  // namespace counterflex
