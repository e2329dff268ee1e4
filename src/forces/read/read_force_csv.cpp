#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/forces/forces.hpp"
#include "counterflex/geometry/types.hpp"
#include "forces/path/profile/alignment.hpp"
#include "forces/read/csv_header.hpp"
#include "forces/read/selector_text.hpp"

namespace counterflex {
namespace {

using csv::fail;
using csv::Field;
using csv::Header;
using csv::RowKey;

/// State of the reader.
struct Reader {
  std::string file;
  csv::Settings settings;
  std::optional<Header> header;
  Location header_place;
  ForceRows rows;                                      ///< of places
  double last_key = 0;                                 ///< of the previous row
  std::vector<ForceSelector> selectors;                ///< of the same rows, if the key is not a place
  std::unordered_map<std::string, std::size_t> named;  ///< their tools or operations, and the rows
  int line = 0;
  int empty_line = 0;  ///< an empty line after a row; no row may follow

  Location at(int column) const { return {file, line, column}; }
};

std::string row_name(const Reader& reader) {
  return fmt::format("row {}", reader.rows.size() + 1);
}

double number_of(const Reader& reader, const Field& field, const std::string& name) {
  if (field.text.empty()) {
    fail(reader.at(field.column),
         fmt::format("{}: {} is empty, every row must give every column", row_name(reader), name));
  }
  if (const auto value = read_number(field.text)) return *value;
  fail(reader.at(field.column),
       fmt::format("{}: {} is '{}', must be a finite number", row_name(reader), name, field.text));
}

/// Of a logged position.
double coordinate_of(const Reader& reader, const Field& field, const std::string& name) {
  constexpr double most_mm = 1e6;
  const double value = number_of(reader, field, name);
  if (std::abs(value) > most_mm)
    fail(reader.at(field.column),
         fmt::format("{}: {} is {}, must be from -1000000 to 1000000", row_name(reader), name, field.text));
  return value;
}

ForceKey place_key(RowKey key) {
  switch (key) {
    case RowKey::line:
      return ForceKey::line;
    case RowKey::block_number:
      return ForceKey::block_number;
    case RowKey::path_length:
      return ForceKey::path_length;
    case RowKey::time:
      return ForceKey::time;
    default:
      return ForceKey::point;
  }
}

/// The key in SI. Throws if a program cannot have it, or if it does not increase.
double key_of(const Reader& reader, const Field& field) {
  const ForceKey key = place_key(reader.header->key);
  const std::string name = csv::key_name(key);
  const double shown = number_of(reader, field, name);
  const bool counted = key == ForceKey::line || key == ForceKey::block_number;
  const double least = key == ForceKey::line ? 1 : 0;
  if (shown < least || (counted && shown != std::floor(shown))) {
    fail(reader.at(field.column), fmt::format("{}: {} is {}, must be a {}number from {} up", row_name(reader),
                                              name, field.text, counted ? "whole " : "", least));
  }
  const double value = shown / csv::shown_per_si(key);
  if (!reader.rows.empty() && value <= reader.last_key) {
    fail(reader.at(field.column),
         fmt::format("{}: {} is {}, must be greater than {:.12g}, the value in the previous row",
                     row_name(reader), name, field.text, reader.last_key * csv::shown_per_si(key)));
  }
  return value;
}

/// The tool or operation. Throws if it is invalid, or if an earlier row has it.
ForceSelector selector_of(Reader& reader, const Field& field) {
  const bool by_tool = reader.header->key == RowKey::tool;
  ForceSelector selector;
  if (by_tool) {
    selector.tool = read_tool(field.text);
    if (!selector.tool)
      fail(reader.at(field.column), fmt::format("{}: tool is '{}', must be a tool's number, as 3 or T3",
                                                row_name(reader), field.text));
  } else {
    if (field.text.empty())
      fail(reader.at(field.column),
           fmt::format("{}: op is empty, must be the text of an operation's comment", row_name(reader)));
    selector.operation = std::string(field.text);
  }
  const std::string name = by_tool ? std::to_string(*selector.tool) : folded(*selector.operation);
  const auto [same, is_new] = reader.named.insert({name, reader.rows.size() + 1});
  if (!is_new)
    fail(reader.at(field.column),
         fmt::format("{}: {} is already in row {}", row_name(reader), shown(selector), same->second));
  return selector;
}

/// Whether a row of a profile has only its key.
bool only_key(const Header& header, const std::vector<Field>& fields) {
  if (header.key == RowKey::tool || header.key == RowKey::operation) return false;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (header.columns[i].component && !fields[i].text.empty()) return false;
  return true;
}

void read_field(const csv::Column& column, const Field& field, Reader& reader, ForceRow& row) {
  if (column.component) {
    if (!row.ends) row.F[*column.component] = number_of(reader, field, column.name);
    return;
  }
  if (row.where.line == 0) row.where = {reader.line, field.column};
  if (column.axis)
    row.point[*column.axis] = coordinate_of(reader, field, column.name) * mm;
  else if (reader.header->key == RowKey::tool || reader.header->key == RowKey::operation)
    reader.selectors.push_back(selector_of(reader, field));
  else
    row.key = key_of(reader, field);
}

void take(const ForceRow& row, Reader& reader) {
  reader.rows.push_back(row);
  reader.last_key = row.key;
}

void read_row(std::string_view text, Reader& reader) {
  const auto fields = csv::split(text);
  const auto& columns = reader.header->columns;
  if (fields.size() != columns.size()) {
    fail(reader.at(fields[std::min(fields.size(), columns.size()) - 1].column),
         fmt::format("{} has {} fields, the header has {}", row_name(reader), fields.size(), columns.size()));
  }
  ForceRow row;
  row.ends = only_key(*reader.header, fields);
  for (std::size_t i = 0; i < fields.size(); ++i) read_field(columns[i], fields[i], reader, row);
  if (*reader.settings.on_workpiece) row.F = -row.F;
  take(row, reader);
}

/// Fast path for rows of plain numbers between commas, with the result of `read_row`. Returns false and
/// changes nothing for any other row: then `read_row` reads it or reports the error.
bool read_plain_row(std::string_view text, Reader& reader) {
  const Header& header = *reader.header;
  if (header.key > RowKey::time) return false;
  ForceRow row{.where = {reader.line, 0}};
  double shown = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const auto& component = header.columns[i].component;
    double& value = component ? row.F[*component] : shown;
    if (!component) row.where.column = static_cast<int>(at - text.data()) + 1;
    const auto [behind, error] = std::from_chars(at, end, value);
    const bool last = i + 1 == header.columns.size();
    if (error != std::errc{} || !std::isfinite(value) ||
        (last ? behind != end : behind == end || *behind != ','))
      return false;
    at = behind + 1;
  }
  const bool counted = header.key == RowKey::line || header.key == RowKey::block_number;
  row.key = shown / csv::shown_per_si(place_key(header.key));
  if (shown < (header.key == RowKey::line ? 1 : 0) || (counted && shown != std::floor(shown))) return false;
  if (!reader.rows.empty() && row.key <= reader.last_key) return false;
  if (*reader.settings.on_workpiece) row.F = -row.F;
  take(row, reader);
  return true;
}

void read_comment(const Field& comment, Reader& reader) {
  if (!csv::is_setting(comment.text)) return;
  const Location where = reader.at(comment.column);
  if (reader.header) fail(where, "a setting after the header row; settings must be above it");
  csv::read_setting(comment.text, where, reader.settings);
}

void read_line(std::string_view text, Reader& reader) {
  const std::string_view shown = csv::trimmed(text);
  if (shown.empty()) {
    if (reader.header && reader.empty_line == 0) reader.empty_line = reader.line;
  } else if (shown.front() == '#') {
    read_comment({shown, static_cast<int>(shown.data() - text.data()) + 1}, reader);
  } else if (!reader.header) {
    reader.header_place = reader.at(1);
    csv::require_settings(reader.settings, reader.header_place);
    reader.header = csv::read_header(text, reader.header_place);
    csv::refuse_settings(reader.settings, reader.header->key, reader.header_place);
  } else {
    if (reader.empty_line != 0) {
      fail({reader.file, reader.empty_line, 1},
           fmt::format("an empty line before {}, rows must follow each other", row_name(reader)));
    }
    if (!read_plain_row(text, reader)) read_row(text, reader);
  }
}

ForceRule profile_rule(Reader& reader) {
  const csv::Settings& settings = reader.settings;
  ForceProfile profile;
  profile.key = place_key(reader.header->key);
  profile.frame = *settings.frame;
  profile.linear = settings.linear.value_or(false);
  profile.at_platform = settings.at_platform.value_or(false);
  profile.rows = std::move(reader.rows);
  if (profile.key == ForceKey::point) profile.within = settings.within.value_or(1 * mm);
  profile.machine_coordinates = settings.machine_coordinates.value_or(false);
  profile.file = reader.file;
  const Location where = place_of_row(profile, 0);
  return {reader.file, where, {}, std::move(profile)};
}

constexpr std::size_t bytes_at_once = 1 << 16;

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  return text;
}

void read_lines(std::string_view text, Reader& reader) {
  while (!text.empty()) {
    ++reader.line;
    read_line(csv::take_line(text), reader);
  }
}

std::vector<ForceRule> finished(Reader reader) {
  if (!reader.header) {
    fail({reader.file, std::max(reader.line, 1), 1},
         "no header row, such as 's_mm,fx_N,fy_N,fz_N' after the lines that begin with '#'");
  }
  if (reader.rows.empty()) fail(reader.header_place, "no rows after the header, at least one is required");
  std::vector<ForceRule> rules;
  for (std::size_t i = 0; i < reader.selectors.size(); ++i) {
    const ForceRow row = reader.rows[i];
    const ConstantForce force{row.F, *reader.settings.frame, reader.settings.at_platform.value_or(false)};
    const Location where{reader.file, row.where.line, row.where.column};
    rules.push_back({reader.file, where, reader.selectors[i], force});
  }
  if (rules.empty()) rules.push_back(profile_rule(reader));
  return rules;
}

}  // namespace

std::vector<ForceRule> read_force_csv(std::string_view text, const std::string& file) {
  Reader reader;
  reader.file = file;
  read_lines(without_byte_order_mark(text), reader);
  return finished(std::move(reader));
}

std::vector<ForceRule> read_force_csv(FileReader& bytes, const std::string& file) {
  Reader reader;
  reader.file = file;
  std::string text;
  const auto read = [&](std::size_t count) {
    const std::string_view lines = std::string_view(text).substr(0, count);
    read_lines(reader.line == 0 ? without_byte_order_mark(lines) : lines, reader);
    text.erase(0, count);
  };
  bytes.rewind();
  while (bytes.append(text, bytes_at_once) > 0) read(text.rfind('\n') + 1);
  read(text.size());
  return finished(std::move(reader));
}

}  // namespace counterflex
