#pragma once
/// The home configuration of a model, and what is relative to it. EQUATIONS.md, sections 1 and 10.
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// Fills the values relative to home in a compiled model. Its home configuration must be known.
void settle_at_home(Model& model);

/// What the controller adds to the commanded values while weights act (m, rad; by actuator): not zero where
/// its zero was set under the machine's own weight.
Eigen::VectorXd zero_offsets(const Mechanism& mechanism);
void set_zero_offsets(const Eigen::VectorXd& offsets, Mechanism& mechanism);

/// Makes `configuration` the nominal one, to which its springs are relative.
void mark_nominal(Configuration& configuration);

}  // namespace counterflex
