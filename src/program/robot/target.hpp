#pragma once
/// A target of a robot program as it is in the text.
#include <array>
#include <optional>

#include "counterflex/program/program.hpp"
#include "program/robot/line.hpp"

namespace counterflex {

/// The numbers of a target. A language without a number leaves it empty: the robot keeps the last one.
struct RobotTarget {
  std::array<std::optional<RobotNumber>, 3> position;     ///< X, Y, Z; values in mm
  std::array<std::optional<RobotNumber>, 4> orientation;  ///< in the order of the language's OrientationForm
  std::array<std::optional<double>, 6> external;          ///< external axes, in the units of the program
};

}  // namespace counterflex
