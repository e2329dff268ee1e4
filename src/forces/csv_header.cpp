#include "forces/csv_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "forces/csv_text.hpp"

namespace counterflex::csv {
namespace {

constexpr std::array<std::string_view, 4> key_names = {"line", "n", "s_mm", "t_s"};
constexpr std::array<std::string_view, 6> component_names = {"fx_N",  "fy_N",  "fz_N",
                                                             "mx_Nm", "my_Nm", "mz_Nm"};
constexpr std::string_view all_columns = "line | n | s_mm | t_s, fx_N, fy_N, fz_N, mx_Nm, my_Nm, mz_Nm";

[[noreturn]] void fail(const Location& where, const std::string& message) {
  throw InputError(Exit::machine_or_force, where, message);
}

template <std::size_t N>
std::optional<int> index_of(const std::array<std::string_view, N>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

struct Setting {
  std::string_view key, value;
  int key_column = 1, value_column = 1;
};

Setting parts_of(std::string_view line, int first_column) {
  const std::size_t equals = line.find('=');
  const std::string_view key = trimmed(line.substr(1, equals - 1)), rest = line.substr(equals + 1);
  const std::string_view value = trimmed(rest);
  const auto column = [&](std::string_view part) {
    return static_cast<int>(part.data() - line.data()) + first_column;
  };
  return {key, value, column(key), column(value.empty() ? rest : value)};
}

/// The index of the setting's value among those allowed. Throws where it is none of them or is given twice.
template <std::size_t N>
int choose(const Setting& setting, const Location& where, bool given,
           const std::array<std::string_view, N>& allowed) {
  if (given)
    fail({where.file, where.line, setting.key_column}, fmt::format("'{}' is given twice", setting.key));
  if (const auto index = index_of(allowed, setting.value)) return *index;
  fail({where.file, where.line, setting.value_column},
       fmt::format("{} is '{}', allowed: {}", setting.key, setting.value, fmt::join(allowed, ", ")));
}

Column column_of(const Field& field, const Location& where, const std::vector<Column>& before) {
  const auto repeated = [&](const Column& column) { return column.name == field.text; };
  if (std::any_of(before.begin(), before.end(), repeated))
    fail({where.file, where.line, field.column}, fmt::format("column '{}' is given twice", field.text));
  Column column{std::string(field.text), index_of(component_names, field.text)};
  if (!column.component && !index_of(key_names, field.text))
    fail({where.file, where.line, field.column},
         fmt::format("unknown column '{}', allowed: {}", field.text, all_columns));
  const auto is_key = [](const Column& other) { return !other.component; };
  const auto other_key = std::find_if(before.begin(), before.end(), is_key);
  if (!column.component && other_key != before.end())
    fail({where.file, where.line, field.column},
         fmt::format("a second key column '{}' beside '{}', allowed is one", field.text, other_key->name));
  return column;
}

}  // namespace

bool is_setting(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return false;
  const std::string_view key = trimmed(line.substr(1, equals - 1));
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !key.empty() && std::all_of(key.begin(), key.end(), letter);
}

void read_setting(std::string_view line, const Location& where, Settings& settings) {
  const Setting setting = parts_of(line, where.column);
  const auto choice = [&](bool given, const auto& allowed) { return choose(setting, where, given, allowed); };
  using Names2 = std::array<std::string_view, 2>;
  if (setting.key == "frame") {
    const std::array<std::string_view, 4> frames = {"machine", "work", "tool", "feed"};
    settings.frame = static_cast<ForceFrame>(choice(settings.frame.has_value(), frames));
  } else if (setting.key == "sense") {
    settings.on_workpiece = choice(settings.on_workpiece.has_value(), Names2{"on_tool", "on_workpiece"}) == 1;
  } else if (setting.key == "interpolation") {
    settings.linear = choice(settings.linear.has_value(), Names2{"step", "linear"}) == 1;
  } else if (setting.key == "at") {
    settings.at_platform = choice(settings.at_platform.has_value(), Names2{"tip", "platform"}) == 1;
  } else {
    fail({where.file, where.line, setting.key_column},
         fmt::format("unknown setting '{}', allowed: frame, sense, interpolation, at", setting.key));
  }
}

void require_settings(const Settings& settings, const Location& where) {
  if (!settings.frame)
    fail(where, "no line '# frame = ...' before the header, allowed: machine, work, tool, feed");
  if (!settings.on_workpiece)
    fail(where, "no line '# sense = ...' before the header, allowed: on_tool, on_workpiece");
}

Header read_header(std::string_view line, const Location& where) {
  Header header;
  for (const Field& field : split(line)) header.columns.push_back(column_of(field, where, header.columns));
  const auto has = [&](std::string_view name) {
    const auto same = [&](const Column& column) { return column.name == name; };
    return std::any_of(header.columns.begin(), header.columns.end(), same);
  };
  const auto key = std::find_if(key_names.begin(), key_names.end(), has);
  if (key == key_names.end()) fail(where, "no key column, one of line, n, s_mm, t_s is required");
  header.key = static_cast<ForceKey>(key - key_names.begin());
  for (int i = 0; i < 3; ++i)
    if (!has(component_names[i]))
      fail(where, fmt::format("no column '{}', it is required", component_names[i]));
  return header;
}

std::string key_name(ForceKey key) {
  return std::string(key_names[static_cast<std::size_t>(key)]);
}

double shown_per_si(ForceKey key) {
  return key == ForceKey::path_length ? 1e3 : 1.0;
}

}  // namespace counterflex::csv
