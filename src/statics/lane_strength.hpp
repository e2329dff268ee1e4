#pragma once
/// Which loads a zone bears: at the places that speak for it, equilibria under the corners of a polytope of loads are found in
/// lanes and judged. EQUATIONS.md, section 11.
#include <vector>

#include "lane_zone.hpp"

namespace counterflex {

/// The octahedron that holds every force up to `force` (N) together with every moment up to `moment` (N m; 0: none), with a
/// margin: its corners.
std::vector<Load> corners_of_loads(double force, double moment, bool at_platform);

/// Whether the machine is stable under every one of `loads` at the zone's centre and the corners of its cube, and well
/// conditioned at the centre and wherever a certificate does not prove it stable. Unloaded it is followed from the nominal configuration to the centre.
bool bears_everywhere(const Model& model, const LaneModel& lane_model, const LaneZone& zone, const std::vector<Load>& loads,
                      lanes::Acting acting, StaticsWork& work);

}  // namespace counterflex
