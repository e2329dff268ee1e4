#pragma once
/// Waypoints as bytes, all of their bits, in a fifth of the room that they have in memory or less.
#include <string>
#include <vector>

#include "counterflex/compensation/waypoint.hpp"

namespace counterflex {

void put_waypoints(const std::vector<Waypoint>& waypoints, std::string& bytes);
std::vector<Waypoint> get_waypoints(class BytesIn& bytes);

}  // namespace counterflex
