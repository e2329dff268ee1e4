#pragma once
/// Machines whose elastic joints have a knee.
#include "statics/support/laws_support.hpp"

namespace counterflex::laws {

/// All compliances in chains change to `factor` times their stiffness at the load `knee` (N or N m).
inline Machine with_knees(Machine machine, double knee, double factor) {
  for (Chain& chain : machine.chains)
    for (Element& element : chain.elements)
      if (auto* joint = std::get_if<Compliance>(&element))
        joint->beyond = SecondSlope{knee, factor * joint->stiffness};
  return machine;
}

}  // namespace counterflex::laws
