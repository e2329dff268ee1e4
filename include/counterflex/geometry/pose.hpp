#pragma once
/// Poses, and the moving of wrenches and twists between points. `X_AB` is the pose of frame B in frame A,
/// `R_AB` and `p_AB` its parts; products check by matching letters: X_AC = X_AB * X_BC.
#include <array>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

// Rotations: exponential and logarithm of SO(3), the derivative of the exponential, and the ways files write
// them.

/// The skew matrix [v]x with [v]x w = v x w.
Matrix3 skew(const Vector3& v);

/// R = Exp(phi): the rotation by |phi| (rad) about phi.
Matrix3 exp_so3(const Vector3& phi);

/// phi = Log(R), |phi| <= pi, the inverse of `exp_so3`. Accurate to rounding for any angle, near 0 and near
/// pi too.
Vector3 log_so3(const Matrix3& R);

/// Log(R_to R_from'): the rotation vector from one orientation to another (rad). Costs little where they are
/// nearly the same.
Vector3 rotation_between(const Matrix3& R_to, const Matrix3& R_from);

/// J_l(phi) with Exp(phi + dphi) = Exp(J_l dphi) Exp(phi) to first order: maps the rate of a rotation vector
/// to the angular velocity in the axes of the frame in which `phi` is given.
Matrix3 left_jacobian(const Vector3& phi);

/// Inverse of `left_jacobian`; |phi| < 2 pi.
Matrix3 left_jacobian_inverse(const Vector3& phi);

/// dJ_l/dphi_k for k = 0, 1, 2.
std::array<Matrix3, 3> left_jacobian_derivatives(const Vector3& phi);

/// R = Rz(yaw) Ry(pitch) Rx(roll), `rpy` = (roll, pitch, yaw) in rad: fixed axes, as URDF has them.
Matrix3 from_rpy(const Vector3& rpy);

/// The inverse of `from_rpy`, pitch in [-pi/2, pi/2]; at the poles roll is 0.
Vector3 to_rpy(const Matrix3& R);

/// Rotation of a unit quaternion (w, x, y, z); it is normalised here.
Matrix3 from_quaternion(const Eigen::Vector4d& wxyz);

struct Pose {
  Matrix3 R = Matrix3::Identity();
  Vector3 p = Vector3::Zero();  ///< m

  bool operator==(const Pose&) const = default;
};

inline Pose operator*(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.p + X_AB.R * X_BC.p};
}
inline Vector3 operator*(const Pose& X_AB, const Vector3& p_B) {
  return X_AB.p + X_AB.R * p_B;
}
inline Pose inverse(const Pose& X_AB) {
  return {X_AB.R.transpose(), -(X_AB.R.transpose() * X_AB.p)};
}
Pose translation(const Vector3& p);
Pose rotation(const Matrix3& R);

/// X moved by a spatial twist at its own origin: p + v, Exp(w) R, for `step` = (v, w) (m, rad, axes of A).
Pose moved(const Pose& X_AB, const Vector6& step);

/// The (v, w) with `moved(from, difference(to, from)) == to`: (p_to - p_from, Log(R_to R_from')), m and rad.
Vector6 difference(const Pose& to, const Pose& from);

/// A wrench (force, moment; N, N m) given at point B, at point A instead: the moment gains r x f, r = p_AB in
/// the axes of the wrench.
Vector6 wrench_at(const Vector6& F_B, const Vector3& p_AB);

}  // namespace counterflex
