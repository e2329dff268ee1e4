#pragma once
/// How the tool stands along a path, as far as the frame of the force needs it.
#include "counterflex/compensation/job_windows.hpp"

namespace counterflex {

/// Orientations of the nominal tool in M: one for all where the force's frame does not turn with the tool, or
/// every move has home's; else several a segment, at equal fractions. `nominal` is where the
/// machine stands near the path's start, and then near its end. `path` is that of `window`.
std::vector<Matrix3> tool_orientations(const RunInput& input, const Program& window, const Toolpath& path,
                                       NominalPlace& nominal);

}  // namespace counterflex
