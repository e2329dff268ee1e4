#include "statics/theory/manipulator.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "statics/model/tolerances.hpp"

namespace counterflex {

AppliedWrench applied_wrench(const Mechanism& mechanism, const Pose& X_MP, const Load& load, double factor) {
  AppliedWrench applied{factor * load.F, Matrix6::Zero()};
  const Vector3& arm = load.at_platform ? mechanism.p_EP : mechanism.X_PT.p;
  if (load.at_platform && arm.isZero(0)) return applied;
  const Vector3 r = X_MP.R * arm, f = applied.F.head<3>();
  applied.F = wrench_at(applied.F, r);
  applied.tangent.bottomRightCorner<3, 3>() = skew(f) * skew(r);  // d(r x f) = (w x r) x f = f x (r x w)
  return applied;
}

void evaluate_all(const Model& model, const Configuration& configuration, const Stage& stage,
                  StaticsWork::Impl& work) {
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    evaluate(model.mechanism.chains[i], configuration.chains[i], configuration.X_MP, stage,
             acting_gravity(model.mechanism, stage), Hessians::yes, work.chains[i]);
}

PlatformTerms platform_terms(const Model& model, const Configuration& configuration, const Problem& problem) {
  const AppliedWrench applied =
      applied_wrench(model.mechanism, configuration.X_MP, problem.load, problem.stage.load);
  PlatformTerms terms{-applied.F, -applied.tangent};
  for (const SeriesState& chain : configuration.chains) terms.gradient += chain.F;
  return terms;
}

Residual residual_of(const Model& model, const Configuration& configuration, const Problem& problem,
                     const StaticsWork::Impl& work) {
  const Units units{model.mechanism.length};
  Residual residual;
  for (std::size_t i = 0; i < work.chains.size(); ++i)
    add_residual(model.mechanism.chains[i], configuration.chains[i], work.chains[i], units, residual);
  residual.force =
      std::max(residual.force, wrench_size(platform_terms(model, configuration, problem).gradient, units));
  residual.largest = std::max(residual.largest, wrench_size(problem.load.F, units) * problem.stage.load);
  if (!problem.X_MT) return residual;
  const Controlled tip = tip_equations(model.mechanism, configuration.X_MP, *problem.X_MT, units);
  residual.closure = std::max(residual.closure, tip.rhs.cwiseAbs().maxCoeff() * units.length);
  return residual;
}

double force_tolerance(const Mechanism& mechanism, const Pose& X_MP, double largest_wrench) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  return 1e-9 * std::max(1.0, largest_wrench) +
         16 * eps * mechanism.stiffest * (X_MP.p.norm() + mechanism.length);
}

bool is_solved(const Mechanism& mechanism, const Pose& X_MP, const Residual& residual) {
  return residual.closure <= closure_tolerance &&
         residual.force <= force_tolerance(mechanism, X_MP, residual.largest);
}

WholeSystem whole_system(const Model& model, const Configuration& configuration, const Problem& problem,
                         const StaticsWork::Impl& work) {
  const Units units{model.mechanism.length};
  const Residual residual = residual_of(model, configuration, {problem.load, problem.stage, nullptr}, work);
  WholeSystem system =
      assemble_whole(model.mechanism, work.chains, platform_terms(model, configuration, problem), units);
  const double by_unit = units.length / units.energy();
  system.wrench = std::max(1.0, residual.largest) * by_unit;
  system.force_error =
      std::min(residual.force, force_tolerance(model.mechanism, configuration.X_MP, residual.largest)) *
      by_unit;
  return system;
}

}  // namespace counterflex
