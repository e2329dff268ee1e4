#pragma once
/// Poses of the tip, solved many at once in the way in which `predict` and `compensate` solve those of a
/// path. The part's fixture acts.
#include <span>
#include <vector>

#include "counterflex/statics/batch_solver.hpp"

namespace counterflex {

/// A wanted pose of the tip, and the wrench at the tip there (N, N m; axes of M). Machines that control no
/// orientation ignore that of the pose.
struct PoseRequest {
  Pose X_MT;
  Vector6 F = Vector6::Zero();
};

/// Where the tip is if the wanted pose is commanded. What follows the status is meaningful only if
/// `converged`.
struct SolvedCommand {
  Status status = Status::not_converged;
  Pose wanted;          ///< X_MT: controlled components as requested, others by nominal kinematics
  Pose X_MT;            ///< of the real tip
  Eigen::VectorXd rho;  ///< actuators of the command (m, rad; rotary ones but for full turns)
};

/// What has to be commanded for the tip to have the wanted pose in its controlled components. What follows
/// the status is meaningful only if `converged`.
struct SolvedTarget {
  Status status = Status::not_converged;
  Pose X_MT;            ///< of the nominal tip
  Eigen::VectorXd rho;  ///< actuators there (m, rad; rotary ones but for full turns)
};

/// An answer for each request, in order. Each depends on the model and its own request alone. `starts` may be
/// shared by threads.
std::vector<SolvedCommand> solve_commands(const Model& model, const StartTables& starts,
                                          std::span<const PoseRequest> requests, int threads);
std::vector<SolvedTarget> solve_targets(const Model& model, const StartTables& starts,
                                        std::span<const PoseRequest> requests, int threads);

}  // namespace counterflex
