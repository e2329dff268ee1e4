#pragma once
/// The wrench of each feed move as its rule gives it, before the mean over the path is taken.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex {

/// From path length s (m) on: a wrench in the feed frame (N, N m).
struct ForceStep {
  double s = 0;
  Vector6 F = Vector6::Zero();
};

/// A feed move and the wrench in its middle.
struct MoveForce {
  int line = 0;
  long tool = 0;       ///< 0: none known
  double s_start = 0;  ///< cutting path length at its start (m)
  double length = 0;   ///< m
  double feed_m_s = 0;
  double spindle_rpm = 0;        ///< the model's own where one acts, else the program's
  double feed_per_tooth = 0;     ///< m; 0: no cutting model acts
  Vector6 F = Vector6::Zero();   ///< on the tool, scaled, axes of the feed frame (N, N m)
  bool only_z = false;           ///< the feed is parallel to the tool: of F only what is along it is known
  bool comment = false;          ///< the program's FORCE comment covers it
  bool comment_altered = false;  ///< and the scale, or a bound of the air, makes another force of its own
  bool changes = false;          ///< the wrench is not the same all along the move: `F` is that in the middle
  double largest_N = 0;          ///< of the force anywhere on the move
  std::vector<ForceStep> steps;  ///< what acts, from the start on; none where it changes between steps
  std::string why;               ///< empty: F acts; else why there is none
};

/// The feed moves of a window that is not the first: `block_number` is N of the moves before, and then of
/// these. `R_MT` as for `PathForces`; `source` has been settled by `ForceCover`. Throws `InputError` as
/// `PathForces` does.
std::vector<MoveForce> move_forces(const ForceSource& source, const Program& window, const Toolpath& path,
                                   const std::vector<Matrix3>& R_MT, std::optional<long>& block_number);

}  // namespace counterflex
