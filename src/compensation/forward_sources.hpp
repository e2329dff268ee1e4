#pragma once
/// What the original program does at the waypoints of the corrected one, and where deviations come from.
#include <span>

#include "counterflex/compensation/waypoint.hpp"
#include "waypoint_solver.hpp"

namespace counterflex {

/// What has been solved at a waypoint.
struct ForwardPlace {
  Vector3 original = Vector3::Zero(), emitted = Vector3::Zero();  ///< targets, M (m)
  Load load;
  Pose wanted, actual;                ///< X_MT
};

/// The pieces of a batch of waypoints; `judged` is 1 for axes of M in which the tip is judged, else 0.
struct ForwardBatch {
  std::span<const ForwardPlace> places;
  std::span<Waypoint> waypoints;
  Vector3 judged = Vector3::Ones();
};

/// Fills `before` at the ends of pieces; a status that is not converged goes to the waypoint.
void add_before(WaypointSolver& solver, const ForwardBatch& batch);

/// Fills geometry, load, gravity, superposition and air at the ends of pieces, in the same way. The shift of a
/// datum that was touched off is part of geometry alone.
void add_sources(WaypointSolver& solver, const ForwardBatch& batch);

/// Fills `higher` and `lower`. A force under which the machine gives way is no failure of a run: it does not
/// act.
void add_other_forces(WaypointSolver& solver, const ForwardBatch& batch);

}  // namespace counterflex
