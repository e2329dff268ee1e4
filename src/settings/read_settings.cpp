#include "settings/read_settings.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "counterflex/settings/jobs_file.hpp"
#include "settings/keys.hpp"
#include "settings/read_values.hpp"

namespace counterflex::setting_file {

std::string folder_of(const std::string& file) {
  return std::filesystem::path(file).parent_path().generic_string();
}

std::string joined_path(const std::string& folder, const std::string& path) {
  return path == "-" ? path : (std::filesystem::path(folder) / path).generic_string();
}

std::string joined_output(const std::string& folder, const std::string& name) {
  const bool beside_program = is_pattern(name) && name.find('/') == std::string::npos;
  return beside_program ? name : joined_path(as_pattern(folder), name);
}

void check_format_of(const toml::table& document, std::string_view format, std::string_view what,
                     const toml_file::Source& source) {
  const toml::node* node = document.get("format");
  if (node == nullptr)
    source.fail_at_start(fmt::format("no format; {} begins with format = \"{}\"", what, format));
  const auto* text = node->as_string();
  if (text == nullptr || text->get() != format)
    source.fail(*node, fmt::format("format is {}; it must be \"{}\"", toml_file::seen(*node), format));
}

std::vector<Setting> read_settings(const toml::table& table, std::string_view owner,
                                   const std::string& folder, const std::vector<std::string_view>& other_keys,
                                   const toml_file::Source& source) {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const Key& key : keys) names.push_back(key_of_option(key.option));
  std::vector<std::string_view> allowed = other_keys;
  allowed.insert(allowed.end(), names.begin(), names.end());
  toml_file::check_keys(table, allowed, owner, source);
  std::vector<Setting> settings;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const toml::node* node = table.get(names[i]);
    if (node == nullptr) continue;
    Setting setting{std::string(keys[i].option), {}, source.at(node->source())};
    read_value(*node, keys[i].kind, {names[i], folder, source}, setting);
    settings.push_back(std::move(setting));
  }
  return settings;
}

}  // namespace counterflex::setting_file
