#pragma once
/// Names of the columns of actuators in a sheet's table of places. `i` counts from 0, the names from 1.
#include <fmt/format.h>

#include <string>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// The value that the control shows.
inline std::string value_column(const Actuator& actuator, std::size_t i) {
  return fmt::format("q{}_{}", i + 1, actuator.joint.kind == JointKind::revolute ? "deg" : "mm");
}

/// The direction of the last motion: 1, -1, or 0 where it is not known. Only actuators with a lost motion
/// have this column.
inline std::string direction_column(std::size_t i) {
  return fmt::format("d{}", i + 1);
}

}  // namespace counterflex
