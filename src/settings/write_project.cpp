#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "counterflex/files/text.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/settings/project_file.hpp"
#include "settings/keys.hpp"
#include "settings/number_text.hpp"

namespace counterflex {
namespace {

using setting_file::Key;
using setting_file::Kind;

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result.append(1, '\\').append(1, c);
    else if (code < 0x20 || code == 0x7F)
      result += fmt::format("\\u{:04X}", code);
    else
      result += c;
  }
  return result.append(1, '"');
}

std::string toml_list(const std::vector<std::string>& values) {
  std::string list = "[";
  for (const std::string& value : values) list.append(list.size() > 1 ? ", " : "").append(toml_text(value));
  return list.append(1, ']');
}

/// A number as TOML writes it; other texts are not changed: their reader reports the error.
std::string plain_number(std::string_view text) {
  const auto blank = [](char c) { return c == ' '; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  const auto number = read_number(text);
  return number ? setting_file::number_text(*number) : std::string(text);
}

std::string value_text(const std::vector<std::string>& values, Kind kind) {
  if (kind == Kind::paths || kind == Kind::forces) return toml_list(values);
  if (values.empty()) return "false";
  const std::string& value = values.back();
  if (kind == Kind::number || kind == Kind::whole) return plain_number(value);
  if (kind == Kind::truth) return value;
  if (kind == Kind::report && value == setting_file::report_beside_output) return "true";
  if (kind == Kind::plot && value == setting_file::plot_beside_output) return "true";
  return toml_text(value);
}

bool is_no_character(std::string_view character) {
  return character.size() == 1 && static_cast<unsigned char>(character[0]) >= 0x80;
}

/// Removes characters of file names that comments may not contain.
std::string in_one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::string_view next = first_character(text);
    const bool control = static_cast<unsigned char>(next[0]) < 0x20 || next[0] == 0x7F;
    line += control || is_no_character(next) ? "?" : next;
    text.remove_prefix(next.size());
  }
  return line;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::string_view next = first_character(text);
    if (is_no_character(next)) return false;
    text.remove_prefix(next.size());
  }
  return true;
}

/// Throws for a file name that is not UTF-8, as TOML requires.
void refuse_other_bytes(const Setting& setting) {
  for (std::size_t i = 0; i < setting.values.size(); ++i) {
    if (is_utf8(setting.values[i])) continue;
    const bool of_file = setting.origin == Origin::file;
    const std::string name =
        shown_option(setting.option, setting.origin == Origin::flag ? Origin::flag : Origin::file);
    throw InputError(of_file ? ErrorKind::machine_or_force : ErrorKind::usage, place_of(setting, i),
                     fmt::format("{} is '{}', whose bytes are not UTF-8, as a project file must be", name,
                                 in_one_line(setting.values[i])));
  }
}

std::string origin_text(const Setting& setting, std::size_t value = 0) {
  switch (setting.origin) {
    case Origin::flag:
      return shown_option(setting.option, Origin::flag);
    case Origin::environment:
      return setting.where.file;
    case Origin::file:
      return fmt::format("{}:{}", in_one_line(setting.where.file), place_of(setting, value).line);
    case Origin::builtin:
      break;
  }
  return "default";
}

/// "1,2,3": at most three numbers from `first` on.
std::string three_numbers(const std::vector<std::string>& numbers, std::size_t first) {
  std::string text = "[";
  for (std::size_t i = first; i < std::min(first + 3, numbers.size()); ++i)
    text.append(i > first ? ", " : "").append(plain_number(numbers[i]));
  return text.append(1, ']');
}

std::vector<std::string> at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

std::string toml_key(const std::string& name) {
  const bool bare = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare && !name.empty() ? name : toml_text(name);
}

namespace {

std::string datum_line(const std::string& datum) {
  const std::size_t equals = datum.find('=');
  if (datum.starts_with("offset="))
    return fmt::format("offset_mm = {}\n", three_numbers(at_commas(datum.substr(equals + 1)), 0));
  if (equals == std::string::npos) return fmt::format("datum = {}\n", toml_text(datum));
  return fmt::format("datum = {{ touched_at_mm = {} }}\n",
                     three_numbers(at_commas(datum.substr(equals + 1)), 0));
}

std::string offset_table(const std::string& name, const std::string& value) {
  const std::string known = work_offset_name(name).value_or(name);
  const std::size_t slash = std::min(value.find('/'), value.size());
  const auto numbers = at_commas(value.substr(0, slash));
  std::string text = fmt::format("[work.{}]\nxyz_mm = {}\n", toml_key(known), three_numbers(numbers, 0));
  if (numbers.size() > 3) text += fmt::format("rpy_deg = {}\n", three_numbers(numbers, 3));
  for (std::size_t at = slash; at < value.size();) {
    const std::size_t next = std::min(value.find('/', at + 1), value.size());
    text += datum_line(value.substr(at + 1, next - at - 1));
    at = next;
  }
  return text;
}

std::string length_table(const std::string& name, const std::string& value) {
  const auto tool = read_tool_number(name);
  return fmt::format("[tools.{}]\nlength_mm = {}\n", tool ? fmt::format("T{}", *tool) : toml_key(name),
                     plain_number(value));
}

/// The later of two values for one name counts, as on the command line. Without values the table is empty.
std::string tables_text(const Setting& setting, Kind kind) {
  if (setting.values.empty())
    return fmt::format("\n# {}\n[{}]\n", origin_text(setting), kind == Kind::offsets ? "work" : "tools");
  std::map<std::string, std::string> tables;
  for (std::size_t i = 0; i < setting.values.size(); ++i) {
    const std::string& value = setting.values[i];
    const std::size_t equals = std::min(value.find('='), value.size() - 1);
    const std::string name = value.substr(0, equals), rest = value.substr(equals + 1);
    const std::string table = kind == Kind::offsets ? offset_table(name, rest) : length_table(name, rest);
    tables[table.substr(0, table.find('\n'))] = fmt::format("\n# {}\n{}", origin_text(setting, i), table);
  }
  std::string text;
  for (const auto& [head, table] : tables) text += table;
  return text;
}

const Setting* setting_of(const std::vector<Setting>& settings, std::string_view option) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const Setting& setting) { return setting.option == option; });
  return found == settings.end() ? nullptr : &*found;
}

}  // namespace

std::string to_project_text(const std::vector<Setting>& settings) {
  std::string text = "format = \"counterflex-project 1\"\n", tables;
  for (const Key& key : setting_file::keys) {
    const Setting* setting = setting_of(settings, key.option);
    if (setting == nullptr) continue;
    refuse_other_bytes(*setting);
    const bool alone =
        key.kind == Kind::offsets && !setting->values.empty() && setting->values.back() == "machine";
    if (!alone && (key.kind == Kind::offsets || key.kind == Kind::lengths)) {
      tables += tables_text(*setting, key.kind);
      continue;
    }
    const std::string line = fmt::format("{} = {}", setting_file::key_of_option(key.option),
                                         value_text(setting->values, key.kind));
    text += fmt::format("{:<40}  # {}\n", line, origin_text(*setting));
  }
  return text + tables;
}

}  // namespace counterflex
