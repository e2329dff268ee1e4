#pragma once
/// The elements of a chain, one in each line.
#include <string>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// The numbered actuators of a machine while its elements are described.
struct ActuatorNumbers {
  Eigen::VectorXd shown_homes;  ///< of all
  int last = 0;                 ///< number of the previous one
};

/// Appends one indented line for each element to `text`, with deeper indentation for branches.
void describe_elements(const std::vector<Element>& elements, int indent, ActuatorNumbers& numbers,
                       std::string& text);

}  // namespace counterflex
