#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "counterflex/files/numbers.hpp"
#include "counterflex/forces/forces.hpp"
#include "forces/csv_header.hpp"
#include "forces/csv_text.hpp"

namespace counterflex {
namespace {

using csv::Field;
using csv::Header;

/// What the reader knows while it goes through the lines.
struct Reader {
  std::string file;
  csv::Settings settings;
  std::optional<Header> header;
  Location header_place;
  ForceProfile profile;
  int line = 0;
  int empty_line = 0;  ///< an empty line among the rows, allowed only where no row follows

  Location at(int column) const { return {file, line, column}; }
};

[[noreturn]] void fail(const Location& where, const std::string& message) {
  throw InputError(Exit::machine_or_force, where, message);
}

std::string row_name(const Reader& reader) {
  return fmt::format("row {}", reader.profile.rows.size() + 1);
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

/// The key in SI. Throws where it is not one that a program can have, or does not increase.
double key_of(const Reader& reader, const Field& field) {
  const ForceKey key = reader.header->key;
  const std::string name = csv::key_name(key);
  const double shown = number_of(reader, field, name);
  const bool counted = key == ForceKey::line || key == ForceKey::block_number;
  const double least = key == ForceKey::line ? 1 : 0;
  if (shown < least || (counted && shown != std::floor(shown))) {
    fail(reader.at(field.column), fmt::format("{}: {} is {}, must be a {}number from {} up", row_name(reader),
                                              name, field.text, counted ? "whole " : "", least));
  }
  const double value = shown / csv::shown_per_si(key);
  const auto& rows = reader.profile.rows;
  if (!rows.empty() && value <= rows.back().key) {
    fail(reader.at(field.column),
         fmt::format("{}: {} is {}, must be greater than the {:.12g} of the row before", row_name(reader),
                     name, field.text, rows.back().key * csv::shown_per_si(key)));
  }
  return value;
}

void read_row(std::string_view text, Reader& reader) {
  const auto fields = csv::split(text);
  const auto& columns = reader.header->columns;
  if (fields.size() != columns.size()) {
    fail(reader.at(fields[std::min(fields.size(), columns.size()) - 1].column),
         fmt::format("{} has {} fields, the header has {}", row_name(reader), fields.size(), columns.size()));
  }
  ForceRow row;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (columns[i].component) {
      row.F[*columns[i].component] = number_of(reader, fields[i], columns[i].name);
    } else {
      row.key = key_of(reader, fields[i]);
      row.where = reader.at(fields[i].column);
    }
  }
  if (*reader.settings.on_workpiece) row.F = -row.F;
  reader.profile.rows.push_back(row);
}

void read_comment(const Field& comment, Reader& reader) {
  if (!csv::is_setting(comment.text)) return;
  const Location where = reader.at(comment.column);
  if (reader.header) fail(where, "a setting after the header row, it must stand before");
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
  } else {
    if (reader.empty_line != 0) {
      fail({reader.file, reader.empty_line, 1},
           fmt::format("an empty line before {}, rows must follow each other", row_name(reader)));
    }
    read_row(text, reader);
  }
}

ForceProfile finished(Reader reader) {
  if (!reader.header) {
    fail({reader.file, std::max(reader.line, 1), 1},
         "no header row, such as 's_mm,fx_N,fy_N,fz_N' after the lines that begin with '#'");
  }
  if (reader.profile.rows.empty())
    fail(reader.header_place, "no rows after the header, at least one is required");
  reader.profile.key = reader.header->key;
  reader.profile.frame = *reader.settings.frame;
  reader.profile.linear = reader.settings.linear.value_or(false);
  reader.profile.at_platform = reader.settings.at_platform.value_or(false);
  return std::move(reader.profile);
}

}  // namespace

ForceProfile read_force_csv(std::string_view text, const std::string& file) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.substr(0, 3) == byte_order_mark) text.remove_prefix(3);
  Reader reader;
  reader.file = file;
  while (!text.empty()) {
    ++reader.line;
    read_line(csv::take_line(text), reader);
  }
  return finished(std::move(reader));
}

}  // namespace counterflex
