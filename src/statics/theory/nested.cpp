#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/theory.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/solve/continuation.hpp"

namespace counterflex {
namespace {

// (2) for every chain at the platform's pose; false where one has no solution of its own.
bool solve_chains(const Model& model, const Stage& stage, Configuration& configuration, StaticsWork& work,
                  NewtonResult& result) {
  for (std::size_t i = 0; i < configuration.chains.size(); ++i) {
    const auto chain =
        solve_chain(model, i, configuration.X_MP, stage, ChainMethod::paper, configuration.chains[i], work);
    result.iterations += chain.iterations;
    if (chain.status != Status::converged) return false;
  }
  return true;
}

// (20)-(21): t <- t + (sum K_C - K_load)^-1 (F - f(t)), every chain is solved again at every t.
NewtonResult equilibrium_by_chains(const Model& model, const Problem& problem, Configuration& configuration,
                                   StaticsWork& work) {
  const Units units{model.mechanism.length};
  const Configuration start = configuration;
  NewtonResult result;
  double step = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_newton_steps; ++iteration) {
    ManipulatorStiffness sum{.available = false};  // (18)
    if (solve_chains(model, problem.stage, configuration, work, result))
      sum = stiffness(model, configuration, problem.stage, work);
    if (!sum.available) {
      configuration = start;
      return newton(model, problem, work.impl(), configuration);
    }
    const PlatformTerms terms = platform_terms(model, configuration, problem);
    double largest = wrench_size(problem.load.F, units);
    for (std::size_t i = 0; i < configuration.chains.size(); ++i)
      largest =
          std::max({largest, wrench_size(configuration.chains[i].F, units), work.impl().chains[i].weight});
    const double tolerance = force_tolerance(model.mechanism, configuration.X_MP, largest);
    result.converged = step <= step_tolerance && wrench_size(terms.gradient, units) <= tolerance;
    if (result.converged) break;
    const Vector6 dt = (sum.K + terms.A).partialPivLu().solve(-terms.gradient);
    if (!dt.allFinite()) return result;
    step = twist_size(dt, units);
    configuration.X_MP = moved(configuration.X_MP, dt);
  }
  return result;
}

// The loaded configuration with the actuators of a new nominal one.
Configuration with_actuators_of(const Model& model, const Configuration& nominal, Configuration loaded) {
  set_actuator_values(model.mechanism, actuator_values(model.mechanism, nominal), loaded);
  return loaded;
}

}  // namespace

Equilibrium solve_target_nested(const Model& model, const Configuration& nominal, const Pose& X_MT,
                                const Load& load, const Stage& goal, StaticsWork& work) {
  const Units units{model.mechanism.length};
  const Problem problem{load, goal, nullptr};
  const EquilibriumSolver by_chains = [&](const Model&, const Problem& p, StaticsWork::Impl&,
                                          Configuration& c) {
    return equilibrium_by_chains(model, p, c, work);
  };
  Equilibrium result = continue_from(model, nominal, nominal_stage, problem, by_chains, work.impl());
  Configuration commanded = nominal;
  Pose X_t0F = tip(model.mechanism, nominal);
  double error = std::numeric_limits<double>::infinity(), alpha = 1;
  for (int outer = 0; outer < most_linear_steps; ++outer) {
    if (result.status != Status::converged) return result;
    const Vector6 d =
        fixed_part(model.mechanism, deviation(tip(model.mechanism, result.configuration), X_MT));
    const double size = twist_size(d, units);
    if (size <= closure_tolerance) return result;
    if (size > error) alpha /= 2;
    error = size;
    X_t0F = moved(X_t0F, -alpha * d);  // (23)
    const NominalResult next = follow(model, commanded, X_t0F);
    if (next.status != Status::converged) {
      result.status = next.status;
      return result;
    }
    commanded = next.configuration;
    const int iterations = result.iterations;
    result = refine(model, with_actuators_of(model, commanded, result.configuration), problem, by_chains,
                    work.impl());
    result.iterations += iterations;
  }
  result.status = Status::not_converged;
  return result;
}

}  // namespace counterflex
