#include "settings/layers.hpp"

#include <algorithm>
#include <array>
#include <thread>

#include "counterflex/settings/project_file.hpp"
#include "process/read_input.hpp"
#include "settings/output_names.hpp"
#include "settings/setting_options.hpp"

namespace counterflex::cli {
namespace {

/// The second option of each pair replaces the first one in later layers. A length of a tool does not replace
/// a table: it is one of many.
constexpr std::array<std::array<std::string_view, 2>, 3> replaced{
    {{"forces", "force"}, {"force", "forces"}, {"tool-length", "tool-table"}}};

std::string_view replacing(std::string_view option) {
  for (const auto& pair : replaced)
    if (pair[0] == option) return pair[1];
  return option;
}

const Setting* said_in(const std::vector<Setting>& layer, std::string_view option) {
  const auto found = std::find_if(layer.begin(), layer.end(),
                                  [&](const Setting& setting) { return setting.option == option; });
  return found == layer.end() ? nullptr : &*found;
}

const Setting* strongest(const Layers& layers, std::string_view option) {
  for (const std::vector<Setting>& layer : layers) {
    const Setting* setting = said_in(layer, option);
    if (setting != nullptr || said_in(layer, replacing(option)) != nullptr) return setting;
  }
  return nullptr;
}

}  // namespace

std::vector<Setting> effective_settings(Command command, const Layers& layers) {
  std::vector<Setting> settings;
  for (const SettingOption& option : setting_options()) {
    const Setting* setting = strongest(layers, option.option);
    if (setting == nullptr || !has_setting(command, option.option)) continue;
    settings.push_back(option.option == "output" ? with_folder_marked(*setting) : *setting);
  }
  return settings;
}

Options with_settings(Options options, const Layers& layers) {
  options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const std::vector<Setting> settings = effective_settings(options.command, layers);
  for (const Setting& setting : settings) {
    apply_setting(setting, options);
    if (setting.option == "force" || setting.option == "forces")
      options.shares_forces = setting.origin == Origin::file;
    remark_on_name(setting, options);
  }
  name_outputs(options, settings);
  return options;
}

void refuse_no_machine(const Options& options) {
  if (!options.machine.empty() || options.command == Command::check || options.command == Command::forces ||
      options.command == Command::compare)
    return;
  throw InputError(
      ErrorKind::usage, {},
      "no machine is given; --machine MACHINE names it, or the environment's "
      "COUNTERFLEX_MACHINE, or machine = \"MACHINE\" in a project file, counterflex.toml, beside "
      "or above the program");
}

Options options_of(Command command, const Layers& layers, const std::string& program) {
  Options options;
  options.command = command;
  options.program = program;
  options = with_settings(std::move(options), layers);
  refuse_no_machine(options);
  return options;
}

std::string config_text(Command command, const Layers& layers) {
  std::vector<Setting> settings = effective_settings(command, layers);
  for (const SettingOption& option : setting_options()) {
    if (option.builtin.empty() || !has_setting(command, option.option)) continue;
    if (said_in(settings, option.option) != nullptr) continue;
    settings.push_back({std::string(option.option), {std::string(option.builtin)}, {}, Origin::builtin});
  }
  return to_project_text(settings);
}

ProgramLayers layers_of(const SettingSources& sources, const std::string& program) {
  auto file = sources.config;
  if (!file && !sources.no_config) file = find_project_file(program);
  ProgramLayers result{{sources.flags, sources.environment}, file.value_or("")};
  if (file) refuse_special_file(*file);
  if (file) result.layers.push_back(read_project(read_input(*file, ErrorKind::machine_or_force), *file));
  return result;
}

}  // namespace counterflex::cli
