#pragma once
/// One chain on its own: its equilibrium at a given end pose (2) and its loaded stiffness (3)-(5).
#include <vector>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

struct ChainEquilibrium {
  Status status = Status::not_converged;  ///< converged, not_converged, or singular: rank [J_q J_theta] < 6
  int iterations = 0;
};

/// How a chain is iterated: the paper's (2), or (2) with the Hessians of (3)-(5) added (Newton's method).
enum class ChainMethod { paper, newton };

/// Equilibrium of chain `i` whose end is held at `X_MP`:
///
///     J_q' F = dE/dq      J_theta' F = K_theta (theta - theta_0)      g(q, theta) = X_MP          (2)
///
/// `state` is the start (a nominal configuration's, or a neighbour's; actuators are held) and becomes the solution; its F
/// is the wrench that the platform exerts on the end (N, N m, at P's origin, axes of M). Does not throw; allocates nothing
/// once `work` exists. Source: Klimchik, Pashkevich, Chablat, eq. (2).
ChainEquilibrium solve_chain(const Model& model, std::size_t i, const Pose& X_MP, const Stage& stage, ChainMethod method,
                             SeriesState& state, StaticsWork& work);

/// Loaded stiffness of a chain in equilibrium. K_C maps a spatial twist of P (m, rad; axes of M) to the change of the
/// chain's wrench (3); K_Cq and K_Ctheta map it to the steps of passive joints (4) and of elastic coordinates (5), in the
/// order of the chain's columns; those of groups' branches are not listed. `available` is false where the chain has no
/// stiffness of its own.
struct ChainStiffness {
  Matrix6 K_C = Matrix6::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 6> K_Cq, K_Ctheta;
  bool available = true;
};
ChainStiffness chain_stiffness(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
                               StaticsWork& work);

/// Elastic energy of a series (J): springs, compliances, passive joints with springs, groups' branches.
double elastic_energy(const Series& series, const SeriesState& state, const Stage& stage);

/// Energy of the weights of a series (J), zero where its start frame is: -sum m g . p. `g` (m/s2) in axes of that frame.
double weight_energy(const Series& series, const SeriesState& state, const Stage& stage, const Vector3& g);

/// Spatial twist of the end per column of the chain (6 x columns; m, rad, axes of M), at P's origin.
Eigen::MatrixXd chain_jacobian(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
                               StaticsWork& work);

/// d(J' F)/dx with J geometric and F held (columns x columns), the Hessian of (3)-(5), for the wrench of `state`, less
/// the second derivatives of the weights' energy.
Eigen::MatrixXd chain_hessian(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
                              StaticsWork& work);

/// Pose of the chain's end in M.
Pose chain_end(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage, StaticsWork& work);

}  // namespace counterflex
