#pragma once
/// Reads the command line. The only place that knows the library for it.
#include <variant>

#include "counterflex/files/input_error.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// What was asked for, or the status to leave with at once: help and version have been printed, or what is
/// wrong with the command line.
std::variant<Options, Exit> read_command_line(int argc, const char* const* argv);

}  // namespace counterflex::cli
