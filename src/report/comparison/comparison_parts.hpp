#pragma once
/// The parts of a comparison.
#include <array>

#include "counterflex/report/comparison.hpp"
#include "report/json/json_values.hpp"

namespace counterflex {

using TwoReports = std::array<JsonSource, 2>;

std::vector<ComparedNumber> compared_numbers(const TwoReports& reports);
std::vector<ComparedOperation> compared_operations(const TwoReports& reports);

/// Differences of tool, command, machine, inputs, options and assumptions.
std::vector<RunDifference> run_differences(const TwoReports& reports);

/// Roles of the inputs with the same bytes in both.
std::vector<std::string> same_inputs(const TwoReports& reports);

/// The conclusion of a comparison whose other parts are complete. `utf8`: with "µm", else with "um".
std::string conclusion_of(const Comparison& comparison, bool utf8);

}  // namespace counterflex
