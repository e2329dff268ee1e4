#pragma once
/// Solves waypoints of a job. Each answer depends on its own request alone.
#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/files/parallel.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

// Poses of the tip are relative to the part: where its fixture deflects, M is the frame of the unloaded part.

/// A place where the tip is wanted (M, m), the wrench there (N, N m; axes of M), and the machine. With an
/// orientation the tip is wanted in it, too; without one home's is commanded where the machine controls it.
struct TargetRequest {
  const Model* model = nullptr;
  Vector3 p_MT = Vector3::Zero();
  Vector6 F = Vector6::Zero();
  std::optional<Matrix3> R_MT{};
  Directions directions{};

  bool operator==(const TargetRequest&) const = default;
};

/// A command that puts the tip where it is wanted.
struct TargetAnswer {
  Status status = Status::not_converged;
  Vector3 target = Vector3::Zero();  ///< position to write, in M (m)
  int iterations = 0;
  /// By which the commanded orientation is turned against the wanted one (rad, axes of M).
  Vector3 turn = Vector3::Zero();
};

/// A commanded position (M, m), the wrench there, what else acts, and the machine. Without an orientation
/// home's is commanded.
struct ForwardRequest {
  const Model* model = nullptr;
  Vector3 target = Vector3::Zero();
  Vector6 F = Vector6::Zero();
  Stage stage{};
  bool within_travel = false;  ///< a command outside the travel of an actuator is `outside_travel`
  std::optional<Matrix3> R{};
  Directions directions{};
  const Eigen::VectorXd* rho = nullptr;  ///< the actuators of the command (m, rad), if they are known
};

struct LoadPlace;

/// What is commanded at a place, and the wrench on the tool there.
ForwardRequest request_at(const LoadPlace& place);

/// Where the tip is for a command.
struct ForwardAnswer {
  Status status = Status::not_converged;
  Pose X_MT;
  int iterations = 0;
  Eigen::VectorXd rho;  ///< actuators of the command (m, rad), where they were not given
};

/// The wanted pose of the tip at a position. Its controlled orientation is the program's or else home's,
/// uncontrolled components are those of nominal kinematics.
struct WantedPose {
  Status status = Status::not_converged;
  Pose X_MT;
};

/// Whether requests behind the first one that fails need an answer: without one they are `not_converged`.
enum class StopAt { end, first_failure };

/// Solver for one thread. The kernel solves what it can in batches. The other requests are solved one by one,
/// from the nominal configuration of the place: the cell's, or home, followed to the place.
class PlaceSolver {
 public:
  explicit PlaceSolver(const Job& job)
      : PlaceSolver(job.starts, job.forces.at_platform(), job.options.method) {}

  /// Without start tables every request is solved by itself.
  PlaceSolver(const StartTables* starts, bool at_platform, Method method = Method::direct);
  ~PlaceSolver();

  /// `answers` is as long as `requests`, and holds defaults. Numerical trouble is a status in the answer.
  void wanted(std::span<const TipPosition> requests, std::span<WantedPose> answers,
              StopAt stop = StopAt::first_failure);
  void targets(std::span<const TargetRequest> requests, std::span<TargetAnswer> answers,
               StopAt stop = StopAt::first_failure);
  void forwards(std::span<const ForwardRequest> requests, std::span<ForwardAnswer> answers,
                StopAt stop = StopAt::first_failure);

  /// The same of one.
  WantedPose wanted(const TipPosition& at);
  ForwardAnswer forward(const ForwardRequest& request);

  /// Pose of the loaded part's frame under the wrench on the tool at a place of the cut; identity where no
  /// fixture deflects.
  Pose part(const Model& model, const Vector6& F, const Pose& X_MT);

  /// The equilibrium behind the answer to a request under the whole load, which has `R` or home's
  /// orientation: not converged where it is not found.
  Equilibrium equilibrium(const ForwardRequest& request, const ForwardAnswer& answer);
  Equilibrium equilibrium(const ForwardRequest& request);

  /// The nominal configuration with the tip at a position, followed to there: a singular pose on the way is
  /// found. Its controlled orientation is the program's or else home's.
  NominalResult nominal(const TipPosition& at);

  /// The same of many positions, in batches; without a judgement of ways, and rotary actuators but for full
  /// turns.
  std::vector<NominalResult> nominals(std::span<const TipPosition> positions);

  /// Whether the nominal machine goes from one position straight to another, of the same model, on one
  /// branch: converged, or why not.
  Status join(const TipPosition& from, const TipPosition& to);

  /// As `BatchSolver::bend_along`; infinite without start tables.
  LineBend bend_along(const Model& model, const BatchLine& line);

 private:
  struct OfModel;
  void machine_targets(std::span<const TargetRequest> requests, std::span<TargetAnswer> answers, StopAt stop);
  void machine_forwards(std::span<const ForwardRequest> requests, std::span<ForwardAnswer> answers,
                        StopAt stop);
  OfModel& of(const Model& model);
  WantedPose wanted_alone(OfModel& m, const TipPosition& at);
  TargetAnswer target_alone(OfModel& m, const TargetRequest& request);
  ForwardAnswer forward_alone(OfModel& m, const ForwardRequest& request);
  TargetAnswer by_outer_iteration(OfModel& m, const TargetRequest& request);
  TargetAnswer by_linear_theory(OfModel& m, const TargetRequest& request);

  const StartTables* starts_;
  const bool at_platform_;
  const Method method_;
  std::map<const Model*, std::unique_ptr<OfModel>> models_;
  std::vector<TargetRequest> moved_;  ///< to where the loaded part is
  std::vector<BatchRequest> requests_;
  std::vector<BatchAnswer> answers_;
  std::vector<TurnedPlace> places_;
  std::vector<NominalAnswer> nominals_;
};

/// Segments or places that one thread works on: full batches, and several slices in a window. Of no effect on
/// results.
inline constexpr std::size_t slice_size = 256;

/// Calls `work(begin, count)` for every slice of `items`, of at most `size`, on several threads.
template <class Work>
void for_each_slice(std::size_t items, int threads, const Work& work, std::size_t size = slice_size) {
  for_each_index((items + size - 1) / size, threads, [&](std::size_t slice) {
    const std::size_t begin = slice * size;
    work(begin, std::min(items - begin, size));
  });
}

}  // namespace counterflex
