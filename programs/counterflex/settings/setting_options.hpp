#pragma once
/// The options that the environment, project files and jobs files can give as well as flags: one table, from
/// which the command line is made and through which every value goes, wherever it is from.
#include <span>
#include <string>
#include <string_view>

#include "counterflex/settings/project_file.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

struct SettingOption {
  std::string_view option;  ///< "machine"
  std::string_view flags;   ///< "-m,--machine"
  std::string_view type;    ///< of its value in the help; empty: a switch
  std::string_view help;
  std::string_view builtin;  ///< the value without any setting, where a file can say it
  bool repeated;             ///< may be given several times, for several values
  /// Makes sense of one value; `name` is what messages call the option. Throws `InputError` (Exit::usage).
  void (*take)(const std::string& name, const std::string& value, Options& options);
};

std::span<const SettingOption> setting_options();

/// The one of that name, which must be there.
const SettingOption& setting_option(std::string_view option);

/// Whether a setting of that option means something to `command`; others are passed over.
bool has_setting(Command command, std::string_view option);

/// Gives `options` the values of a setting. Throws `InputError` at the value's place: Exit::usage for flags
/// and the environment, Exit::machine_or_force for files.
void apply_setting(const Setting& setting, Options& options);

/// Throws `message` as `apply_setting` does for value `i`.
[[noreturn]] void blame_setting(const Setting& setting, std::size_t i, const std::string& message);

/// What messages call the option: "--tolerance-mm" of a flag, else "tolerance_mm".
std::string name_in_messages(const Setting& setting);

}  // namespace counterflex::cli
