#pragma once
/// Starts of the kernel that depend on the place alone. EQUATIONS.md, section 11.
#include <optional>

#include "batch.hpp"
#include "flatten.hpp"

namespace counterflex::kernel {

/// Where a cell is made: the tip's orientation `R` where it is controlled, the cell's centre (m), and the
/// distance of the differences (m).
struct CellPlace {
  Matrix3 R;
  Vector3 centre;
  double step;
};

/// The cell of nominal kinematics. `perfect`: transforms without errors; `start`: a state of the nominal
/// machine at the centre. None where a place about the centre is not solved.
std::optional<StartCell> make_kinematics_cell(const FlatMachine& machine,
                                              const std::vector<Transform>& perfect, const CellPlace& place,
                                              const std::vector<double>& start);

/// The cell of a target question, with what it has to do with loads, pivots and the command. `kinematics`: the
/// cell of nominal kinematics there. None where a place about the centre is not solved.
std::optional<StartCell> make_target_cell(const FlatMachine& machine, const Question& question,
                                          const std::vector<Transform>& perfect, const CellPlace& place,
                                          const StartCell& kinematics);

/// From the wanted tip at `p` (m) under the load `F` (N, N m) to the command, by the expansion of a target's
/// cell (m).
Vector3 command_offset(const StartCell& cell, const Vector3& p, const Vector6& F);

}  // namespace counterflex::kernel
