#pragma once
/// Following an equilibrium while errors, load, preloads and weights grow.
#include <functional>

#include "statics/solve/newton.hpp"

namespace counterflex {

using EquilibriumSolver = std::function<NewtonResult(const Model&, const Problem&, StaticsWork::Impl&,
                                                     Configuration&)>;  ///< as `newton`

/// What must be right of a step: the equilibria that it joins; or also that half of it leads about half of
/// the way, since a step that is long enough can cross a limit point to another stable branch.
enum class Watch { equilibria, ways };

/// Of every share, the part `s` of the way from one stage to another.
Stage between(const Stage& from, const Stage& goal, double s);

/// From the equilibrium `start` of stage `from` to the stage of `problem`, in at least four steps, smaller
/// where one does not converge.
Equilibrium continue_from(const Model& model, const Configuration& start, const Stage& from, Problem problem,
                          const EquilibriumSolver& solve, StaticsWork::Impl& work,
                          Watch watch = Watch::equilibria);

/// One solve from a start of the caller's choice, judged like the end of a continuation.
Equilibrium refine(const Model& model, const Configuration& start, const Problem& problem,
                   const EquilibriumSolver& solve, StaticsWork::Impl& work);

}  // namespace counterflex
