#include "counterflex/settings/environment.hpp"

#include <string_view>

#include "counterflex/files/system.hpp"
#include "counterflex/files/text.hpp"
#include "settings/keys.hpp"
#include "settings/read_settings.hpp"

namespace counterflex {
namespace {

/// The value of the variable `name`, or empty.
std::string_view value_of_variable(const char* const* variables, const std::string& name) {
  for (; *variables != nullptr; ++variables) {
    const std::string_view variable = *variables;
    if (variable.starts_with(name) && variable.substr(name.size()).starts_with('='))
      return variable.substr(name.size() + 1);
  }
  return {};
}

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(system::list_separator);
    if (end != 0 && !text.empty()) parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

bool is_list(setting_file::Kind kind) {
  using setting_file::Kind;
  return kind == Kind::paths || kind == Kind::forces || kind == Kind::offsets || kind == Kind::lengths;
}

/// "true" gives the name beside the output, "false" no value.
std::vector<std::string> names_of(std::string_view text, std::string_view beside_output,
                                  const std::string& folder) {
  if (text == "false") return {};
  if (text == "true") return {std::string(beside_output)};
  return {setting_file::joined_output(folder, std::string(text))};
}

std::vector<std::string> values_of(std::string_view text, setting_file::Kind kind,
                                   const std::string& folder) {
  using setting_file::Kind;
  std::vector<std::string> values = is_list(kind) ? split_list(text) : std::vector{std::string(text)};
  switch (kind) {
    case Kind::path:
    case Kind::paths:
      for (std::string& path : values) path = setting_file::joined_path(folder, path);
      return values;
    case Kind::output:
      return {setting_file::joined_output(folder, values[0])};
    case Kind::report:
      return names_of(text, setting_file::report_beside_output, folder);
    case Kind::plot:
      return names_of(text, setting_file::plot_beside_output, folder);
    default:
      return values;
  }
}

}  // namespace

std::vector<Setting> read_environment(const char* const* variables, const std::string& folder) {
  std::vector<Setting> settings;
  for (const setting_file::Key& key : setting_file::keys) {
    const std::string name = setting_file::variable_of(key.option);
    const std::string_view text = value_of_variable(variables, name);
    const bool only_separators = is_list(key.kind) && split_list(text).empty();
    if (text.empty() || only_separators) continue;
    settings.push_back(
        {std::string(key.option), values_of(text, key.kind, folder), {name}, Origin::environment});
  }
  return settings;
}

std::vector<std::pair<std::string, std::string>> misspelt_variables(const char* const* variables) {
  constexpr std::string_view prefix = "COUNTERFLEX_";
  std::vector<std::string> names;
  for (const setting_file::Key& key : setting_file::keys)
    names.push_back(setting_file::variable_of(key.option));
  std::vector<std::string_view> known;
  for (const std::string& name : names) known.push_back(std::string_view(name).substr(prefix.size()));
  std::vector<std::pair<std::string, std::string>> misspelt;
  for (; *variables != nullptr; ++variables) {
    const std::string_view variable = *variables, name = variable.substr(0, variable.find('='));
    if (!name.starts_with(prefix)) continue;
    const std::string_view meant = nearest(name.substr(prefix.size()), known);
    if (meant.empty() || name.substr(prefix.size()) == meant) continue;
    misspelt.emplace_back(name, std::string(prefix).append(meant));
  }
  return misspelt;
}

}  // namespace counterflex
