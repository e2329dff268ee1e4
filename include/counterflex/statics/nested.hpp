#pragma once
/// The paper's own scheme: outer (23), inner (20)-(21), chains by (2). Slower than `solve_target`, and the check on it.
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// Target correction by (23): t0F <- t0F - alpha (t - t0), alpha = 1, halved when the error grows; t by (20)-(21) with the
/// loaded stiffness (3), each chain by (2) without Hessians. Every level is solved to the residual of `solve_target`.
/// `nominal` stands at `X_MT`. A machine with a chain that has no stiffness of its own takes `solve_forward`'s steps inside.
Equilibrium solve_target_nested(const Model& model, const Configuration& nominal, const Pose& X_MT, const Load& load,
                                const Stage& goal, StaticsWork& work);

}  // namespace counterflex
