#pragma once
/// All chains and the platform at one state: what acts on the platform, and the whole system.
#include "counterflex/statics/equilibrium.hpp"
#include "statics/kernel/single.hpp"
#include "statics/model/problem.hpp"
#include "statics/theory/whole_system.hpp"

namespace counterflex {

struct StaticsWork::Impl {
  std::vector<SeriesWork> chains;
  kernel::Single kernel;
};

/// The applied wrench at the reference point (its moment gains r x f) and its tangent there.
struct AppliedWrench {
  Vector6 F;
  Matrix6 tangent;
};
AppliedWrench applied_wrench(const Mechanism& mechanism, const Pose& X_MP, const Load& load, double factor);

/// Fills all chains' works; Hessians as in (3)-(5).
void evaluate_all(const Model& model, const Configuration& configuration, const Stage& stage,
                  StaticsWork::Impl& work);

/// Sum of chain wrenches minus the applied one, and minus its tangent.
PlatformTerms platform_terms(const Model& model, const Configuration& configuration, const Problem& problem);

/// The largest residuals of chains, platform and tip at evaluated works.
Residual residual_of(const Model& model, const Configuration& configuration, const Problem& problem,
                     const StaticsWork::Impl& work);

/// Bound on the force residual: 1e-9 max(1 N, W) + 16 eps k_max (p + l).
double force_tolerance(const Mechanism& mechanism, const Pose& X_MP, double largest_wrench);

/// Whether residuals are within the tolerances of closures and forces.
bool is_solved(const Mechanism& mechanism, const Pose& X_MP, const Residual& residual);

/// The whole system at evaluated works.
WholeSystem whole_system(const Model& model, const Configuration& configuration, const Problem& problem,
                         const StaticsWork::Impl& work);

}  // namespace counterflex
