#pragma once
/// Force over displacement of the tip along one direction. The displacement is prescribed, not the force, so that the curve
/// passes limit points.
#include <optional>
#include <vector>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// The tip is moved along a direction; the components across it, and its rotation, stay free.
struct CurveRequest {
  Vector3 direction = Vector3::UnitX();  ///< unit vector, axes of M
  double from = 0, to = 0;               ///< m, from where the tip stands without the force
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
  Status status = Status::not_converged;  ///< of the state without the force, then of the first point that was not found
  std::vector<CurvePoint> points;         ///< by displacement; those that were found
  /// The last stable state before the first unstable one, on the way from displacement 0 to either side: a limit point
  /// (stiffness zero) or a bifurcation. Its displacement is known to 1e-9 of itself.
  std::vector<CurvePoint> critical;
};

/// Follows the equilibrium from the nominal configuration to the state under `request.load`, and from there along the
/// displacement, in smaller steps where one does not converge.
ForceCurve force_curve(const Model& model, const Configuration& nominal, const CurveRequest& request, StaticsWork& work);

}  // namespace counterflex
