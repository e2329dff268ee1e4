#pragma once
/// A controller whose zero was set at home, under the machine's own weight. EQUATIONS.md, section 10.
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// Finds the actuators' offsets with which the perfect, preloaded machine without a load has the controlled
/// components of its tip at home's pose under its own weight; keeps them in the mechanism, or says in
/// `gravity_status` why there are none.
void hold_home(Model& model);

}  // namespace counterflex
