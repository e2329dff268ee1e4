#pragma once
/// The controlled components of the tip as equations over the platform's twist.
#include "counterflex/statics/mechanism.hpp"
#include "statics/model/units.hpp"

namespace counterflex {

/// By controlled component; in place, there are at most six.
using ControlledRows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6>;
using ControlledValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Equations that fix components of the tip: rows over the platform's variables, and their right-hand side.
struct Controlled {
  ControlledRows rows;  ///< n x 6, without unit
  ControlledValues rhs;
};

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
