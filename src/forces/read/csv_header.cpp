#include "forces/read/csv_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::csv {
namespace {

constexpr std::array<std::string_view, 5> place_names = {"line", "n", "s_mm", "t_s", "x_mm, y_mm, z_mm"};
constexpr std::array<std::string_view, 3> axis_names = {"x_mm", "y_mm", "z_mm"};
constexpr std::array<std::string_view, 6> key_names = {"line", "n", "s_mm", "t_s", "tool", "op"};
constexpr std::array<RowKey, 6> keys_named = {RowKey::line, RowKey::block_number, RowKey::path_length,
                                              RowKey::time, RowKey::tool,         RowKey::operation};
constexpr std::array<std::string_view, 6> component_names = {"fx_N",  "fy_N",  "fz_N",
                                                             "mx_Nm", "my_Nm", "mz_Nm"};
constexpr std::string_view all_columns =
    "line | n | s_mm | t_s | tool | op | x_mm, y_mm, z_mm, then fx_N, fy_N, fz_N, mx_Nm, my_Nm, mz_Nm";

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

/// The index of the setting's value in `allowed`. Throws if it is not allowed or is given twice.
template <std::size_t N>
int choose(const Setting& setting, const Location& where, bool given,
           const std::array<std::string_view, N>& allowed) {
  if (given)
    fail({where.file, where.line, setting.key_column}, fmt::format("'{}' is given twice", setting.key));
  if (const auto index = index_of(allowed, setting.value)) return *index;
  fail({where.file, where.line, setting.value_column},
       fmt::format("{} is '{}', allowed: {}", setting.key, setting.value, fmt::join(allowed, ", ")));
}

void refuse_second_key(const Column& column, const Field& field, const Location& where,
                       const std::vector<Column>& before) {
  if (column.component) return;
  const auto other = std::find_if(before.begin(), before.end(), [&](const Column& given) {
    return !given.component && !(given.axis && column.axis);
  });
  if (other != before.end())
    fail({where.file, where.line, field.column},
         fmt::format("a second key column '{}' beside '{}', allowed is one", field.text, other->name));
}

Column column_of(const Field& field, const Location& where, const std::vector<Column>& before) {
  const auto repeated = [&](const Column& column) { return column.name == field.text; };
  if (std::any_of(before.begin(), before.end(), repeated))
    fail({where.file, where.line, field.column}, fmt::format("column '{}' is given twice", field.text));
  Column column{std::string(field.text), index_of(component_names, field.text),
                index_of(axis_names, field.text)};
  if (!column.component && !column.axis && !index_of(key_names, field.text))
    fail({where.file, where.line, field.column},
         fmt::format("unknown column '{}', allowed: {}", field.text, all_columns));
  refuse_second_key(column, field, where, before);
  return column;
}

bool has(const Header& header, std::string_view name) {
  const auto same = [&](const Column& column) { return column.name == name; };
  return std::any_of(header.columns.begin(), header.columns.end(), same);
}

RowKey key_of_header(const Header& header, const Location& where) {
  for (std::size_t i = 0; i < key_names.size(); ++i)
    if (has(header, key_names[i])) return keys_named[i];
  const auto given = [&](std::string_view name) { return has(header, name); };
  const auto first = std::find_if(axis_names.begin(), axis_names.end(), given);
  if (first == axis_names.end())
    fail(where, "no key column: one of line, n, s_mm, t_s, tool, op, or x_mm, y_mm, z_mm is required");
  const auto missing = std::find_if_not(axis_names.begin(), axis_names.end(), given);
  if (missing != axis_names.end())
    fail(where,
         fmt::format("column '{}' without '{}': a logged position needs all three axes", *first, *missing));
  return RowKey::point;
}

// Smaller values are below the rounding of logs, and would need too many cells.
constexpr double least_within_mm = 1e-4;

double read_within(const Setting& setting, const Location& where, bool given) {
  if (given)
    fail({where.file, where.line, setting.key_column}, fmt::format("'{}' is given twice", setting.key));
  const auto value = read_number(setting.value);
  if (!value || *value < least_within_mm)
    fail({where.file, where.line, setting.value_column},
         fmt::format("{} is '{}', must be a number from {} up", setting.key, setting.value, least_within_mm));
  return *value * mm;
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
  } else if (setting.key == "coordinates") {
    const bool given = settings.machine_coordinates.has_value();
    settings.machine_coordinates = choice(given, Names2{"work", "machine"}) == 1;
  } else if (setting.key == "within_mm") {
    settings.within = read_within(setting, where, settings.within.has_value());
  } else {
    fail({where.file, where.line, setting.key_column},
         fmt::format("unknown setting '{}', allowed: frame, sense, interpolation, at, within_mm, coordinates",
                     setting.key));
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
  header.key = key_of_header(header, where);
  for (int i = 0; i < 3; ++i)
    if (!has(header, component_names[i]))
      fail(where, fmt::format("no column '{}', it is required", component_names[i]));
  return header;
}

void refuse_settings(const Settings& settings, RowKey key, const Location& where) {
  if (key != RowKey::point && (settings.within || settings.machine_coordinates))
    fail(where, fmt::format("'{}' is for logged positions, with the columns x_mm, y_mm, z_mm",
                            settings.within ? "within_mm" : "coordinates"));
  if ((key == RowKey::tool || key == RowKey::operation) && settings.linear.value_or(false))
    fail(where, fmt::format("interpolation = linear has no meaning between rows of the key '{}'",
                            key == RowKey::tool ? "tool" : "op"));
}

std::string key_name(ForceKey key) {
  return std::string(place_names[static_cast<std::size_t>(key)]);
}

double shown_per_si(ForceKey key) {
  return key == ForceKey::path_length ? 1e3 : 1.0;
}

}  // namespace counterflex::csv
