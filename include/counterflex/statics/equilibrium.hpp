#pragma once
/// Equilibrium of the whole manipulator: where the loaded, imperfect machine is for given actuators
/// (17)-(21), and which actuators put its tip where it is wanted (22). The machine's own weight acts with
/// `Stage::gravity`, also where there is no load. EQUATIONS.md, sections 5-8 and 10.
#include <memory>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// A wrench on the machine (N, N m), axes of M, at the tool tip or at the reference point. Its directions
/// stay fixed in M.
struct Load {
  Vector6 F = Vector6::Zero();
  bool at_platform = false;
};

struct Equilibrium {
  Status status = Status::not_converged;
  Configuration configuration;
  int iterations = 0;                 ///< Newton steps, all stages together
  Vector6 weakest = Vector6::Zero();  ///< `singular`: the platform's twist of least stiffness
  bool indeterminate = false;         ///< redundant rigid closures: some wrenches are minimum-norm ones
};

/// Memory for one thread and one mechanism, which must not change. Reused between calls it saves allocations.
class StaticsWork {
 public:
  explicit StaticsWork(const Mechanism& mechanism);
  ~StaticsWork();
  StaticsWork(StaticsWork&&) noexcept;
  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// (20): the platform's pose under `load` with the actuators of `nominal`, followed from there as errors,
/// load, preloads and weights grow from nothing to `goal` in at least four steps. Statuses: converged,
/// not_converged, singular, unstable.
Equilibrium solve_forward(const Model& model, const Configuration& nominal, const Load& load,
                          const Stage& goal, StaticsWork& work);

/// Whether the load leads to `loaded` also if it grows last, on the machine with its errors, preloads and
/// weights. `loaded` is a converged result of `solve_forward`, where everything grows together. A machine
/// that snaps through in one of the two orders gives false. True if the machine without the load has no
/// stable equilibrium.
bool is_reached_by_load_alone(const Model& model, const Configuration& nominal, const Load& load,
                              const Stage& goal, const Equilibrium& loaded, StaticsWork& work);

/// `solve_forward` from a start of the caller's choice (the springs' rest values are relative to its
/// x_nominal), without the continuation: a warm start beside a solution, or a buckled one.
Equilibrium refine_forward(const Model& model, const Configuration& start, const Load& load,
                           const Stage& goal, StaticsWork& work);

/// The equilibrium of `solve_forward` whose tip X_MT is known, as `BatchSolver` gives it, from `nominal`
/// without the continuation. `not_converged` where Newton's method ends at another one.
Equilibrium equilibrium_at(const Model& model, const Configuration& nominal, const Load& load,
                           const Stage& goal, const Pose& X_MT, StaticsWork& work);

/// (22) by Newton: actuators for which the loaded machine has the controlled components of its tip on those
/// of `X_MT`; the start is `nominal` at `X_MT`, followed as in `solve_forward`.
Equilibrium solve_target(const Model& model, const Configuration& nominal, const Pose& X_MT, const Load& load,
                         const Stage& goal, StaticsWork& work);

/// The same from the solution of a neighbour, without the continuation.
Equilibrium refine_target(const Model& model, const Configuration& start, const Pose& X_MT, const Load& load,
                          const Stage& goal, StaticsWork& work);

/// Cartesian stiffness of the manipulator (7), (18) at a configuration: sum of the chains' loaded stiffnesses
/// (3), wrench per spatial twist of the reference point, SI. Not symmetric under load. Zero rows where a
/// chain has none of its own (then `available` is false).
struct ManipulatorStiffness {
  Matrix6 K = Matrix6::Zero();
  bool available = true;
};
ManipulatorStiffness stiffness(const Model& model, const Configuration& configuration, const Stage& stage,
                               StaticsWork& work);

/// Least eigenvalue of the symmetric part of the reduced Hessian of energy (with weights) minus load, pose
/// free, actuators held, each coordinate scaled by its own stiffness. Below 0 the configuration is unstable;
/// values within the rounding error are given as 0.
double stability(const Model& model, const Configuration& configuration, const Load& load, const Stage& stage,
                 StaticsWork& work);

/// Condition of the whole static system at a configuration, redundant closures and zero modes that move no
/// platform out.
double static_condition(const Model& model, const Configuration& configuration, const Load& load,
                        const Stage& stage, StaticsWork& work);

}  // namespace counterflex
