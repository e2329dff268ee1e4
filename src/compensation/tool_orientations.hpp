#pragma once
/// How the tool stands along a path, as far as the frame of the force needs it.
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// Orientations of the nominal tool in M: one for all where the force's frame does not turn with the tool, or
/// every move has home's; else several a segment, at equal fractions. `nominal` is the machine's
/// configuration near the path's start, and then near its end.
std::vector<Matrix3> tool_orientations(const Model& model, const Toolpath& path, const ForceSource& source,
                                       Configuration& nominal);

}  // namespace counterflex
