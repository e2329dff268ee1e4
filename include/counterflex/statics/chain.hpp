#pragma once
/// Single chains: the equilibrium at a given end pose (2) and the loaded stiffness (3)-(5), the platform held
/// at a pose (1), loads in joints and springs, and everything that is known of each chain at an equilibrium.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/machine/machine.hpp"
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
/// `state` is the start (a nominal configuration's, or a neighbour's; actuators are held) and becomes the
/// solution; its F is the wrench that the platform exerts on the end (N, N m, at P's origin, axes of M). Does
/// not throw; allocates nothing once `work` exists, unless a branch has no stiffness of its own. Source:
/// Klimchik, Pashkevich, Chablat, eq. (2).
ChainEquilibrium solve_chain(const Model& model, std::size_t i, const Pose& X_MP, const Stage& stage,
                             ChainMethod method, SeriesState& state, StaticsWork& work);

/// Loaded stiffness of a chain in equilibrium. K_C maps a spatial twist of P (m, rad; axes of M) to the
/// change of the chain's wrench (3); K_Cq and K_Ctheta map it to the steps of passive joints (4) and of
/// elastic coordinates (5), in the order of the chain's columns; those of groups' branches are not listed.
/// `available` is false where the chain has no stiffness of its own.
struct ChainStiffness {
  Matrix6 K_C = Matrix6::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 6> K_Cq, K_Ctheta;
  bool available = true;
};
ChainStiffness chain_stiffness(const Model& model, std::size_t i, const SeriesState& state,
                               const Stage& stage, StaticsWork& work);

/// Elastic energy of a series (J): springs, compliances, passive joints with springs, groups' branches.
double elastic_energy(const Series& series, const SeriesState& state, const Stage& stage);

/// Spatial twist of the end per column of the chain (6 x columns; m, rad, axes of M), at P's origin.
Eigen::MatrixXd chain_jacobian(const Model& model, std::size_t i, const SeriesState& state,
                               const Stage& stage, StaticsWork& work);

/// d(J' F)/dx with J geometric and F held (columns x columns), the Hessian of (3)-(5), for the wrench of
/// `state`, less the second derivatives of the weights' energy.
Eigen::MatrixXd chain_hessian(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
                              StaticsWork& work);

/// Pose of the chain's end in M.
Pose chain_end(const Model& model, std::size_t i, const SeriesState& state, const Stage& stage,
               StaticsWork& work);

/// Chains in equilibrium whose ends are held. Their F are the wrenches that hold them.
struct HeldPlatform {
  Status status = Status::not_converged;
  std::size_t chain = 0;  ///< the first that has no solution, where `status` is not converged
  Configuration configuration;
};

/// (1): F_i = f_i(t given t0), each chain by (2) with its end at `X_MP`. The actuators are those of
/// `nominal`. Errors, preloads, weights and the motion from the nominal pose to `X_MP` grow together, in four
/// steps or more. `singular`: a chain has no stiffness of its own, so that some end poses cannot be held.
HeldPlatform hold_platform(const Model& model, const Configuration& nominal, const Pose& X_MP,
                           const Stage& goal, StaticsWork& work);

/// Sum of the chains' wrenches (N, N m; axes of M): what must act at the reference point to hold it.
Vector6 holding_wrench(const Configuration& configuration);

/// The same at the tool tip.
Vector6 holding_wrench_at_tip(const Mechanism& mechanism, const Configuration& configuration);

/// Of one chain. Springs and compliances in their own frames, theta and K (theta - theta_0); what a group
/// transmits (the moment at its end) in the frame of its first branch's first spring, the paper's tau_phi;
/// passive revolute joints by their change from the nominal configuration. SI.
struct ChainLoads {
  std::string name;
  /// Exerted by the platform and the tool on it on the chain's end, at the reference point, axes of M.
  Vector6 wrench = Vector6::Zero();
  std::array<double, load_kind_count> largest{};

  double& operator[](LoadKind kind) { return largest[static_cast<std::size_t>(kind)]; }
  double operator[](LoadKind kind) const { return largest[static_cast<std::size_t>(kind)]; }
};

/// Of every chain of the machine that `base` is without a tool, at a configuration of `model`, the same
/// machine with one: a tool that bends has no load here, and chains that it has made the branches of one
/// chain (`with_tool`) are chains again. The wrenches on their ends refer to `base`'s reference point, at its
/// position in the deflected machine.
std::vector<ChainLoads> loads(const Mechanism& base, const Model& model, const Configuration& configuration);

/// One coordinate: a joint, a compliance, or one component of a spring. SI.
struct CoordinateDetail {
  /// Its number in the chain, "7/upper_bar/4" in the fourth place of a branch; masses not counted.
  std::string element;
  PartKind kind = PartKind::passive;
  int component = -1;  ///< of a spring, 0 to 5: x y z rx ry rz; else -1
  bool angular = false;
  double value = 0;   ///< m, rad; a spring's theta with its preload
  double change = 0;  ///< from the nominal configuration
  double load = 0;    ///< N, N m: dE/dx, K (theta - theta_0) of a spring; zero for an actuator
};

struct ChainDetail {
  std::string name;
  /// Of the platform on the chain's end, at its origin, axes of M. The tool's mass belongs to the first
  /// chain.
  Vector6 wrench = Vector6::Zero();
  ChainStiffness stiffness;                   ///< (3)-(5)
  std::vector<std::size_t> passive;           ///< by row of K_Cq: index into `coordinates`
  std::vector<std::size_t> elastic;           ///< by row of K_Ctheta
  std::optional<Vector6> eps;                 ///< of (14), first order; see `chain_eps`
  std::optional<Vector6> dt;                  ///< (14): motion of the platform less eps
  double energy = 0;                          ///< (12), J: of springs, compliances and sprung joints
  std::vector<CoordinateDetail> coordinates;  ///< in the order of elements; a group's branches at its place
};

/// Where stiffness is taken: at the equilibrium itself, or for the linear theory at the nominal
/// configuration.
struct StiffnessPlace {
  const Configuration& configuration;
  Stage stage;
};

/// Details of every chain of `model`; a tool that bends is part of the chain to whose end it is attached.
/// `dt_P` is the motion of the reference point from the nominal configuration (m, rad; axes of M).
std::vector<ChainDetail> chain_details(const Model& model, const Configuration& nominal,
                                       const Configuration& loaded, const Vector6& dt_P,
                                       const StiffnessPlace& stiff, StaticsWork& work);

}  // namespace counterflex
