#pragma once
/// How far a value is from the limits of its travel.
#include <algorithm>
#include <cmath>

#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// The way to the nearer limit (m or rad), negative outside of the travel. A value at a limit, to the
/// rounding of a solution, has none left.
inline double travel_margin(const Travel& travel, double value) {
  constexpr double rounding = 1e-10;  // m, rad: solutions are found to some 1e-12
  const double margin = std::min(value - travel.min, travel.max - value);
  return std::abs(margin) < rounding ? 0 : margin;
}

}  // namespace counterflex
