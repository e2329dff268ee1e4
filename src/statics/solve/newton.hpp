#pragma once
/// Newton's method on the equilibrium of chains, platform and, where a target is given, actuators.
#include <optional>

#include "counterflex/statics/equilibrium.hpp"
#include "statics/theory/whole_system.hpp"
#include "statics/solve/tolerances.hpp"

namespace counterflex {

struct StaticsWork::Impl {
  std::vector<SeriesWork> chains;
  Eigen::VectorXd no_actuator_step;  ///< zeros, one an actuator
};

/// What one Newton solve should satisfy.
struct Problem {
  Load load;
  Stage stage;
  const Pose* X_MT = nullptr;  ///< none: actuators are held
};

/// The applied wrench at the reference point (its moment gains r x f) and its tangent there.
struct AppliedWrench {
  Vector6 F;
  Matrix6 tangent;
};
AppliedWrench applied_wrench(const Mechanism& mechanism, const Pose& X_MP, const Load& load, double factor);

/// Fills all chains' works; Hessians as in (3)-(5).
void evaluate_all(const Model& model, const Configuration& configuration, const Stage& stage, StaticsWork::Impl& work);

/// Sum of chain wrenches minus the applied one, and minus its tangent.
PlatformTerms platform_terms(const Model& model, const Configuration& configuration, const Problem& problem);

/// The whole system at evaluated works.
WholeSystem whole_system(const Model& model, const Configuration& configuration, const Problem& problem,
                         const StaticsWork::Impl& work);

/// Bound on the force residual: 1e-9 max(1 N, W) + 16 eps k_max (p + l).
double force_tolerance(const Mechanism& mechanism, const Pose& X_MP, double largest_wrench);

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  bool jumped = false;  ///< platform or actuators ended elsewhere than the tangent at the start leads: by more than half
};
/// Whether platform or actuators ended elsewhere than foreseen, by more than half of the way from `from`.
bool ends_elsewhere(const Mechanism& mechanism, const Configuration& from, const Configuration& foreseen,
                    const Configuration& found);

/// On success the works are evaluated at the solution.
NewtonResult newton(const Model& model, const Problem& problem, StaticsWork::Impl& work, Configuration& configuration);

/// Stability at evaluated works: first by factorisations that can only say yes, then by eigenvalues.
bool is_stable(const Model& model, const Configuration& configuration, const Problem& problem,
               const StaticsWork::Impl& work);

/// Whether factorisations prove the reduced Hessian positive definite; no says nothing.
bool surely_stable(const Mechanism& mechanism, const std::vector<SeriesWork>& works, const Matrix6& load_tangent,
                   const Units& units);

/// Whether the condensed matrices bound the condition of the whole system below `limit`; no says nothing.
bool surely_well_conditioned(const Mechanism& mechanism, std::vector<SeriesWork>& works, const Matrix6& load_tangent,
                             const Units& units, double limit);

}  // namespace counterflex
