#pragma once
/// What the original program does at the waypoints of the corrected one, and where deviations come from.
#include <span>

#include "counterflex/compensation/waypoint.hpp"
#include "solver.hpp"

namespace counterflex {

/// What has been solved at a waypoint.
struct ForwardPlace {
  const Model* model = nullptr;
  Vector3 original = Vector3::Zero(), emitted = Vector3::Zero();  ///< targets, M (m)
  Vector6 F = Vector6::Zero();
  Pose wanted;  ///< X_MT
};

/// Fills `before` at the ends of pieces and at places; a status that is not converged goes to the waypoint.
void add_before(PlaceSolver& solver, std::span<const ForwardPlace> places, std::span<Waypoint> waypoints);

/// Fills all causes. Geometry, load, gravity, superposition and air are those of the ends of pieces and of
/// places, where trouble is a status of the waypoint. The shift of a datum that was touched off is part of
/// geometry alone. A force under which the machine is unstable is no failure of a run: it does not act.
void add_causes(PlaceSolver& solver, std::span<const ForwardPlace> places, std::span<Waypoint> waypoints);

}  // namespace counterflex
