#pragma once
/// One equilibrium from a start near it: by the kernel, else by the whole system; and whether it is stable,
/// and its system regular. EQUATIONS.md, sections 6 and 8.
#include "statics/theory/manipulator.hpp"

namespace counterflex {

struct NewtonResult {
  bool converged = false;
  int iterations = 0;
  /// Platform or actuators ended elsewhere than the tangent at the start leads: by more than half.
  bool jumped = false;
};

/// On success `configuration` is the solution. The works of the chains are not evaluated.
NewtonResult newton(const Model& model, const Problem& problem, StaticsWork::Impl& work,
                    Configuration& configuration);

/// The same by steps of the whole system. It takes any machine.
NewtonResult newton_of_whole_system(const Model& model, const Problem& problem, StaticsWork::Impl& work,
                                    Configuration& configuration);

/// Whether platform or actuators ended elsewhere than predicted, by more than half of the way from `from`.
bool ends_elsewhere(const Mechanism& mechanism, const Configuration& from, const Configuration& foreseen,
                    const Configuration& found);

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
