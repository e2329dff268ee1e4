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

/// Answers requests by the kernel where the job has start tables, and where the kernel solves them: those answers depend on
/// their requests alone. The others are solved one by one along the path. `out` is as long as the requests. Numerical
/// trouble is a status in the answer.
class WaypointSolver {
 public:
  /// `start`: a nominal configuration of `model` on the branch, near the first waypoint.
  WaypointSolver(const Job& job, const Model& model, Configuration start);

  void wanted(std::span<const Vector3> p_MT, std::span<WantedPose> out);
  void targets(std::span<const TargetRequest> requests, std::span<TargetSolution> out);

  void actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out);

  /// What is asked next does not follow on the path: it begins at the start again, not at what was solved
  /// last.
  void begin_anew();

  const Model& model() const { return model_; }

 private:
  PathSolver& one_by_one(const Vector3& p);
  void solve_in_batch(BatchQuestion question, const Stage& stage);
  void solve_actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out);

  const Job& job_;
  const Model& model_;
  Configuration start_;
  std::optional<BatchSolver> batch_;
  std::vector<BatchRequest> requests_;
  std::vector<BatchAnswer> answers_;
  std::vector<NominalAnswer> nominals_;
  std::optional<PathSolver> one_by_one_;
  bool strayed_ = false;  ///< the path has gone on since the last waypoint that was solved alone
};

}  // namespace counterflex
