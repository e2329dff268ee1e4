#pragma once
/// Solves waypoints one after another along a path, each from its neighbour.
#include <optional>

#include "counterflex/compensation/options.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// A command that puts the tip where it is wanted.
struct TargetSolution {
  Status status = Status::not_converged;
  Vector3 target = Vector3::Zero();  ///< position to write, in M (m)
  int iterations = 0;
};

/// Where the tip stands for a command.
struct ActualSolution {
  Status status = Status::not_converged;
  Pose X_MT;
  int iterations = 0;
  Eigen::VectorXd rho;  ///< actuators of the command (m, rad)
};

/// Where a forward solve begins: at the neighbour's solution, or at the nominal configuration, from where
/// stability is watched all the way.
enum class Start { neighbour, nominal };

class PathSolver {
 public:
  /// `start`: a nominal configuration of `model` on the branch, near the first waypoint.
  PathSolver(const Job& job, const Model& model, Configuration start);

  /// Goes on from another nominal configuration on the branch.
  void stand_at(const Configuration& nominal);

  /// The wanted pose of the tip at a position: its controlled orientation is home's, uncontrolled components
  /// are those of nominal kinematics. Sets `status` where there is none.
  Pose wanted(const Vector3& p_MT, Status& status);

  TargetSolution target(const Vector3& p_MT, const Load& load);
  ActualSolution actual(const Vector3& target, const Load& load, const Stage& stage,
                        Start start = Start::neighbour);

  const Model& model() const { return model_; }
  const Configuration& nominal() const { return nominal_.configuration(); }

 private:
  Status go_to(const Vector3& p_MT);
  Vector3 tip_of(const Configuration& configuration) const;
  Status travel_status() const;  ///< of the nominal configuration that was gone to last
  Equilibrium forward(const Load& load, const Stage& stage, Start start);
  TargetSolution by_outer_iteration(const Vector3& p_MT, const Load& load);
  TargetSolution by_linear_theory(const Vector3& p_MT, const Load& load);
  TargetSolution by_method(const Vector3& p_MT, const Load& load);

  const Job& job_;
  const Model& model_;
  Matrix3 R_MT_home_;
  StaticsWork work_;
  NominalPath nominal_;
  std::optional<Configuration> loaded_;  ///< last solution with everything acting
  bool writes_all_controlled_;           ///< the program can state every component that the machine controls
};

/// A solver along moves that need different tools.
class ToolSolver {
 public:
  explicit ToolSolver(const Job& job) : job_(job) {}

  /// Whether the last solver is one of `model`.
  bool is_of(const Model& model) const { return solver_ && &solver_->model() == &model; }

  /// The last solver if it is one of `model`; else a new one, which begins at `start`.
  PathSolver& of(const Model& model, const Configuration& start);

 private:
  const Job& job_;
  std::optional<PathSolver> solver_;
};

/// The load at a place of the path.
Load load_at(const Job& job, std::size_t segment, double fraction);

}  // namespace counterflex
