#pragma once
/// Rotations: exponential and logarithm of SO(3), the derivative of the exponential, and the ways files write them.
#include <array>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// The skew matrix [v]x with [v]x w = v x w.
Matrix3 skew(const Vector3& v);

/// R = Exp(phi): the rotation by |phi| (rad) about phi.
Matrix3 exp_so3(const Vector3& phi);

/// phi = Log(R), |phi| <= pi, the inverse of `exp_so3`. Accurate to rounding for any angle, near 0 and near pi too.
Vector3 log_so3(const Matrix3& R);

/// Log(R_to R_from'): the rotation vector from one orientation to another (rad). Costs little where they are
/// nearly the same.
Vector3 rotation_between(const Matrix3& R_to, const Matrix3& R_from);

/// J_l(phi) with Exp(phi + dphi) = Exp(J_l dphi) Exp(phi) to first order: maps the rate of a rotation vector to the
/// angular velocity in the axes of the frame in which `phi` is given.
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

}  // namespace counterflex
