#pragma once
/// The largest loads of a run as a part of its JSON report.
#include "counterflex/report/path_curves.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {

/// Numbers of solved and unsolved places; for every chain and kind of load the largest value, its line and
/// its limit or null, with ten significant digits. Null without loads.
Json largest_loads_json(const std::optional<PathLoads>& loads);

}  // namespace counterflex
