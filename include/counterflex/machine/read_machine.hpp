#pragma once
/// Reads `machine.toml`, format "counterflex-machine 1".
#include <string>
#include <string_view>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// The machine that `text` describes. `file` names it in diagnostics. Throws `InputError`
/// (Exit::machine_or_force), with line and column, on bad TOML, a key that the format does not know, a value
/// out of its range, a name that is not defined, or a count of controlled components that is neither zero nor
/// that of the actuators.
Machine read_machine(std::string_view text, const std::string& file);

/// The same, from a file. Throws `InputError` where it cannot be read.
Machine load_machine(const std::string& file);

}  // namespace counterflex
