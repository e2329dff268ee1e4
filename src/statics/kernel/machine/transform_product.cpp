#include "statics/kernel/machine/transform_product.hpp"

#include <algorithm>

#include "statics/kernel/equations/work.hpp"

namespace counterflex::kernel {

TransformProduct inverse_of(TransformProduct product) {
  std::reverse(product.begin(), product.end());
  for (TransformFactor& factor : product) factor.inverted = !factor.inverted;
  return product;
}

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

Transform transform_of(const Pose& X) {
  Transform transform;
  for (int i = 0; i < 9; ++i) at(transform.R, i) = X.R(i / 3, i % 3);
  for (int i = 0; i < 3; ++i) at(transform.p, i) = X.p[i];
  transform.turns = !X.R.isIdentity(0);
  transform.shifts = !X.p.isZero(0);
  return transform;
}

}  // namespace counterflex::kernel
