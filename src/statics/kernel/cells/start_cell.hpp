#pragma once
/// Starts of the kernel that depend on the place alone. EQUATIONS.md, section 11.
#include <optional>

#include "statics/kernel/batch.hpp"
#include "statics/kernel/machine/flatten.hpp"

namespace counterflex::kernel {

/// For waypoints that begin in cells: one tangent, with the stress of the cell, does for the steps behind it;
/// late steps have their own. What needs more steps is left to the continuation of single waypoints.
inline constexpr Schedule cell_schedule{
    .tangents = 1U | ~0U << 5, .most = 12, .first = FirstStress::of_cells};

/// Where a cell is made.
struct CellPlace {
  Matrix3 R;           ///< orientation of the tip, where it is controlled
  bool turns = false;  ///< whether it is
  Vector3 centre;      ///< position of the tip (m)
  double step = 0;     ///< half of the cell's edge: distance of the samples (m)
};

/// The cell of nominal kinematics. `start`: a state of the nominal machine at the centre. None where a
/// sample is not solved.
std::optional<StartCell> make_kinematics_cell(const Question& nominal, const CellPlace& place,
                                              const std::vector<double>& start);

/// The cell of a real machine whose tip is wanted at a place, with its loads, pivots and offsets to the
/// command. `start`: a state of the real machine near that at the centre; `kinematics`: the cell of nominal
/// kinematics there. None where a sample is not solved.
std::optional<StartCell> make_target_cell(const Question& real, const Question& nominal,
                                          const CellPlace& place, const std::vector<double>& start,
                                          const StartCell& kinematics);

/// From a tip at `p` (m), turned against the cell's centre by the rotation vector `turn` (rad), under the
/// load `F` (N, N m) to the command, by the expansion of a target's cell: position (m), and the rotation
/// vector of R_command R_tip'.
Vector6 command_offset(const StartCell& cell, const Vector3& p, const Vector3& turn, const Vector6& F);

}  // namespace counterflex::kernel
