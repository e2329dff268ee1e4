#pragma once
/// The largest loads of a run as a part of its report's document.
#include "counterflex/report/path_curves.hpp"
#include "json_numbers.hpp"

namespace counterflex {

/// How many places were solved and how many were not; for every chain and kind of load the largest, its line
/// and its limit, or null, with ten significant digits. Null where there are no loads.
Json largest_loads_json(const std::optional<PathLoads>& loads);

}  // namespace counterflex
