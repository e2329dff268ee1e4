#include "settings/read_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "counterflex/files/text.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/settings/jobs_file.hpp"
#include "settings/number_text.hpp"
#include "settings/read_settings.hpp"

namespace counterflex::setting_file {
namespace {

using toml_file::Source;

void add_value(Setting& setting, std::string value, const toml::source_region& region, const Source& source) {
  setting.values.push_back(std::move(value));
  setting.places.push_back(source.at(region));
}

[[noreturn]] void fail_kind(const toml::node& node, std::string_view what, const ValueContext& context) {
  context.source.fail(node, fmt::format("{} must be {}, not {}", context.name, what, toml_file::seen(node)));
}

std::string numbers_text(const toml::node& node, const std::string& name, const Source& source) {
  std::string text;
  std::size_t i = 0;
  for (const toml::node& entry : *node.as_array()) {
    if (i > 0) text += ',';
    text += number_text(toml_file::as_number(entry, {name, ++i}, {source}));
  }
  return text;
}

bool is_number(const toml::node& node) {
  return node.is_integer() || node.is_floating_point();
}

/// "T3=1,2,3" or an array of numbers.
void read_one_force(const toml::node& node, const ValueContext& context, Setting& setting) {
  if (node.is_string())
    return add_value(setting, toml_file::as_text(node, context.name, context.source), node.source(),
                     context.source);
  const toml::array* array = node.as_array();
  if (array == nullptr || (array->size() != 3 && array->size() != 6))
    fail_kind(node, "3 or 6 numbers, or a text as \"T3=FX,FY,FZ\"", context);
  add_value(setting, numbers_text(node, context.name, context.source), node.source(), context.source);
}

void read_forces(const toml::node& node, const ValueContext& context, Setting& setting) {
  const toml::array* array = node.as_array();
  if (array == nullptr || (!array->empty() && is_number(*array->get(0))))
    return read_one_force(node, context, setting);
  for (const toml::node& entry : *array) read_one_force(entry, context, setting);
}

void read_path(const toml::node& node, const ValueContext& context, Setting& setting) {
  const std::string path = toml_file::as_text(node, context.name, context.source);
  add_value(setting, joined_path(context.folder, path), node.source(), context.source);
}

void read_paths(const toml::node& node, const ValueContext& context, Setting& setting) {
  if (node.is_string()) return read_path(node, context, setting);
  if (!node.is_array()) fail_kind(node, "a path or an array of paths", context);
  for (const toml::node& entry : *node.as_array()) read_path(entry, context, setting);
}

void read_output_name(const toml::node& node, const ValueContext& context, Setting& setting) {
  const std::string text = toml_file::as_text(node, context.name, context.source);
  add_value(setting, joined_output(context.folder, text), node.source(), context.source);
}

/// false gives a setting without values: no file is written.
void read_report_name(const toml::node& node, std::string_view beside_output, const ValueContext& context,
                      Setting& setting) {
  const auto* truth = node.as_boolean();
  if (truth != nullptr && truth->get())
    return add_value(setting, std::string(beside_output), node.source(), context.source);
  if (truth != nullptr) return;
  if (!node.is_string()) fail_kind(node, "true, false or a name", context);
  read_output_name(node, context, setting);
}

void read_truth(const toml::node& node, const ValueContext& context, Setting& setting) {
  const auto* truth = node.as_boolean();
  if (truth == nullptr) fail_kind(node, "true or false", context);
  add_value(setting, truth->get() ? "true" : "false", node.source(), context.source);
}

void read_whole(const toml::node& node, const ValueContext& context, Setting& setting) {
  const auto* whole = node.as_integer();
  if (whole == nullptr) fail_kind(node, "a whole number", context);
  add_value(setting, std::to_string(whole->get()), node.source(), context.source);
}

std::string vector_text(const toml::table& table, std::string_view key, const Source& source) {
  const toml::node& node = *table.get(key);
  toml_file::as_vector3(node, key, {source});
  return numbers_text(node, std::string(key), source);
}

/// Adds NAME=VALUE. Throws if the name is defined twice with different spellings, which TOML does not detect.
void add_named(const toml::key& key, const std::string& name, const std::string& value, const Source& source,
               Setting& setting) {
  for (const std::string& known : setting.values)
    if (known.starts_with(name + "=")) source.fail(key, fmt::format("{} is defined twice", name));
  add_value(setting, name + "=" + value, key.source(), source);
}

/// In TOML [work.G59.1] is a table "1" of [work.G59].
void refuse_unquoted(const toml::key& key, const toml::table& table, const Source& source) {
  for (const auto& [inner, node] : table) {
    const std::string name = fmt::format("{}.{}", key.str(), inner.str());
    if (node.is_table() && work_offset_name(name))
      source.fail(inner, fmt::format("[work.{0}] must be written [work.\"{0}\"]", name));
  }
}

/// "true" is the former spelling of "machine".
std::string datum_text(const toml::node& node, const Source& source) {
  if (const auto* text = node.as_string(); text != nullptr && (*text == "machine" || *text == "true"))
    return "machine";
  if (!node.is_table())
    source.fail(node, fmt::format("datum must be \"machine\" or {{ touched_at_mm = [x, y, z] }}, not {}",
                                  toml_file::seen(node)));
  const toml::table& table = *node.as_table();
  toml_file::check_keys(table, {"touched_at_mm"}, "a datum", source);
  toml_file::required(table, "touched_at_mm", "a datum", node, source);
  return "touched=" + vector_text(table, "touched_at_mm", source);
}

void read_offset(const toml::key& key, const toml::node& node, const Source& source, Setting& setting) {
  const auto name = work_offset_name(key.str());
  if (!name)
    source.fail(key, fmt::format("\"{}\" is not a work offset; use {}", key.str(), work_offset_names));
  const std::string owner = fmt::format("[work.{}]", key.str());
  const toml::table& table = toml_file::as_table(node, owner, source);
  refuse_unquoted(key, table, source);
  toml_file::check_keys(table, {"xyz_mm", "rpy_deg", "datum", "offset_mm"}, owner, source);
  toml_file::required(table, "xyz_mm", owner, node, source);
  std::string value = vector_text(table, "xyz_mm", source);
  if (table.contains("rpy_deg")) value.append(",").append(vector_text(table, "rpy_deg", source));
  if (const toml::node* datum = table.get("datum")) value.append("/").append(datum_text(*datum, source));
  if (table.contains("offset_mm")) value.append("/offset=").append(vector_text(table, "offset_mm", source));
  add_named(key, *name, value, source, setting);
}

void read_length_of(const toml::key& key, const toml::node& node, const Source& source, Setting& setting) {
  const auto number = read_tool_number(key.str());
  if (!number)
    source.fail(key, fmt::format("\"{}\" is not a tool; it must be T and its number, as T3", key.str()));
  const std::string owner = fmt::format("[tools.{}]", key.str());
  const toml::table& table = toml_file::as_table(node, owner, source);
  toml_file::check_keys(table, {"length_mm"}, owner, source);
  const toml::node& length = toml_file::required(table, "length_mm", owner, node, source);
  const double length_mm = toml_file::as_number(length, {"length_mm"}, {source});
  add_named(key, fmt::format("T{}", *number), number_text(length_mm), source, setting);
}

template <typename Read>
void read_tables(const toml::node& node, const ValueContext& context, Setting& setting, const Read& read) {
  for (const auto& [key, entry] : toml_file::as_table(node, context.name, context.source))
    read(key, entry, context.source, setting);
}

/// Reads tables of offsets, or "machine".
void read_offsets(const toml::node& node, const ValueContext& context, Setting& setting) {
  if (const auto* text = node.as_string(); text != nullptr && *text == "machine")
    return add_value(setting, "machine", node.source(), context.source);
  if (!node.is_table()) fail_kind(node, "\"machine\" or tables as [work.G54]", context);
  read_tables(node, context, setting, read_offset);
}

}  // namespace

void read_value(const toml::node& node, Kind kind, const ValueContext& context, Setting& setting) {
  const auto add = [&](std::string value) {
    add_value(setting, std::move(value), node.source(), context.source);
  };
  switch (kind) {
    case Kind::text:
      return add(toml_file::as_text(node, context.name, context.source));
    case Kind::number:
      return add(number_text(toml_file::as_number(node, {context.name}, {context.source})));
    case Kind::whole:
      return read_whole(node, context, setting);
    case Kind::truth:
      return read_truth(node, context, setting);
    case Kind::path:
      return read_path(node, context, setting);
    case Kind::paths:
      return read_paths(node, context, setting);
    case Kind::forces:
      return read_forces(node, context, setting);
    case Kind::output:
      return read_output_name(node, context, setting);
    case Kind::report:
      return read_report_name(node, report_beside_output, context, setting);
    case Kind::plot:
      return read_report_name(node, plot_beside_output, context, setting);
    case Kind::offsets:
      return read_offsets(node, context, setting);
    case Kind::lengths:
      return read_tables(node, context, setting, read_length_of);
  }
}

}  // namespace counterflex::setting_file
