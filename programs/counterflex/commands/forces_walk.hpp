#pragma once
/// Goes through the feed moves of a program and their forces.
#include <functional>
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "process/console.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// Called once, with the name of the program. May change the contents of the rules.
using BeginWalk = std::function<void(const std::string& program, ForceSource& source)>;
/// Called for each window with its path and the forces of its feed moves; `source` outlives the walk's calls.
using TakeWindow = std::function<void(const ForceSource& source, const Program& window, const Toolpath& path,
                                      const std::vector<MoveForce>& moves)>;

/// Reads program and forces of `options`, with or without a machine. Throws `InputError`.
void walk_forces(const Options& options, Console& console, const BeginWalk& begin, const TakeWindow& take);

}  // namespace counterflex::cli
