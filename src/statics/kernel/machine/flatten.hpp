#pragma once
/// From a Model to the flat machine of the kernel, and between their states.
#include <vector>

#include "counterflex/statics/nominal.hpp"
#include "statics/kernel/machine/flat_machine.hpp"

namespace counterflex::kernel {

/// A rigid transform of the flat machine is a product of fixed poses and of assembly errors, of which a share
/// acts.
struct TransformFactor {
  Pose X;
  Vector3 log_R = Vector3::Zero();  ///< of an error
  bool error = false, inverted = false;
};
using TransformProduct = std::vector<TransformFactor>;

TransformProduct inverse_of(TransformProduct product);

Transform transform_of(const Pose& X);

/// A flat machine, and what of the model its parts are.
struct Flat {
  FlatMachine machine;
  bool is_solvable = true;  ///< else a chain has too many actuators, and `machine` means nothing
  bool rigid = false;       ///< springs, compliances and masses are left out, passive joints are free
  std::vector<TransformProduct> transforms;

  /// The place of a number of the state in a Configuration: a column, or the frame before a part of a series.
  struct Place {
    int series = 0, index = 0;
  };
  std::vector<Place> joints, nodes;
};

/// Whether a part is a six-element. Those of a series are its first elements, in order.
inline bool is_six(const Flat& flat, const Part& part) {
  return (part.kind == PartKind::spring && !flat.rigid) || part.kind == PartKind::group;
}

/// The machine of a mechanism, its load at the tip or at the reference point.
Flat flatten(const Mechanism& mechanism, bool load_at_platform);

/// The machine of nominal kinematics. Every series without groups is closed by one spring: where its energy
/// is zero the closures hold.
Flat flatten_rigid(const Mechanism& mechanism);

/// The table of transforms with a share of the errors: s p, Exp(s Log R) of each.
std::vector<Transform> transforms_at(const Flat& flat, double errors);

/// FlatMachine::state_size numbers: joints, then R row by row and p (m, in M) of each node and of the
/// platform.
std::vector<double> state_of(const Mechanism& mechanism, const Flat& flat, const Configuration& configuration,
                             double errors);

}  // namespace counterflex::kernel
