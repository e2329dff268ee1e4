#pragma once
/// Reads the command line. Only this file and the tables of options use CLI11.
#include <optional>
#include <variant>

#include "counterflex/files/input_error.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// The options. If there is nothing to run, because help, the version or an error of the command line has
/// been printed: the kind of error, or none.
std::variant<Options, std::optional<ErrorKind>> read_command_line(int argc, const char* const* argv);

}  // namespace counterflex::cli
