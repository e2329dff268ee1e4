#pragma once
/// Where a program takes the machine.
#include <optional>
#include <vector>

#include "counterflex/identify/next_measurements.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Places of the feed moves and of the holes of `options.program` on `machine`, some hundred at most, with
/// the force of the options there. A hole weighs as much as a feed move of its depth. A failure if one of
/// them cannot be solved. Throws `InputError`, also if no place has a weight.
std::optional<Failure> find_program_places(const Options& options, MachineInput machine, Console& console,
                                           std::vector<ProgramPlace>& places);

}  // namespace counterflex::cli
