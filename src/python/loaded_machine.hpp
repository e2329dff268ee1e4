#pragma once
/// What the objects of the Python module hold.
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <string_view>

#include "counterflex/statics/batch_solver.hpp"
#include "run/inputs.hpp"

namespace counterflex::python {

/// A machine with its model. Nothing of it changes; threads may share it.
struct LoadedMachine {
  cli::MachineInput input;
  std::string text;  ///< of its file; empty for a machine with other parameters
  StartTables starts{};
};

/// Throws `InputError` for a machine without a valid home.
std::unique_ptr<LoadedMachine> load(Machine machine, InputFile file, std::string text);

/// The machine of the text of a machine file; `path` names it.
std::unique_ptr<LoadedMachine> load_text(std::string text, const std::string& path);

/// Any bytes as a str: those that are not UTF-8 as Python keeps them in names of files.
pybind11::str to_str(std::string_view bytes);

void define_runs(pybind11::module_& module);

}  // namespace counterflex::python
