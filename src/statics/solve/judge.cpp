#include "statics/solve/judge.hpp"

#include "statics/model/tolerances.hpp"
#include "statics/solve/newton.hpp"

namespace counterflex {
namespace {

bool pivots_prove(const Model& model, const Configuration& configuration, const Problem& problem,
                  StaticsWork::Impl& work) {
  const auto pivots = work.kernel.pivots(model.mechanism, problem, configuration);
  return pivots && pivots->unstable_directions == 0 &&
         std::max(pivots->largest, Units::stiffness) < proving_ratio * pivots->least;
}

}  // namespace

double least_eigenvalue(const Model& model, const Configuration& configuration, const Problem& problem,
                        StaticsWork::Impl& work) {
  evaluate_all(model, configuration, problem.stage, work);
  return least_scaled_eigenvalue(whole_system(model, configuration, problem, work));
}

Stability judge_stability(const Model& model, const Configuration& configuration, const Problem& problem,
                          StaticsWork::Impl& work) {
  if (pivots_prove(model, configuration, problem, work)) return {true, true};
  double least = least_eigenvalue(model, configuration, problem, work);
  if (std::abs(least) < clear_eigenvalue) {  // near the critical load the wrenches must be exact
    Configuration exact = configuration;
    if (newton_of_whole_system(model, problem, work, exact).converged)
      least = least_eigenvalue(model, exact, problem, work);
  }
  return {least >= 0, false};
}

void judge_condition(const Model& model, const Problem& problem, StaticsWork::Impl& work,
                     Equilibrium& result) {
  evaluate_all(model, result.configuration, problem.stage, work);
  const WholeSystem system = whole_system(model, result.configuration, problem, work);
  result.status = Status::converged;
  if (condition_bound(system) < largest_condition) return;
  const Condition whole = condition(system, Units{model.mechanism.length});
  result.indeterminate = whole.indeterminate;
  if (whole.value <= largest_condition) return;
  result.status = Status::singular;
  result.weakest = whole.weakest;
}

}  // namespace counterflex
