#pragma once
/// Whether an equilibrium is stable, and its system regular. EQUATIONS.md, sections 6 and 8.
#include "statics/theory/manipulator.hpp"

namespace counterflex {

/// Of an equilibrium. The pivots of the kernel prove most equilibria; the whole system decides about the
/// others.
struct Stability {
  bool stable = false;
  bool well_conditioned = false;  ///< proved; if false, it is not known
};
Stability judge_stability(const Model& model, const Configuration& configuration, const Problem& problem,
                          StaticsWork::Impl& work);

/// The least scaled eigenvalue of the whole system at a configuration.
double least_eigenvalue(const Model& model, const Configuration& configuration, const Problem& problem,
                        StaticsWork::Impl& work);

/// The status of a stable equilibrium, `converged` or `singular`, into `result`.
void judge_condition(const Model& model, const Problem& problem, StaticsWork::Impl& work,
                     Equilibrium& result);

}  // namespace counterflex
