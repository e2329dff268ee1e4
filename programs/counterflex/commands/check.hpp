#pragma once
/// What `check` finds in one file: a page for people, an object for programs.
#include <nlohmann/json.hpp>
#include <string>

#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"
#include "run/inputs.hpp"

namespace counterflex::cli {

struct Checked {
  std::string text;
  std::string sanity;  ///< the block of its checks, with ANSI sequences where the terminal has colours
  nlohmann::ordered_json json;
  Exit exit = Exit::done;
};

/// A machine file. Throws `InputError` where it cannot be read, or where its home is not fit to start from.
Checked check_machine(const std::string& path, const Options& options, Console& console);

/// A program, and where there is a `machine`, whether it reaches the program's points. Throws `InputError`.
Checked check_program(const std::string& path, const Options& options, const MachineInput* machine,
                      Console& console);

/// Adds the sanity block of `machine`; a wrong check is an error (Exit::machine_or_force).
void add_sanity(const SanityChecks& checks, const Machine& machine, Checked& checked, Console& console);

/// A line of a page: a word, and what is said about it.
std::string row(std::string_view what, std::string_view said);

}  // namespace counterflex::cli
