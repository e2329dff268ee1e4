#pragma once
/// What flags, environment and files say together.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

using Layers = std::vector<std::vector<Setting>>;

/// What `command` has of `layers`, the strongest first, in the order of the table of options. An option is
/// taken wholly from the strongest layer that has it: lists do not add up. Forces of files and constant ones
/// are one thing in this, and so are tool tables and lengths: `--force` hides the `forces` of a project
/// file.
std::vector<Setting> effective_settings(Command command, const Layers& layers);

/// Flags, environment and project file of one program; the project file's path where there is one.
struct ProgramLayers {
  Layers layers;
  std::string project_file;
};
ProgramLayers layers_of(const SettingSources& sources, const std::string& program);

/// Gives `options`, which say command and programs, what `layers` say; where these are silent the built-in
/// values stay. Throws `InputError` at the place of a value that is not allowed.
Options with_settings(Options options, const Layers& layers);

/// Throws `InputError` (Exit::usage) where the command needs a machine and nobody has named one.
void refuse_no_machine(const Options& options);

/// What is in force, and what is built in where nothing is said, as a project file that gives the same
/// options; each with its origin.
std::string config_text(Command command, const Layers& layers);

/// The options of one program, ready to run: `with_settings` and a machine.
Options options_of(Command command, const Layers& layers, const std::string& program);

}  // namespace counterflex::cli
