#pragma once
/// Loads in joints and springs at a configuration: largest absolute components, as in the paper's Table 2.
#include <string>
#include <vector>

#include "counterflex/machine/load_limits.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// Of one chain. Springs and compliances in their own frames, theta and K (theta - theta_0); what a group
/// transmits (the moment at its end) in the frame of its first branch's first spring, the paper's tau_phi;
/// passive revolute joints by their change from the nominal configuration. SI.
struct ChainLoads {
  std::string name;
  Vector6 wrench =
      Vector6::Zero();  ///< that the platform exerts on the chain's end, at the reference point, axes of M
  double moment_max = 0;
  double spring_translation_max = 0;
  double spring_rotation_max = 0;
  double spring_force_max = 0;
  double spring_torque_max = 0;
  double group_moment_max = 0;
  double passive_change_max = 0;
};

/// Of every chain of `model`. A tool that yields is part of the chain behind which it stands.
std::vector<ChainLoads> loads(const Model& model, const Configuration& configuration, const Stage& stage);

/// Of every chain of the machine that `base` is without a tool, at a configuration of `model`, the same
/// machine with one: a tool that yields has no load here, and chains that it has made the branches of one
/// chain (`with_tool`) are chains again. What is exerted on their ends is at `base`'s reference point, where it
/// is in the deflected machine.
std::vector<ChainLoads> loads_without_tool(const Mechanism& base, const Model& model,
                                           const Configuration& configuration, const Stage& stage);

/// One of them (SI).
double value_of(const ChainLoads& loads, LoadKind kind);

}  // namespace counterflex
