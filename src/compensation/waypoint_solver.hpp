#pragma once
/// Solves many waypoints of one model at once.
#include <functional>
#include <span>

#include "known_place.hpp"

namespace counterflex {

/// A place where the tip is wanted, M (m), and the load there.
struct TargetRequest {
  Vector3 p_MT = Vector3::Zero();
  Load load;
};

/// Which of the targets is asked more of, and the command of the original program there, M (m).
struct ThroughRequest {
  std::size_t target = 0;
  Vector3 original = Vector3::Zero();
};

/// The command (M, m) that will be written where request `i` of these has this target; no number where that
/// is not known.
using ForeseenCommand = std::function<Vector3(std::size_t i, const Vector3& target)>;

/// A commanded position, M (m), and what acts there. What is known already is answered with it: it is asked
/// for with all else so that what follows on the path begins where it is, not where something was solved
/// last.
struct ActualRequest {
  Vector3 target = Vector3::Zero();
  Load load;
  Stage stage{};
  Start start{};
  const KnownTip* known = nullptr;
};

/// The wanted pose of the tip at a position. Its controlled orientation is home's, uncontrolled components
/// are those of nominal kinematics; it means something only where `status` is converged.
struct WantedPose {
  Status status = Status::not_converged;
  Pose X_MT;
};

/// Whether targets are solved in lanes where these can: only then is anything known besides them.
bool has_lanes_for_targets(const Job& job);

/// Answers requests in batches; neighbours in a batch should be neighbours on the path. Side by side in lanes
/// where the job has them and they know the place, one by one else. What is answered depends on all requests
/// since the start, in their order, and on nothing else. `out` is as long as the requests. Numerical trouble
/// is a status in the answer.
class WaypointSolver {
 public:
  /// `start`: a nominal configuration of `model` on the branch, near the first waypoint.
  WaypointSolver(const Job& job, const Model& model, Configuration start);

  void wanted(std::span<const Vector3> p_MT, std::span<WantedPose> out);
  void targets(std::span<const TargetRequest> requests, std::span<TargetSolution> out);

  /// The same, and at some of them, in their order, where the tip stands for the original's command and for
  /// the foreseen one: each solved from the one before, so that it costs less than three questions. `known`
  /// is as long as `through`; what lanes do not solve is not known. Errors act.
  void targets(std::span<const TargetRequest> requests, std::span<const ThroughRequest> through,
               const ForeseenCommand& foreseen, std::span<TargetSolution> out, std::span<KnownPlace> known);

  void actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out);

  /// What is asked next does not follow on the path: it begins at the start again, not at what was solved
  /// last.
  void begin_anew();

  const Model& model() const { return model_; }

 private:
  PathSolver& one_by_one(const Vector3& p);
  void solve_in_lanes(LaneQuestion question, const Stage& stage);
  void targets_in_lanes(std::span<const TargetRequest> requests, std::span<const ThroughRequest> through,
                        const ForeseenCommand& foreseen, std::span<KnownPlace> known);
  void through_in_lanes(std::span<const TargetRequest> requests, std::span<const ThroughRequest> through,
                        const ForeseenCommand& foreseen, std::span<KnownPlace> known);
  void actuals_in_lanes(std::span<const ActualRequest> requests, std::span<ActualSolution> out);

  const Job& job_;
  const Model& model_;
  Configuration start_;
  std::optional<LaneSolver> lanes_;
  std::vector<LaneRequest> requests_;
  std::vector<LaneAnswer> answers_;
  std::vector<LaneRequest> through_requests_;
  std::vector<Vector3> originals_;
  std::vector<LaneThrough> through_answers_;
  std::optional<PathSolver> one_by_one_;
  bool strayed_ = false;  ///< the path has gone on since the last waypoint that was solved alone
};

}  // namespace counterflex
