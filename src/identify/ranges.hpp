#pragma once
/// Errors that depend on the place of an actuator are known only where it was measured.
#include <optional>
#include <vector>

#include "identify/hold_out.hpp"

namespace counterflex {

/// Whether a set has errors of motion as functions of the actuators' values.
bool depends_on_place(ParameterSet set);

/// The group that takes an actuator of the set farthest beyond its range in the other rows, if that is more
/// than a tenth of this range. None for sets that do not depend on the place.
std::optional<LeftRange> left_range(const FitProblem& problem, const std::vector<RowGroup>& groups,
                                    ParameterSet set);

}  // namespace counterflex
