#pragma once
/// Solves many waypoints of one model at once.
#include <span>

#include "path_solver.hpp"

namespace counterflex {

/// A place where the tip is wanted, M (m), and the load there.
struct TargetRequest {
  Vector3 p_MT = Vector3::Zero();
  Load load;
};

/// A commanded position, M (m), and what acts there.
struct ActualRequest {
  Vector3 target = Vector3::Zero();
  Load load;
  Stage stage{};
  Start start{};
};

/// The wanted pose of the tip at a position. Its controlled orientation is home's, uncontrolled components
/// are those of nominal kinematics; it means something only where `status` is converged.
struct WantedPose {
  Status status = Status::not_converged;
  Pose X_MT;
};

/// Answers requests in batches; neighbours in a batch should be neighbours on the path. What is answered
/// depends on all requests since the start, in their order, and on nothing else. `out` is as long as the
/// requests. Numerical trouble is a status in the answer.
class WaypointSolver {
 public:
  /// `start`: a nominal configuration of `model` on the branch, near the first waypoint.
  WaypointSolver(const Job& job, const Model& model, Configuration start);

  void wanted(std::span<const Vector3> p_MT, std::span<WantedPose> out);
  void targets(std::span<const TargetRequest> requests, std::span<TargetSolution> out);
  void actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out);

  const Model& model() const { return one_by_one_.model(); }

 private:
  PathSolver one_by_one_;
};

}  // namespace counterflex
