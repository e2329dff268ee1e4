#include "counterflex/geometry/pose.hpp"

#include <Eigen/Geometry>

namespace counterflex {

Pose translation(const Vector3& p) {
  return {Matrix3::Identity(), p};
}

Pose rotation(const Matrix3& R) {
  return {R, Vector3::Zero()};
}

Pose moved(const Pose& X_AB, const Vector6& step) {
  return {exp_so3(step.tail<3>()) * X_AB.R, X_AB.p + step.head<3>()};
}

Vector6 difference(const Pose& to, const Pose& from) {
  Vector6 d;
  d << to.p - from.p, rotation_between(to.R, from.R);
  return d;
}

Vector6 wrench_at(const Vector6& F_B, const Vector3& p_AB) {
  Vector6 F_A = F_B;
  F_A.tail<3>() += p_AB.cross(F_B.head<3>());
  return F_A;
}

}  // namespace counterflex
