#pragma once
/// Rigid transforms of the flat machine as products of fixed poses and of assembly errors, of which a share
/// acts.
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "statics/kernel/machine/flat_machine.hpp"

namespace counterflex::kernel {

struct TransformFactor {
  Pose X;
  Vector3 log_R = Vector3::Zero();  ///< of an error
  bool error = false, inverted = false;
};
using TransformProduct = std::vector<TransformFactor>;

TransformProduct inverse_of(TransformProduct product);

/// The pose with a share of the errors: s p, Exp(s Log R) of each.
Pose pose_of(const TransformProduct& product, double errors);

Transform transform_of(const Pose& X);

}  // namespace counterflex::kernel
