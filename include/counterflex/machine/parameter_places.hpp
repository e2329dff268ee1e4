#pragma once
/// Where the parameters of a machine are in its elements.
#include <string>
#include <vector>

#include "counterflex/machine/parameters.hpp"

namespace counterflex {

struct ParameterPlace {
  std::string name;
  ParameterKind kind = ParameterKind::position;
  double unit = 1;
  Element* element = nullptr;
  int component = -1;  ///< of an error, a spring with a diagonal stiffness, harmonics, a table; else -1
};

/// In the order of `parameters`. The places point into `machine`.
std::vector<ParameterPlace> parameter_places(Machine& machine);

}  // namespace counterflex
