#pragma once
/// How the tool is turned along a path, as far as the frame of the force needs it.
#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// Orientations of the nominal tool in M: one for all where the force's frame does not turn with the tool, or
/// every move has home's; else several a segment, at equal fractions. `path` is that of `window`.
std::vector<Matrix3> tool_orientations(const RunInput& input, const Program& window, const Toolpath& path);

/// The same at the hole of each move that `drills`, in order.
std::vector<Matrix3> tool_orientations_at_holes(const RunInput& input, const Program& window);

}  // namespace counterflex
