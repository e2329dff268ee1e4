#include <algorithm>

#include "counterflex/geometry/pose.hpp"
#include "statics/kernel/equations/work.hpp"
#include "statics/kernel/machine/flatten.hpp"
#include "statics/model/motion_errors.hpp"

namespace counterflex::kernel {
namespace {

/// The pose with a share of the errors: s p, Exp(s Log R) of each.
Pose pose_of(const TransformProduct& product, double errors) {
  Pose X;
  for (const TransformFactor& factor : product) {
    const bool partly = factor.error && errors != 1;
    const Pose acts =
        partly ? Pose{counterflex::exp_so3(errors * factor.log_R), errors * factor.X.p} : factor.X;
    X = X * (factor.inverted ? inverse(acts) : acts);
  }
  return X;
}

}  // namespace

TransformProduct inverse_of(TransformProduct product) {
  std::reverse(product.begin(), product.end());
  for (TransformFactor& factor : product) factor.inverted = !factor.inverted;
  return product;
}

Transform transform_of(const Pose& X) {
  Transform transform;
  for (int i = 0; i < 9; ++i) at(transform.R, i) = X.R(i / 3, i % 3);
  for (int i = 0; i < 3; ++i) at(transform.p, i) = X.p[i];
  transform.turns = !X.R.isIdentity(0);
  transform.shifts = !X.p.isZero(0);
  return transform;
}

std::vector<Transform> transforms_at(const Flat& flat, double errors) {
  std::vector<Transform> table;
  for (const TransformProduct& product : flat.transforms)
    table.push_back(transform_of(pose_of(product, errors)));
  return table;
}

MotionNumbers motion_numbers(const ErrorMotion& motion, double q, double offset, double share) {
  const Joint joint{motion.turns ? JointKind::revolute : JointKind::prismatic,
                    Vector3(motion.axis[0], motion.axis[1], motion.axis[2])};
  const JointMotion at = joint_motion(joint, motion.errors, q, q - offset, share);
  MotionNumbers numbers;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    for (Eigen::Index j = 0; j < 3; ++j) numbers[3 * i + static_cast<std::size_t>(j)] = at.X.R(k, j);
    numbers[9 + i] = at.X.p[k], numbers[12 + i] = at.v[k], numbers[15 + i] = at.w[k];
  }
  return numbers;
}

}  // namespace counterflex::kernel
