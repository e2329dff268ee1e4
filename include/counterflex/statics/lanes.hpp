#pragma once
/// Waypoints solved several at once, one a lane of a vector register: the same equilibria as those of `solve_forward` and
/// `solve_target`, to the same residuals, where the machine is known to be stable and well conditioned. A yes is the
/// promise that these would say `converged`; a no says nothing, they decide. For machines whose tip is controlled in x, y and
/// z; others get a no for everything. EQUATIONS.md, section 11, tells what is proven and what is sampled.
#include <functional>
#include <memory>
#include <span>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// A position of the tip (M, m), and the wrench there (N, N m; axes of M).
struct LaneRequest {
  Vector3 p = Vector3::Zero();
  Vector6 F = Vector6::Zero();
};

/// Forward: where the tip stands when `p` is commanded. Target: what has to be commanded for the tip to be at `p`. Orientations
/// that the machine controls are commanded as at home.
enum class LaneQuestion { forward, target };

struct LaneAnswer {
  bool solved = false;  ///< converged, stable, on the branch of home, actuators in their ranges; else the rest means nothing
  Vector3 command = Vector3::Zero();  ///< commanded position of the nominal tip, M (m)
  Pose X_MT;                          ///< of the real tip
  int iterations = 0;                 ///< steps taken
};

/// What a waypoint is asked in one go: where the tip stands at the position that the original program commands, what has to
/// be commanded for it to be at the wanted one, and where it stands when what is written of that is commanded.
struct LaneThrough {
  LaneAnswer before, target, after;
};

/// The position that will really be commanded for a target that is to be commanded by request `i` (M, m); no number where
/// that is not known. Called for targets that converged, in the order of requests; answers under loads that are not borne are
/// withdrawn afterwards.
using LaneWritten = std::function<Vector3(std::size_t i, const Vector3& command)>;

/// What lanes need to know of a machine, found where waypoints are and kept. Shared by threads; what is found for a place
/// does not depend on who asked first. `model` outlives it.
class LaneMachine {
 public:
  /// `at_platform`: where loads act, as in `Load`; `reach`: largest distance from wanted to commanded position (m): targets
  /// that need more are not solved.
  LaneMachine(const Model& model, bool at_platform, double reach);
  ~LaneMachine();

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The lane machines of a run: one for each model and place of loads, made when it is asked for. Models outlive it and stay
/// where they are. Threads may share it.
class LaneMachines {
 public:
  explicit LaneMachines(double reach);
  ~LaneMachines();
  LaneMachines(LaneMachines&&) noexcept;

  const LaneMachine& of(const Model& model, bool at_platform) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The name of the instructions that lanes use on this computer.
const char* lane_instructions();

/// Solves for one thread. Answers depend on the requests of a call and their order alone,
/// and in their last bits on whether the computer fuses multiply-adds.
class LaneSolver {
 public:
  explicit LaneSolver(const LaneMachine& machine);
  ~LaneSolver();
  LaneSolver(LaneSolver&&) noexcept;

  /// `stage`: nothing is solved where a part of errors or gravity acts, or not all of the preloads. Its load is not looked at:
  /// F acts. `answers` is as long as `requests`; neighbours should stand beside each other, they are solved together. A
  /// request that is no number is not solved.
  void solve(LaneQuestion question, const Stage& stage, std::span<const LaneRequest> requests, std::span<LaneAnswer> answers);

  /// The tip is wanted at the positions of `requests`; `originals` are what the original program commands there (M, m), as
  /// many. Everything acts. Each answer is one to a question of its own, with the promises of `solve`; that one begins where the
  /// one before it has ended is what it saves. Without a target `after` is not solved.
  void solve_through(std::span<const LaneRequest> requests, std::span<const Vector3> originals, const LaneWritten& written,
                     std::span<LaneThrough> answers);

  /// Pose of the nominal tip at a position, on the branch of home; false where it is not known.
  bool nominal_tip(const Vector3& p, Pose& X_MT);

  /// The actuator values of that (m, rad); false where they are not known.
  bool nominal_actuators(const Vector3& p, Eigen::VectorXd& rho);

  /// A nominal configuration on the branch of home, not far from `p` (that of its zone's centre); null where none is known.
  /// It stands until the next call.
  const Configuration* nominal_near(const Vector3& p);

  /// Whether the straight way between two positions is known to stay on one branch: neighbouring zones agree, along a
  /// longer way the nominal machine is followed. No where one of them is not known.
  bool joins(const Vector3& from, const Vector3& to);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace counterflex
