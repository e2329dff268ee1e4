#include "statics/solve/continuation.hpp"

#include <optional>

#include "statics/model/tolerances.hpp"
#include "statics/solve/by_parts.hpp"

namespace counterflex {
namespace {

// From `before` through `now`, `ratio` times as far again.
void extrapolate(const SeriesState& before, double ratio, SeriesState& now) {
  now.x += ratio * (now.x - before.x);
  now.F += ratio * (now.F - before.F);
  for (std::size_t g = 0; g < now.groups.size(); ++g) {
    GroupState& group = now.groups[g];
    group.X = moved(group.X, ratio * difference(group.X, before.groups[g].X));
    for (std::size_t b = 0; b < group.branches.size(); ++b)
      extrapolate(before.groups[g].branches[b], ratio, group.branches[b]);
  }
}

Configuration extrapolated(const Configuration& before, const Configuration& now, double ratio) {
  Configuration next = now;
  next.X_MP = moved(now.X_MP, ratio * difference(now.X_MP, before.X_MP));
  for (std::size_t i = 0; i < next.chains.size(); ++i) extrapolate(before.chains[i], ratio, next.chains[i]);
  return next;
}

// An equilibrium that was followed so far.
struct Followed {
  double s = 0;
  Configuration configuration;
  Stability form{};
};

// Whether the state under half of a step is not about half of the way: then a limit point may lie between.
bool bends(const Mechanism& mechanism, const Followed& now, const Configuration& half, const Followed& next) {
  return ends_elsewhere(mechanism, now.configuration,
                        extrapolated(now.configuration, next.configuration, -0.5), half);
}

// Solves and judges the equilibria of one continuation.
struct EquilibriumFollower {
  const Model& model;
  const EquilibriumSolver& solve;
  StaticsWork::Impl& work;
  int iterations = 0;

  bool solves(const Problem& problem, Configuration& next) {
    const NewtonResult solved = solve(model, problem, work, next);
    iterations += solved.iterations;
    return solved.converged &&
           !solved.jumped;  // a jump: past a limit point, to an equilibrium on another branch
  }

  // The next equilibrium, from where the last two point to. An equilibrium counts only if it is stable
  // and near this place: the last equilibrium decides otherwise.
  bool steps_straight_on(const Problem& problem, const Followed& before, const Followed& now,
                         Followed& next) {
    const double ratio = (next.s - now.s) / (now.s - before.s);
    const Configuration foreseen = extrapolated(before.configuration, now.configuration, ratio);
    next.configuration = foreseen;
    if (!solves(problem, next.configuration) ||
        ends_elsewhere(model.mechanism, now.configuration, foreseen, next.configuration))
      return false;
    next.form = judge_stability(model, next.configuration, problem, work);
    return next.form.stable;
  }

  bool advances(const Problem& problem, const std::optional<Followed>& before, const Followed& now,
                Followed& next) {
    if (before && steps_straight_on(problem, *before, now, next)) return true;
    next.configuration = now.configuration;
    if (!solves(problem, next.configuration)) return false;
    next.form = judge_stability(model, next.configuration, problem, work);
    return true;
  }
};

// The status of an equilibrium.
void report(const Model& model, const Problem& problem, const Stability& form, StaticsWork::Impl& work,
            Equilibrium& result) {
  result.status = form.stable ? Status::converged : Status::unstable;
  if (form.stable && !form.well_conditioned) judge_condition(model, problem, work, result);
}

}  // namespace

Stage between(const Stage& from, const Stage& goal, double s) {
  const auto at = [s](double a, double b) { return a + s * (b - a); };
  return {at(from.errors, goal.errors), at(from.load, goal.load), at(from.preload, goal.preload),
          at(from.gravity, goal.gravity)};
}

Equilibrium refine(const Model& model, const Configuration& start, const Problem& problem,
                   const EquilibriumSolver& solve, StaticsWork::Impl& work) {
  Equilibrium result;
  result.configuration = start;
  const NewtonResult solved = solve(model, problem, work, result.configuration);
  result.iterations = solved.iterations;
  if (solved.converged)
    report(model, problem, judge_stability(model, result.configuration, problem, work), work, result);
  return result;
}

Equilibrium continue_from(const Model& model, const Configuration& start, const Stage& from, Problem problem,
                          const EquilibriumSolver& solve, StaticsWork::Impl& work, Watch watch) {
  const Stage goal = problem.stage;
  Equilibrium result;
  EquilibriumFollower follower{model, solve, work};
  std::optional<Followed> before;
  Followed now{0, start, {true, false}};
  const bool arrived = by_parts(first_part, smallest_part, [&](double, double s) {
    if (!now.form.stable) return true;  // the way ended there
    Followed next{s, {}};
    Configuration half = now.configuration;
    problem.stage = between(from, goal, (now.s + next.s) / 2);
    const bool begins = watch == Watch::equilibria || follower.solves(problem, half);
    problem.stage = between(from, goal, next.s);
    if (!begins || !follower.advances(problem, before, now, next)) return false;
    if (watch == Watch::ways && bends(model.mechanism, now, half, next)) return false;
    before = std::move(now);
    now = std::move(next);
    return true;
  });
  result.configuration = std::move(now.configuration);
  result.iterations = follower.iterations;
  if (arrived)
    report(model, problem, now.form, work, result);
  else if (now.s == 0) {  // no part of the load has an equilibrium: perhaps the start does not resist it
    judge_condition(model, {Load{}, from, nullptr}, work, result);
    if (result.status != Status::singular) result.status = Status::not_converged;
  }
  return result;
}

}  // namespace counterflex
