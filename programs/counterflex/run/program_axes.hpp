#pragma once
/// External axes that a robot program commands: their values, from the program into the machine.
#include <vector>

#include "counterflex/program/overview.hpp"
#include "counterflex/sanity/checks.hpp"
#include "run/inputs.hpp"

namespace counterflex::cli {

/// Puts the actuators with a `program_axis` at the values of `program`, and prepares the model of the machine
/// again. Returns warnings: of axes that the program does not give, and of axes of the program that the
/// machine does not have. Throws `InputError` if external axes move along the program, or if a value is
/// outside its travel.
std::vector<Remark> place_program_axes(const Overview& program, MachineInput& input);

/// The values of the external axes of a placed machine, if it has any.
SanityChecks check_program_axes(const Overview& program, const Machine& machine);

}  // namespace counterflex::cli
