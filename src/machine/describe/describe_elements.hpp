#pragma once
/// The elements of a chain, one in each line.
#include <string>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// Appends one indented line for each element to `text`, with deeper indentation for branches. `actuator` is
/// the number of the previous actuator, and is increased.
void describe_elements(const std::vector<Element>& elements, int indent, int& actuator, std::string& text);

}  // namespace counterflex
