#include "statics/solve/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statics/model/tolerances.hpp"

namespace counterflex {
namespace {

struct Place {
  Pose X_MP;
  Eigen::VectorXd rho;
};

Place place_of(const Mechanism& mechanism, const Configuration& configuration) {
  return {configuration.X_MP, actuator_values(mechanism, configuration)};
}

// How far platform and actuators are from `start`, in units of l.
Eigen::VectorXd travelled(const Mechanism& mechanism, const Place& start, const Place& now) {
  const Units units{mechanism.length};
  const Eigen::VectorXd drho = now.rho - start.rho;
  Eigen::VectorXd way(6 + drho.size());
  way.head<6>() = difference(now.X_MP, start.X_MP).cwiseQuotient(units.of_pose());
  for (Eigen::Index a = 0; a < drho.size(); ++a)
    way[6 + a] = drho[a] / units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  return way;
}

bool is_elsewhere(const Mechanism& mechanism, const Place& start, const Place& foreseen, const Place& found) {
  const Eigen::VectorXd way = travelled(mechanism, start, found),
                        predicted = travelled(mechanism, start, foreseen);
  const double surplus = (way - predicted).norm();
  return surplus > jump_floor && surplus > same_way * predicted.norm();
}

bool pivots_prove(const Model& model, const Configuration& configuration, const Problem& problem,
                  StaticsWork::Impl& work) {
  const auto pivots = work.kernel.pivots(model.mechanism, problem, configuration);
  return pivots && pivots->unstable_directions == 0 &&
         std::max(pivots->largest, Units::stiffness) < proving_ratio * pivots->least;
}

}  // namespace

bool ends_elsewhere(const Mechanism& mechanism, const Configuration& from, const Configuration& foreseen,
                    const Configuration& found) {
  return is_elsewhere(mechanism, place_of(mechanism, from), place_of(mechanism, foreseen),
                      place_of(mechanism, found));
}

NewtonResult newton_of_whole_system(const Model& model, const Problem& problem, StaticsWork::Impl& work,
                                    Configuration& configuration) {
  const Mechanism& mechanism = model.mechanism;
  const Units units{mechanism.length};
  const Place start = place_of(mechanism, configuration);
  Place predicted = start;
  NewtonResult result;
  double step = std::numeric_limits<double>::infinity();
  for (; result.iterations < most_newton_steps; ++result.iterations) {
    evaluate_all(model, configuration, problem.stage, work);
    const Residual residual = residual_of(model, configuration, problem, work);
    if (!std::isfinite(residual.closure + residual.force)) return result;
    result.converged = step <= step_tolerance && is_solved(mechanism, configuration.X_MP, residual);
    if (result.converged) {
      result.jumped = is_elsewhere(mechanism, start, predicted, place_of(mechanism, configuration));
      return result;
    }
    std::optional<Controlled> tip;
    if (problem.X_MT) tip = tip_equations(mechanism, configuration.X_MP, *problem.X_MT, units);
    const WholeStep whole = solve_whole(whole_system(model, configuration, problem, work), tip, units);
    step = apply(mechanism, whole, units, configuration);
    if (result.iterations == 0) predicted = place_of(mechanism, configuration);
  }
  return result;
}

NewtonResult newton(const Model& model, const Problem& problem, StaticsWork::Impl& work,
                    Configuration& configuration) {
  const Mechanism& mechanism = model.mechanism;
  const Place start = place_of(mechanism, configuration);
  const kernel::SingleAnswer answer = work.kernel.solve(mechanism, problem, configuration);
  if (!answer.accepted) return newton_of_whole_system(model, problem, work, configuration);
  return {true, answer.iterations,
          is_elsewhere(mechanism, start, {answer.first_X_MP, answer.first_rho},
                       place_of(mechanism, configuration))};
}

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
