#pragma once
/// Reads the command line. Only this file and the tables of options use CLI11.
#include <variant>

#include "counterflex/files/input_error.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// The options, or the exit status if there is nothing to run: help, version or an error of the command line
/// has been printed.
std::variant<Options, Exit> read_command_line(int argc, const char* const* argv);

}  // namespace counterflex::cli
