#pragma once
/// Everything that is known of each chain at an equilibrium, by the paper's equation numbers: stiffness (3), joints and
/// springs per platform motion (4) (5), energy (12), assembly errors (14), and every coordinate by name.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/statics/chain.hpp"

namespace counterflex {

/// One coordinate: a joint, a compliance, or one component of a spring. SI.
struct CoordinateDetail {
  std::string element;  ///< its number in the chain, "7/upper_bar/4" in the fourth place of a branch; masses not counted
  PartKind kind = PartKind::passive;
  int component = -1;   ///< of a spring, 0 to 5: x y z rx ry rz; else -1
  bool angular = false;
  double value = 0;     ///< m, rad; a spring's theta with its preload
  double change = 0;    ///< from the nominal configuration
  double load = 0;      ///< N, N m: dE/dx, K (theta - theta_0) of a spring; zero for an actuator
};

struct ChainDetail {
  std::string name;
  Vector6 wrench = Vector6::Zero();       ///< of the platform on the chain's end, at its origin, axes of M
  ChainStiffness stiffness;               ///< (3)-(5)
  std::vector<std::size_t> passive;       ///< by row of K_Cq: index into `coordinates`
  std::vector<std::size_t> elastic;       ///< by row of K_Ctheta
  std::optional<Vector6> eps;             ///< of (14), first order; see `chain_eps`
  std::optional<Vector6> dt;              ///< (14): motion of the platform less eps
  double energy = 0;                      ///< (12), J: of springs, compliances and sprung joints
  std::vector<CoordinateDetail> coordinates;  ///< in the order of elements; a group's branches where it stands
};

/// Where stiffness is taken: at the equilibrium itself, or for the linear theory at the nominal configuration.
struct StiffnessPlace {
  const Configuration& configuration;
  Stage stage;
};

/// Details of every chain of `model`; a tool that bends is part of the chain behind which it stands. `dt_P` is the motion of
/// the reference point from the nominal configuration (m, rad; axes of M).
std::vector<ChainDetail> chain_details(const Model& model, const Configuration& nominal, const Configuration& loaded,
                                       const Vector6& dt_P, const StiffnessPlace& stiff, StaticsWork& work);

}  // namespace counterflex
