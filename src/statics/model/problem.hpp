#pragma once
/// What one waypoint should satisfy.
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

struct Problem {
  Load load;
  Stage stage;
  /// Where the controlled components of the tip are wanted; none: actuators are held.
  const Pose* X_MT = nullptr;
};

}  // namespace counterflex
