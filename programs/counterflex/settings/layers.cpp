#include "settings/layers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <thread>

#include "counterflex/files/text.hpp"
#include "counterflex/machine/machine.hpp"
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

/// The names of values NAME=..., in one spelling; empty if one has no name: "machine".
std::vector<std::string> names_in(const Setting& setting) {
  std::vector<std::string> names;
  for (const std::string& value : setting.values) {
    const std::size_t end = value.find('=');
    if (end == std::string::npos) return {};
    const std::string name = value.substr(0, end);
    const auto tool = setting.option == "work" ? std::nullopt : read_tool_number(name);
    names.push_back(tool ? fmt::format("T{}", *tool) : work_offset_name(name).value_or(name));
  }
  return names;
}

}  // namespace

std::vector<SettingRemark> remarks_on_replaced(Command command, const Layers& layers) {
  std::vector<SettingRemark> remarks;
  for (const std::string_view option : {"work", "tool-length"}) {
    const Setting* used = strongest(layers, option);
    if (used == nullptr || !has_setting(command, option)) continue;
    const std::vector<std::string> kept = names_in(*used);
    if (kept.empty()) continue;
    for (const std::vector<Setting>& layer : layers) {
      const Setting* replaced_table = said_in(layer, option);
      if (replaced_table == nullptr || replaced_table == used) continue;
      std::vector<std::string> names = names_in(*replaced_table);
      std::erase_if(names, [&](const std::string& name) { return std::ranges::count(kept, name) > 0; });
      if (names.empty()) continue;
      SettingRemark& remark = remarks.emplace_back();
      remark.where = replaced_table->where;
      const std::string by = used->origin == Origin::file
                                 ? fmt::format("{}:{}", used->where.file, used->where.line)
                                 : shown_option(option, used->origin);
      remark.what = fmt::format(
          "{} replaces all of {}; not used: {} as given here; values of {} act instead, if it has them; give "
          "them there too if the program needs these",
          by, shown_option(option, replaced_table->origin), fmt::join(names, ", "),
          option == "work" ? "the machine file" : "the tool table or the machine file");
    }
  }
  return remarks;
}

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
  for (SettingRemark& remark : remarks_on_replaced(options.command, layers))
    options.remarks.push_back(std::move(remark));
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
