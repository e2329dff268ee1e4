#pragma once
/// Waypoints solved several at once, one a lane of a vector register: the same equilibria as `solve_forward` and
/// `solve_target`, to the same residuals, for machines and places where they are known to be stable and well conditioned.
/// What is not solved here says so, and is a matter for these. EQUATIONS.md, section 11.
#include <memory>
#include <span>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// A position of the tip (M, m), and the wrench there (N, N m; axes of M).
struct LaneRequest {
  Vector3 p = Vector3::Zero();
  Vector6 F = Vector6::Zero();
};

/// Forward: where the tip stands when `p` is commanded. Target: what has to be commanded for the tip to be at `p`.
enum class LaneQuestion { forward, target };

struct LaneAnswer {
  bool solved = false;               ///< converged, stable, well conditioned, on the branch of home, actuators in their ranges
  Vector3 command = Vector3::Zero();  ///< position of the nominal tip, M (m)
  Pose X_MT;                         ///< of the real tip
  int iterations = 0;
};

/// What lanes need to know of a machine, found where waypoints are and kept. Shared by threads; what is found for a place
/// does not depend on who asked first. `model` outlives it.
class LaneMachine {
 public:
  /// `at_platform`: where loads act, as in `Load`; `reach`: largest correction that may be asked for (m).
  LaneMachine(const Model& model, bool at_platform, double reach);
  ~LaneMachine();

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The lane machines of a run: one for each model, made when it is asked for.
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

/// Solves for one thread. Answers depend on the requests of a call and their order alone.
class LaneSolver {
 public:
  explicit LaneSolver(const LaneMachine& machine);
  ~LaneSolver();
  LaneSolver(LaneSolver&&) noexcept;

  /// `errors`: whether assembly errors act.
  void solve(LaneQuestion question, bool errors, std::span<const LaneRequest> requests, std::span<LaneAnswer> answers);

  /// Pose of the nominal tip at a position, on the branch of home; false where it is not known.
  bool nominal_tip(const Vector3& p, Pose& X_MT);

  /// A nominal configuration on the branch of home, not far from `p`; null where it is not known. It stands until the next
  /// call.
  const Configuration* nominal_near(const Vector3& p);

  /// Whether the straight way between two positions is known to stay on one branch.
  bool joins(const Vector3& from, const Vector3& to);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace counterflex
