#pragma once
/// One equilibrium from a start near it: by the kernel, else by the whole system. EQUATIONS.md, section 8.
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

}  // namespace counterflex
