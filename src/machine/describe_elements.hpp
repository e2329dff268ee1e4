#pragma once
/// A chain's elements, one a line.
#include <string>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// Appends one line an element to `text`, indented; branches of groups deeper. `actuator` is the number of
/// the last actuator before, and is counted on.
void describe_elements(const std::vector<Element>& elements, int indent, int& actuator, std::string& text);

}  // namespace counterflex
