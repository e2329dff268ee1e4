#pragma once
/// Orientations of the nominal tool along a program, with which the forces of a run are computed.
#include <vector>

#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// Orientations of the tool in M on the path of a window, as `PathForces` takes them: one for all if every
/// move has home's; else as many for each segment, at equal fractions. A place that the machine does not
/// reach has home's.
std::vector<Matrix3> tool_orientations(const RunInput& input, const Program& window, const Toolpath& path);

/// The same at the hole of each move that `drills`, in order.
std::vector<Matrix3> tool_orientations_at_holes(const RunInput& input, const Program& window);

}  // namespace counterflex
