#pragma once
/// The options that flags, environment, project files and jobs files can give: one table for the command line
/// and for all values of other sources.
#include <span>
#include <string>
#include <string_view>

#include "counterflex/files/input_error.hpp"
#include "counterflex/settings/project_file.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

struct SettingOption {
  std::string_view option;  ///< "machine"
  std::string_view flags;   ///< "-m,--machine"
  std::string_view type;    ///< of its value in the help; empty for a switch
  std::string_view group;   ///< of the help
  std::string_view help;
  std::string_view builtin;  ///< the default value, if a file can state it
  bool repeated;             ///< may be given several times, for several values
  /// Parses one value; `name` is the name of the option in messages. Throws `InputError` (ErrorKind::usage).
  void (*take)(const std::string& name, const std::string& value, Options& options);
};

std::span<const SettingOption> setting_options();

/// The option of that name, which must exist.
const SettingOption& setting_option(std::string_view option);

/// Whether `command` uses that option; it ignores others.
bool has_setting(Command command, std::string_view option);

/// Sets the values of a setting in `options`. Throws `InputError` at the place of a wrong value:
/// ErrorKind::usage for flags and the environment, ErrorKind::machine_or_force for files.
void apply_setting(const Setting& setting, Options& options);

/// The message of an error without a place.
std::string message_without_place(const InputError& error);

/// Throws `message` as `apply_setting` does for value `i`.
[[noreturn]] void blame_setting(const Setting& setting, std::size_t i, const std::string& message);

/// The name of the option in messages: "--tolerance-mm" for a flag, else "tolerance_mm".
std::string name_in_messages(const Setting& setting);

}  // namespace counterflex::cli
