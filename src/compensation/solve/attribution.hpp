#pragma once
/// What the original program does at the waypoints of the corrected one, and where deviations come from.
#include <span>

#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// What has been solved at a waypoint.
struct ForwardPlace {
  ForwardRequest original, emitted;  ///< the commands, without a stage
  Pose wanted;                       ///< X_MT
  Eigen::VectorXd rho{};             ///< actuators of the original command (m, rad), where they are known
};

/// Fills `before` at the ends of pieces and at places, and the actuators of the original command; a status
/// that is not converged goes to the waypoint.
void add_before(PlaceSolver& solver, std::span<ForwardPlace> places, std::span<Waypoint> waypoints);

/// Fills the causes at the ends of pieces and at places. It is faster where actuators are known. The shift of
/// a datum that was touched off is part of geometry alone.
void add_causes(PlaceSolver& solver, std::span<const ForwardPlace> places, std::span<Waypoint> waypoints);

}  // namespace counterflex
