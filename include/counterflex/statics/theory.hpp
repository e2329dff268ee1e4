#pragma once
/// The paper's own schemes, the checks on `solve_target`: the linear theory of non-perfect chains (10)-(16),
/// one step from the perfect nominal configuration; and the nested iteration, outer (23), inner (20)-(21),
/// chains by (2).
#include <optional>
#include <vector>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// First-order state of the machine:
///
///     dt = (sum K_i)^-1 (F + sum K_i eps_i + preload and weight wrenches)      F_i = K_i (dt - eps_i)
///     theta_i = K_Ctheta,i dt_i
///
/// with `eps_i` the first-order displacement of a chain's unloaded end by its errors (groups condensed) and
/// K_i its stiffness without Hessians, both at the nominal configuration. Source: Klimchik, Pashkevich,
/// Chablat, eqs. (10)-(16), with the corrections of src/statics/EQUATIONS.md, "Where the print misleads".
struct LinearResult {
  Status status = Status::not_converged;  ///< converged or singular
  Vector6 dt_P = Vector6::Zero();         ///< at the reference point (m, rad; axes of M)
  Vector6 dt_T = Vector6::Zero();         ///< the same motion at the tool tip
  Configuration configuration;  ///< nominal plus the linear joint and spring coordinates and wrenches
};
LinearResult linear_deviation(const Model& model, const Configuration& nominal, const Load& load,
                              const Stage& stage, StaticsWork& work);

/// (14): the first-order displacement of every chain's unloaded end by its errors, at the reference point of
/// the nominal configuration (m, rad; axes of M). Groups are condensed: a motion of a group's end that its
/// branches do not resist stays zero. Empty for a chain with a group whose branches have no stiffness of
/// their own.
std::vector<std::optional<Vector6>> chain_eps(const Model& model, const Configuration& nominal,
                                              StaticsWork& work);

/// The linear target: `X_MT` with `dt_T` taken from its controlled components.
Pose linear_target(const Model& model, const Pose& X_MT, const LinearResult& linear);

/// Target correction by (23): t0F <- t0F - alpha (t - t0), alpha = 1, halved when the error grows; t by
/// (20)-(21) with the loaded stiffness (3), each chain by (2) without Hessians. Every level is solved to the
/// residual of `solve_target`. `nominal` is at `X_MT`. A machine with a chain that has no stiffness of
/// its own takes `solve_forward`'s steps inside.
Equilibrium solve_target_nested(const Model& model, const Configuration& nominal, const Pose& X_MT,
                                const Load& load, const Stage& goal, StaticsWork& work);

}  // namespace counterflex
