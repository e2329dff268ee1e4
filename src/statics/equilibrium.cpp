#include "counterflex/statics/equilibrium.hpp"

#include <algorithm>

#include "newton.hpp"

namespace counterflex {
namespace {

constexpr double unstable_ratio = -1e-9, largest_condition = 1e10;
constexpr double first_step = 0.25, smallest_step = 1.0 / 1024;

Stage part_of(const Stage& goal, double s) { return {s * goal.errors, s * goal.load, s * goal.preload}; }

// What is reported of a solution that Newton found: `converged` unless the system there is singular.
void judge_condition(const Model& model, const Problem& problem, StaticsWork::Impl& work, Equilibrium& result) {
  const Units units{model.mechanism.length};
  const auto applied = applied_wrench(model.mechanism, result.configuration.X_MP, problem.load, problem.stage.load);
  result.status = Status::converged;
  if (surely_well_conditioned(model.mechanism, work.chains, applied.tangent, units, largest_condition)) return;
  evaluate_all(model, result.configuration, problem.stage, work);
  const Condition whole = condition(whole_system(model, result.configuration, problem, work), units);
  result.indeterminate = whole.indeterminate;
  if (whole.value <= largest_condition) return;
  result.status = Status::singular;
  result.weakest = whole.weakest;
}

Equilibrium refine(const Model& model, const Configuration& start, const Problem& problem, StaticsWork::Impl& work) {
  Equilibrium result;
  result.configuration = start;
  const NewtonResult solved = newton(model, problem, work, result.configuration);
  result.iterations = solved.iterations;
  if (!solved.converged) return result;
  if (!is_stable(model, result.configuration, problem, work)) {
    result.status = Status::unstable;
    return result;
  }
  judge_condition(model, problem, work, result);
  return result;
}

// Follows the equilibrium from the nominal configuration as errors, load and preloads grow together.
Equilibrium continue_from(const Model& model, const Configuration& nominal, Problem problem, StaticsWork::Impl& work) {
  const Stage goal = problem.stage;
  Equilibrium result;
  result.configuration = nominal;
  double s = 0, step = first_step;
  while (s < 1) {
    const double next_s = std::min(1.0, s + step);
    problem.stage = part_of(goal, next_s);
    Configuration next = result.configuration;
    const NewtonResult solved = newton(model, problem, work, next);
    result.iterations += solved.iterations;
    if (!solved.converged) {
      if ((step /= 2) < smallest_step) return result;
      continue;
    }
    result.configuration = std::move(next);
    s = next_s;
    if (is_stable(model, result.configuration, problem, work)) continue;
    result.status = Status::unstable;
    return result;
  }
  judge_condition(model, problem, work, result);
  return result;
}

}  // namespace

StaticsWork::StaticsWork(const Mechanism& mechanism) : impl_(std::make_unique<Impl>()) {
  for (const Series& chain : mechanism.chains) impl_->chains.push_back(make_work(chain));
}
StaticsWork::~StaticsWork() = default;
StaticsWork::StaticsWork(StaticsWork&&) noexcept = default;

bool is_stable(const Model& model, const Configuration& configuration, const Problem& problem,
               const StaticsWork::Impl& work) {
  const auto applied = applied_wrench(model.mechanism, configuration.X_MP, problem.load, problem.stage.load);
  if (surely_stable(model.mechanism, work.chains, applied.tangent, {model.mechanism.length})) return true;
  return least_eigenvalue_ratio(whole_system(model, configuration, problem, work)) >= unstable_ratio;
}

Equilibrium solve_forward(const Model& model, const Configuration& nominal, const Load& load, const Stage& goal,
                          StaticsWork& work) {
  return continue_from(model, nominal, {load, goal, nullptr}, work.impl());
}

Equilibrium refine_forward(const Model& model, const Configuration& start, const Load& load, const Stage& goal,
                           StaticsWork& work) {
  return refine(model, start, {load, goal, nullptr}, work.impl());
}

Equilibrium solve_target(const Model& model, const Configuration& nominal, const Pose& X_MT, const Load& load,
                         const Stage& goal, StaticsWork& work) {
  return continue_from(model, nominal, {load, goal, &X_MT}, work.impl());
}

Equilibrium refine_target(const Model& model, const Configuration& start, const Pose& X_MT, const Load& load,
                          const Stage& goal, StaticsWork& work) {
  return refine(model, start, {load, goal, &X_MT}, work.impl());
}

ManipulatorStiffness stiffness(const Model& model, const Configuration& configuration, const Stage& stage,
                               StaticsWork& work) {
  evaluate_all(model, configuration, stage, work.impl());
  ManipulatorStiffness result;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
    SeriesWork& chain = work.impl().chains[i];
    if (!condense(model.mechanism.chains[i], {model.mechanism.length}, false, chain)) return {Matrix6::Zero(), false};
    result.K += chain.K;
  }
  return result;
}

double stability(const Model& model, const Configuration& configuration, const Load& load, const Stage& stage,
                 StaticsWork& work) {
  evaluate_all(model, configuration, stage, work.impl());
  return least_eigenvalue_ratio(whole_system(model, configuration, {load, stage, nullptr}, work.impl()));
}

double static_condition(const Model& model, const Configuration& configuration, const Load& load, const Stage& stage,
                        StaticsWork& work) {
  evaluate_all(model, configuration, stage, work.impl());
  return condition(whole_system(model, configuration, {load, stage, nullptr}, work.impl()), {model.mechanism.length})
      .value;
}

}  // namespace counterflex
