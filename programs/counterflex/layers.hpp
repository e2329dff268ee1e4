#pragma once
/// What flags, environment and files say together.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/settings/setting.hpp"
#include "options.hpp"

namespace counterflex::cli {

using Layers = std::vector<std::vector<Setting>>;

/// What `command` has of `layers`, the strongest first, in the order of the table of options. An option is
/// taken wholly from the strongest layer that has it: lists do not add up. Forces of files and constant ones
/// are one thing in this, and so are tool tables and lengths: `--force` hides the `forces` of a project
/// file. Of outputs the strongest folder goes with the strongest name.
std::vector<Setting> effective_settings(Command command, const Layers& layers);

/// Gives `options`, which say command and programs, what `layers` say; where these are silent the built-in
/// values stay. Throws `InputError` at the place of a value that is not allowed.
Options with_settings(Options options, const Layers& layers);

/// Throws `InputError` (Exit::usage) where the command needs a machine and nobody has named one.
void refuse_no_machine(const Options& options);

/// The options of one program, ready to run: `with_settings` and a machine.
Options options_of(Command command, const Layers& layers, const std::string& program);

/// Where settings come from besides jobs files.
struct SettingSources {
  std::vector<Setting> flags, environment;
  std::optional<std::string> config;  ///< the project file that --config names
  bool no_config = false;
};

/// The path of the project file of `program`; nothing where there is none, or none is wanted.
std::optional<std::string> project_file_of(const SettingSources& sources, const std::string& program);

/// The settings of a project file; none without one. Throws `InputError` (Exit::machine_or_force).
std::vector<Setting> read_project_file(const std::optional<std::string>& file);

}  // namespace counterflex::cli
