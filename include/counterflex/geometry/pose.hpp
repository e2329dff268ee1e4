#pragma once
/// Poses, and the moving of wrenches and twists between points. `X_AB` is the pose of frame B in frame A, `R_AB` and
/// `p_AB` its parts; products check by matching letters: X_AC = X_AB * X_BC.
#include "counterflex/geometry/rotation.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

struct Pose {
  Matrix3 R = Matrix3::Identity();
  Vector3 p = Vector3::Zero();  ///< m
};

inline Pose operator*(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.p + X_AB.R * X_BC.p};
}
inline Vector3 operator*(const Pose& X_AB, const Vector3& p_B) { return X_AB.p + X_AB.R * p_B; }
inline Pose inverse(const Pose& X_AB) { return {X_AB.R.transpose(), -(X_AB.R.transpose() * X_AB.p)}; }
Pose translation(const Vector3& p);
Pose rotation(const Matrix3& R);

/// X moved by a spatial twist at its own origin: p + v, Exp(w) R, for `step` = (v, w) (m, rad, axes of A).
Pose moved(const Pose& X_AB, const Vector6& step);

/// The (v, w) with `moved(from, difference(to, from)) == to`: (p_to - p_from, Log(R_to R_from')), m and rad.
Vector6 difference(const Pose& to, const Pose& from);

/// A wrench (force, moment; N, N m) given at point B, at point A instead: the moment gains r x f, r = p_AB in the axes
/// of the wrench.
Vector6 wrench_at(const Vector6& F_B, const Vector3& p_AB);

}  // namespace counterflex
