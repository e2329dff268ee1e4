#pragma once
/// The machine as lines, for pictures.
#include <vector>

#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// Points in M (m).
using SkeletonLine = std::vector<Vector3>;

/// The lines of a nominal configuration: one along each chain from the base to the platform, with a point at
/// each frame that a rigid element or a prismatic joint moves. Lines of several chains begin at their first
/// moving element. A line ends at a group; each of its branches has a line of its own. The line of the only
/// chain is continued to the tip, else the tip has a line from the platform. The number of lines, and of the
/// points of each, does not depend on the configuration.
std::vector<SkeletonLine> skeleton(const Mechanism& mechanism, const Configuration& nominal);

}  // namespace counterflex
