#pragma once
/// Springs for rigid machines: kernels need some. EQUATIONS.md, section 11, "Rigid machines".
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// Whether nothing in a machine is elastic: no spring, no compliance, no stiff passive joint. Loads do not
/// move it. Machines with groups are left out.
bool is_rigid(const Mechanism& mechanism);

/// A rigid model with a spring at the end of every chain. Where no spring carries a wrench it stands as the
/// rigid machine.
Model with_end_springs(const Model& rigid);

/// A configuration of `with_end_springs` without the springs' coordinates.
Configuration without_end_springs(Configuration configuration);

}  // namespace counterflex
