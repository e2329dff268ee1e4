#pragma once
/// What is known of a parameter before a fit.
#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/parameters.hpp"

namespace counterflex {

/// SI. A parameter with the deviation 0 is held.
struct PriorDeviation {
  double sigma = 0;
  bool is_default = false;  ///< the machine file states none
};
PriorDeviation prior_deviation(const Machine& machine, const Parameter& parameter);

}  // namespace counterflex
