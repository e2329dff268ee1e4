#pragma once
/// Compliance and stiffness at the tool tip: what a force there meets, the tool's lever and its bending included.
#include <optional>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// Twist of the tip (m, rad; axes of M) per wrench at the tip (N, N m; axes of M), actuators held, at a configuration in
/// equilibrium under `load`:
///
///     C_T = T (K - K_load)^-1 T'        T = [ I  -[r]x ; 0  I ],  r from the reference point to the tip
///
/// The whole static system is solved, so that a machine has a compliance whether its chains have a stiffness of their own or
/// not. Rigid directions have compliance zero. Empty where some wrench moves the platform without resistance.
/// EQUATIONS.md, section 5.
std::optional<Matrix6> compliance_at_tip(const Model& model, const Configuration& configuration, const Load& load,
                                         const Stage& stage, StaticsWork& work);

/// Force over motion along the unit vector `direction` for a force in that direction (N/m); infinite in a rigid one.
double stiffness_along(const Matrix6& compliance, const Vector3& direction);

/// The inverse, with lengths in units of `length` (m); empty where the machine is rigid in some direction.
std::optional<Matrix6> inverse_compliance(const Matrix6& compliance, double length);

}  // namespace counterflex
