#pragma once
/// Follows the directions of actuators along the path of a window.
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// Follows the path of `job` from `end`, and sets `end` to where it ends. To the first place that the nominal
/// machine does not reach. Nothing for a machine without reversals.
PathDirections directions_along(const Job& job, DirectionsEnd& end);

/// Sets the directions that are not known in `first` to those of the first motions in `path`.
void add_first_motions(const PathDirections& path, Directions& first);

}  // namespace counterflex
