#pragma once
/// Result of `check` for one file: a page of text, and a JSON object.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"
#include "run/inputs.hpp"

namespace counterflex::cli {

struct Checked {
  std::string text;
  std::string sanity;  ///< the block of its checks, with ANSI sequences where the terminal has colours
  nlohmann::ordered_json json;
  std::optional<ErrorKind> error_kind{};  ///< none: no error was found
};

/// Checks a machine file. Throws `InputError` if it cannot be read, or if its home is not a valid start.
Checked check_machine(const std::string& path, const Options& options, Console& console);

/// Checks a program and, with a `machine`, whether the machine reaches its points. Throws `InputError`.
Checked check_program(const std::string& path, const Options& options, const MachineInput* machine,
                      Console& console);

/// Adds the sanity block of `machine`; a wrong check is an error (ErrorKind::machine_or_force).
void add_sanity(const SanityChecks& checks, const Machine& machine, Checked& checked, Console& console);

/// A line of a page: a label and its text.
std::string row(std::string_view label, std::string_view text);

}  // namespace counterflex::cli
