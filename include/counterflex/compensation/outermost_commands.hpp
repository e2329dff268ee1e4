#pragma once
/// Commands between waypoints at which actuators may go farther than at the waypoints.
#include <optional>
#include <vector>

#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// The outermost places of an arc between fraction `u_before` of the move and the waypoint, and the bottom
/// and the retract plane of a cycle that is called there. They are shifted as the waypoint is. Depths that
/// are not known, and arcs along which the program turns the tool, give none.
std::vector<TipPosition> outermost_commands(const Job& job, const Waypoint& w, double u_before);

/// The actuators of the nominal machine there (m, rad); empty if it has none.
std::optional<Eigen::VectorXd> actuators_at(const TipPosition& command);

/// The fraction of the move at which the waypoint before `w` is; 0 if that is on another move.
inline double fraction_before(const Waypoint* before, const Waypoint& w) {
  return before != nullptr && before->move == w.move ? before->fraction : 0;
}

}  // namespace counterflex
