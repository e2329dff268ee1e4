#pragma once
/// Commanded poses of the tip, solved many at once. The kernel solves what it can. Every other pose is solved
/// by itself, from home.
#include <memory>
#include <span>

#include "counterflex/statics/batch_solver.hpp"

namespace counterflex {

/// A place that is commanded, and the wrench at the tip there (N, N m; axes of M).
struct CommandedPose {
  TurnedPlace at;
  Vector6 F = Vector6::Zero();
};

/// The tip under the load, errors and weights. The pose is meaningful only if `converged`.
struct LoadedTip {
  Status status = Status::not_converged;
  Pose X_MT;
};

/// `compliance_at_tip` there. It is meaningful only if `converged`; `singular` where some wrench moves the
/// platform without resistance.
struct LoadedCompliance {
  Status status = Status::not_converged;
  Matrix6 C = Matrix6::Zero();
};

/// Solver for one thread. Each answer depends on the model and its own pose alone. Poses outside travel are
/// not solved. The part's fixture does not act.
class PoseSolver {
 public:
  /// `table` is of `model`, with loads at the tip. Both outlive the solver.
  PoseSolver(const Model& model, const StartTable& table);
  ~PoseSolver();

  /// The answers are as long as `poses`. Does not throw.
  void tips(std::span<const CommandedPose> poses, std::span<LoadedTip> answers);
  void compliances(std::span<const CommandedPose> poses, std::span<LoadedCompliance> answers);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace counterflex
