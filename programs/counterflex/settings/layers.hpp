#pragma once
/// Combines settings of flags, environment and files.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

using Layers = std::vector<std::vector<Setting>>;

/// The settings of `command` in `layers`, in the order of the table of options. The first layer has the
/// highest priority. Options are not merged: the first layer with an option replaces all its values in later
/// layers. `forces` and `force` count as one option here: `--force` replaces the `forces` of a project file.
/// A tool table also replaces tool lengths of later layers, but not the reverse.
std::vector<Setting> effective_settings(Command command, const Layers& layers);

/// Flags, environment and project file of one program, and the path of the project file, if any.
struct ProgramLayers {
  Layers layers;
  std::string project_file;
};
ProgramLayers layers_of(const SettingSources& sources, const std::string& program);

/// Of tables [work] and [tools] that an option of an earlier layer replaces: the names that it does not have.
std::vector<SettingRemark> remarks_on_replaced(Command command, const Layers& layers);

/// Adds the settings of `layers` to `options`, which have the command and the programs. Other options keep
/// their built-in values. Throws `InputError` at the place of a value that is not allowed.
Options with_settings(Options options, const Layers& layers);

/// Throws `InputError` (ErrorKind::usage) if the command needs a machine that is not given.
void refuse_no_machine(const Options& options);

/// The settings of a run as a project file that gives the same options, each with its origin. Includes
/// built-in values.
std::string config_text(Command command, const Layers& layers);

/// The options of one program, ready to run: `with_settings` and a machine.
Options options_of(Command command, const Layers& layers, const std::string& program);

}  // namespace counterflex::cli
