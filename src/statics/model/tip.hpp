#pragma once
/// The controlled components of the tip as equations over the platform's twist.
#include "counterflex/statics/mechanism.hpp"
#include "statics/model/units.hpp"

namespace counterflex {

/// Equations that fix components of the tip (at most six, in place): rows over the platform's variables, and
/// right-hand sides, both without unit. The actuators are the unknowns that meet them; or the sizes of forces
/// along the rows.
struct Controlled {
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> rows;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> rhs;
  bool by_forces = false;
};

/// For the platform at `X_MP`: d(deviation)/d(twist of P) of the controlled components, and minus the
/// deviation there.
Controlled tip_equations(const Mechanism& mechanism, const Pose& X_MP, const Pose& X_MT, const Units& units);

/// Twist of the tip per twist of the reference point: [1 -[r]x ; 0 1], r from that point to the tip (axes of
/// M).
Matrix6 tip_from_platform(const Mechanism& mechanism, const Pose& X_MP);

/// Which components the target fixes: the controlled ones, or all six.
std::vector<int> fixed_components(const Mechanism& mechanism);

/// These components of a deviation; the others are zero.
Vector6 fixed_part(const Mechanism& mechanism, const Vector6& deviation);

}  // namespace counterflex
