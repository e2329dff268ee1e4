#pragma once
/// The controlled components of the tip as equations over the platform's twist.
#include "whole_system.hpp"

namespace counterflex {

/// For the platform at `X_MP`: rows d(deviation)/d(twist of P) of the controlled components (SI), and the deviation there.
struct TipEquations {
  ControlledRows rows;
  ControlledValues error;
};
TipEquations tip_equations(const Mechanism& mechanism, const Pose& X_MP, const Pose& X_MT);

/// The same, ready for the whole system: the step should take the error away.
Controlled to_controlled(const TipEquations& tip, const Mechanism& mechanism, const Units& units);

/// Which components the target fixes: the controlled ones, or all six.
std::vector<int> fixed_components(const Mechanism& mechanism);

}  // namespace counterflex
