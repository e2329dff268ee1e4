#pragma once
/// From waypoints to numbers, in one pass.
#include <vector>

#include "counterflex/report/report.hpp"

namespace counterflex {

struct Measures {
  DeviationTally before, after, geometry, load, superposition;
  Largest air, correction;
  double largest_N = 0, largest_Nm = 0;
  double path_mm = 0;
  std::vector<WorstRow> by_line;     ///< lines with feed moves, ascending
  std::size_t segments_changed = 0;  ///< feed moves and rapids whose target is not the original one
};

/// Waypoints that were not solved are passed over. Feed moves alone, but for `correction` and
/// `segments_changed`.
Measures measure(const std::vector<Waypoint>& waypoints);

}  // namespace counterflex
