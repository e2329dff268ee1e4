#pragma once
/// The parts that a comparison is made of.
#include <array>

#include "counterflex/report/comparison.hpp"
#include "json_values.hpp"

namespace counterflex {

using TwoReports = std::array<JsonSource, 2>;

std::vector<ComparedNumber> compared_numbers(const TwoReports& reports);
std::vector<ComparedOperation> compared_operations(const TwoReports& reports);

/// Of tool, command, machine, inputs, options and what was taken for granted.
std::vector<RunDifference> run_differences(const TwoReports& reports);

/// Roles of the inputs that have the same bytes in both.
std::vector<std::string> same_inputs(const TwoReports& reports);

/// What to take home, of a comparison that has all else.
std::string conclusion_of(const Comparison& comparison);

}  // namespace counterflex
