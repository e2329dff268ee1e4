#pragma once
/// The platform held at a pose while the actuators are commanded for another one: the force-deflection relation (1).
#include <optional>

#include "counterflex/statics/chain.hpp"

namespace counterflex {

/// Chains in equilibrium whose ends are held. Their F are the wrenches that hold them.
struct HeldPlatform {
  Status status = Status::not_converged;
  std::size_t chain = 0;  ///< the first that has no solution, where `status` is not converged
  Configuration configuration;
};

/// (1): F_i = f_i(t given t0), each chain by (2) with its end at `X_MP`. The actuators are those of `nominal`. Errors,
/// preloads, weights and the motion from the nominal pose to `X_MP` grow together, in four steps or more. `singular`: a chain
/// has no stiffness of its own, so that some end poses cannot be held.
HeldPlatform hold_platform(const Model& model, const Configuration& nominal, const Pose& X_MP, const Stage& goal,
                           StaticsWork& work);

/// Sum of the chains' wrenches (N, N m; axes of M): what must act at the reference point to hold it.
Vector6 holding_wrench(const Configuration& configuration);

/// The same at the tool tip.
Vector6 holding_wrench_at_tip(const Mechanism& mechanism, const Configuration& configuration);

}  // namespace counterflex
