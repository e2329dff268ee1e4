#pragma once
/// External axes that the program commands: a rail under the robot.
#include <array>
#include <optional>
#include <vector>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// Values of E1 to E6 in mm or deg; none: the program does not give the axis.
using ProgramAxisValues = std::array<std::optional<double>, 6>;

/// The actuators with a `program_axis`, in the order of chains and elements.
std::vector<Actuator> program_axes(const Machine& machine);

/// The machine with these actuators at the given values. Axes without a value stay at home.
Machine at_program_axes(const Machine& machine, const ProgramAxisValues& values);

}  // namespace counterflex
