#include "continuation.hpp"

#include <algorithm>

namespace counterflex {
namespace {

constexpr double unstable_ratio = -1e-9, largest_condition = 1e10;
constexpr double first_step = 0.25, smallest_step = 1.0 / 1024;

Stage part_of(const Stage& goal, double s) { return {s * goal.errors, s * goal.load, s * goal.preload, s * goal.gravity}; }

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

}  // namespace

Equilibrium refine(const Model& model, const Configuration& start, const Problem& problem, const EquilibriumSolver& solve,
                   StaticsWork::Impl& work) {
  Equilibrium result;
  result.configuration = start;
  const NewtonResult solved = solve(problem, work, result.configuration);
  result.iterations = solved.iterations;
  if (solved.converged) judge(model, problem, work, result);
  return result;
}

void judge(const Model& model, const Problem& problem, StaticsWork::Impl& work, Equilibrium& result) {
  if (is_stable(model, result.configuration, problem, work))
    judge_condition(model, problem, work, result);
  else
    result.status = Status::unstable;
}

Equilibrium continue_from(const Model& model, const Configuration& nominal, Problem problem, const EquilibriumSolver& solve,
                          StaticsWork::Impl& work) {
  const Stage goal = problem.stage;
  Equilibrium result;
  result.configuration = nominal;
  double s = 0, step = first_step;
  while (s < 1) {
    const double next_s = std::min(1.0, s + step);
    problem.stage = part_of(goal, next_s);
    Configuration next = result.configuration;
    const NewtonResult solved = solve(problem, work, next);
    result.iterations += solved.iterations;
    if (!solved.converged || solved.jumped) {  // a jump: past a limit point, to an equilibrium on another branch
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

EquilibriumSolver newton_solver(const Model& model) {
  return [&model](const Problem& problem, StaticsWork::Impl& work, Configuration& configuration) {
    return newton(model, problem, work, configuration);
  };
}

bool is_stable(const Model& model, const Configuration& configuration, const Problem& problem,
               const StaticsWork::Impl& work) {
  const auto applied = applied_wrench(model.mechanism, configuration.X_MP, problem.load, problem.stage.load);
  if (surely_stable(model.mechanism, work.chains, applied.tangent, {model.mechanism.length})) return true;
  return least_eigenvalue_ratio(whole_system(model, configuration, problem, work)) >= unstable_ratio;
}

}  // namespace counterflex
