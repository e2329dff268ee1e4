#pragma once
/// What a force at the tool tip meets, the tool's lever and its bending included: the compliance there, and
/// the force over displacement, whose displacement is prescribed so that the curve passes limit points.
#include <optional>
#include <vector>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// Twist of the tip (m, rad; axes of M) per wrench at the tip (N, N m; axes of M), actuators held, at a
/// configuration in equilibrium under `load`:
///
///     C_T = T (K - K_load)^-1 T'        T = [ I  -[r]x ; 0  I ],  r from the reference point to the tip
///
/// The whole static system is solved, so that a machine has a compliance whether its chains have a stiffness
/// of their own or not. Rigid directions have compliance zero. Empty where some wrench moves the platform
/// without resistance. EQUATIONS.md, section 5.
std::optional<Matrix6> compliance_at_tip(const Model& model, const Configuration& configuration,
                                         const Load& load, const Stage& stage, StaticsWork& work);

/// Force over motion along the unit vector `direction` for a force in that direction (N/m); infinite in a
/// rigid one.
double stiffness_along(const Matrix6& compliance, const Vector3& direction);

/// The direction in which a force at the tip moves the tip furthest: a unit vector (axes of M) whose largest
/// component is positive, and the stiffness along it (N/m). Infinite, with direction zero: rigid.
struct SoftestDirection {
  Vector3 direction = Vector3::Zero();
  double stiffness = 0;
};
SoftestDirection softest_direction(const Matrix6& compliance);

/// The inverse, with lengths in units of `length` (m); empty where the machine is rigid in some direction.
std::optional<Matrix6> inverse_compliance(const Matrix6& compliance, double length);

/// The tip is moved along a direction; the components across it, and its rotation, stay free.
struct CurveRequest {
  Vector3 direction = Vector3::UnitX();  ///< unit vector, axes of M
  double from = 0, to = 0;               ///< m, from the tip's position without the force
  int steps = 1;                         ///< points are `steps` + 1
  Load load{};                           ///< acts besides, constant
};

struct CurvePoint {
  double displacement = 0;  ///< m, along the direction
  double force = 0;         ///< N, along the direction, at the tip
  double stiffness = 0;     ///< N/m, tangent: d force / d displacement
  bool stable = false;      ///< under a constant force (`unstable` of EQUATIONS.md, section 6)
  Pose X_MT;
};

struct ForceCurve {
  /// Of the state without the force, then of the first point that was not found; `singular` where the machine
  /// is rigid along the direction.
  Status status = Status::not_converged;
  /// A force along the direction does not move the tip: displacement 0 alone has a point, of infinite
  /// stiffness.
  bool rigid = false;
  std::vector<CurvePoint> points;  ///< by displacement; those that were found
  /// The last stable state before the first unstable one, on the way from displacement 0 to either side: a
  /// limit point (stiffness zero) or a bifurcation. Its displacement is known to 1e-9 of itself. States are
  /// judged at least at each 64th of the longer side.
  std::vector<CurvePoint> critical;
};

/// Follows the equilibrium from the nominal configuration to the state under `request.load`, and from there
/// along the displacement, in smaller steps where one does not converge.
ForceCurve force_curve(const Model& model, const Configuration& nominal, const CurveRequest& request,
                       StaticsWork& work);

}  // namespace counterflex
