#include "identify/read/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex::measurement_file {
namespace {

char separator_of(std::string_view line) {
  return line.find(';') != std::string_view::npos    ? ';'
         : line.find('\t') != std::string_view::npos ? '\t'
                                                     : ',';
}

bool is_comment(std::string_view line) {
  return csv::trimmed(line).empty() || csv::trimmed(line).starts_with('#');
}

/// Fields between blanks.
std::vector<csv::Field> words_of(std::string_view line) {
  std::vector<csv::Field> fields;
  for (std::size_t begin = 0;;) {
    begin = line.find_first_not_of(" \t", begin);
    if (begin == std::string_view::npos) return fields;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    fields.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = end;
  }
}

/// "mm" of "[mm]", "(mm)" and " mm".
std::string_view bare_unit(std::string_view text) {
  text = csv::trimmed(text);
  const bool is_enclosed = text.size() >= 2 && (text.front() == '[' || text.front() == '(');
  return is_enclosed ? csv::trimmed(text.substr(1, text.size() - 2)) : text;
}

/// Units that programs of trackers write for ours.
bool is_same_unit(std::string_view written, const std::string& unit) {
  std::string lower;
  for (const char c : written) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == unit || written == unit) return true;
  const std::string_view names = unit == "mm"    ? "millimeter millimeters millimetres millimetre"
                                 : unit == "m"   ? "meter meters metre metres"
                                 : unit == "in"  ? "inch inches \""
                                 : unit == "um"  ? "micrometer micron microns \xC2\xB5m"
                                 : unit == "deg" ? "degree degrees \xC2\xB0"
                                 : unit == "rad" ? "radian radians"
                                                 : "";
  for (const csv::Field& name : words_of(names))
    if (name.text == lower) return true;
  return false;
}

}  // namespace

Table::Table(std::string_view text, const std::string& file, const Description& description,
             const Machine& machine)
    : rest_(text), where_{file, 0, 1}, description_(description), machine_(machine) {
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  std::string_view line;
  const auto go_to = [&](int number, std::string_view key) {
    while (where_.line < number) {
      if (rest_.empty())
        csv::fail({file, 0, 0}, fmt::format("the file has {} lines; {} of {} is {}", where_.line, key,
                                            description_.file, number));
      line = csv::take_line(rest_);
      ++where_.line;
    }
  };
  if (description_.names_line > 0)
    go_to(description_.names_line, "names_line");
  else if (!description_.has_no_names && !next_line(line))
    csv::fail({file, 0, 0}, "the file has no row with the names of its columns");
  if (description_.has_no_names) {
    // Columns are "#1", "#2": the first row of numbers has them.
    go_to(description_.first_row - 1, "first_row");
    std::string_view ahead = rest_;
    do line = csv::take_line(ahead);
    while (!ahead.empty() && is_comment(line));
  }
  separator_ = description_.separator != 0 ? description_.separator : separator_of(line);
  std::vector<csv::Field> names = split(line);
  std::vector<std::string> numbers;
  if (description_.has_no_names) {
    for (std::size_t i = 0; i < names.size(); ++i) numbers.push_back(fmt::format("#{}", i + 1));
    for (std::size_t i = 0; i < names.size(); ++i) names[i].text = numbers[i];
  }
  read_names(names);
  if (description_.units_line > 0) {
    go_to(description_.units_line, "units_line");
    check_units(line);
  }
  go_to(description_.first_row - 1, "first_row");
  if (!description_.states.empty()) read_states();
  for (const auto& [name, quantity] : description_.names)
    if (const auto found = columns_.find(quantity.name); found == columns_.end())
      csv::fail({file, where_.line, 1},
                fmt::format("the file has no column \"{}\", which {} names", name, description_.file));
}

bool Table::next_line(std::string_view& line) {
  while (!rest_.empty()) {
    line = csv::take_line(rest_);
    ++where_.line;
    if (!is_comment(line) && !(description_.is_mapped && csv::trimmed(line).starts_with("//"))) return true;
  }
  return false;
}

std::vector<csv::Field> Table::split(std::string_view line) const {
  return separator_ == ' ' ? words_of(line) : csv::split(line, 1, separator_);
}

void Table::read_names(const std::vector<csv::Field>& fields) {
  count_ = fields.size();
  columns_ = description_.constants;
  std::set<std::string, std::less<>> seen;
  std::map<std::string, std::size_t> of_quantity;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Location at{where_.file, where_.line, fields[i].column};
    if (description_.is_mapped) {
      for (const auto& [name, quantity] : description_.names) {
        if (name != fields[i].text) continue;
        if (!seen.insert(name).second)
          csv::fail(at, fmt::format("column \"{}\" is there twice", without_controls(fields[i].text)));
        columns_[quantity.name] = {i, quantity.si, {}, quantity.is_angle};
      }
      continue;
    }
    if (!seen.insert(std::string(fields[i].text)).second)
      csv::fail(at, fmt::format("column \"{}\" is there twice", without_controls(fields[i].text)));
    const std::optional<Quantity> quantity = quantity_of(fields[i].text, machine_);
    if (!quantity)
      csv::fail(at, fmt::format("unknown column \"{}\"; known columns: {}", without_controls(fields[i].text),
                                column_names(machine_)));
    if (const auto [other, is_new] = of_quantity.emplace(quantity->name, i); !is_new)
      csv::fail(at,
                fmt::format("columns \"{}\" and \"{}\" are the same quantity; keep one",
                            without_controls(fields[other->second].text), without_controls(fields[i].text)));
    columns_[quantity->name] = {i, quantity->si, {}, quantity->is_angle};
  }
}

void Table::check_units(std::string_view line) const {
  const std::vector<csv::Field> fields = split(line);
  for (const auto& [name, quantity] : description_.names) {
    const auto column = columns_.find(quantity.name);
    if (column == columns_.end() || column->second.index >= fields.size()) continue;
    const csv::Field& field = fields[column->second.index];
    const std::string_view written = bare_unit(field.text);
    if (!written.empty() && !is_same_unit(written, quantity.unit))
      csv::fail({where_.file, where_.line, field.column},
                fmt::format("the unit of column \"{}\" is {}; {} reads it as {}_{}", name,
                            without_controls(written), description_.file, quantity.name, quantity.unit));
  }
}

void Table::read_states() {
  states_text_ = read_file(description_.states);
  Description plain;
  plain.file = description_.states;
  Table table(states_text_, description_.states, plain, machine_);
  for (const auto& [name, column] : table.columns_) {
    if (name == "point") continue;
    if (columns_.find(name) != columns_.end())
      csv::fail({description_.states, table.where_.line, 1},
                fmt::format("{} has a column for {}, too", where_.file, name));
    columns_[name] = {count_ + column.index, column.si, {}, column.is_angle};
  }
  const bool has_points = table.has("point");
  if (has_points != has("point"))
    csv::fail({description_.states, table.where_.line, 1},
              "one of the two tables has no column \"point\"; without points in both, rows belong together "
              "in their order");
  states_have_decimal_commas_ = table.separator_ != ',';
  while (table.next()) {
    for (const auto& [name, column] : table.columns_)
      if (name.starts_with('q')) table.value(name);  // a bad number is reported at its own place
    if (has_points && !state_of_.emplace(std::string(table.text("point")->text), states_.size()).second)
      table.fail("point",
                 fmt::format("point \"{}\" is there twice", without_controls(table.text("point")->text)));
    states_.push_back(table.fields_);
  }
}

bool Table::next() {
  std::string_view line;
  if (!next_line(line)) return false;
  fields_ = split(line);
  // Some programs end each row with a separator.
  if (fields_.size() == count_ + 1 && fields_.back().text.empty()) fields_.pop_back();
  if (fields_.size() != count_)
    csv::fail({where_.file, where_.line, 1},
              fmt::format("the row has {} fields; the first row names {} columns", fields_.size(), count_));
  if (!description_.states.empty()) {
    std::size_t state = row_;
    if (has("point")) {
      const auto found = state_of_.find(text("point")->text);
      if (found == state_of_.end())
        fail("point", fmt::format("{} has no point \"{}\"", description_.states,
                                  without_controls(text("point")->text)));
      state = found->second;
    }
    if (state >= states_.size())
      csv::fail({where_.file, where_.line, 1}, fmt::format("{} has {} rows, and this is row {}",
                                                           description_.states, states_.size(), row_ + 1));
    fields_.insert(fields_.end(), states_[state].begin(), states_[state].end());
  }
  ++row_;
  return true;
}

bool Table::is_filled(std::string_view name) const {
  const auto found = columns_.find(name);
  return found != columns_.end() && (found->second.constant || !fields_[found->second.index].text.empty());
}

double Table::value(std::string_view name) const {
  const Column& column = columns_.find(name)->second;
  if (column.constant) return *column.constant;
  const bool has_decimal_commas = column.index < count_ ? separator_ != ',' : states_have_decimal_commas_;
  return number_of(fields_[column.index], name, has_decimal_commas, where_) * column.si;
}

const csv::Field* Table::text(std::string_view name) const {
  const auto found = columns_.find(name);
  return found == columns_.end() || found->second.constant ? nullptr : &fields_[found->second.index];
}

Location Table::place_of(std::string_view name) const {
  const csv::Field* field = text(name);
  const bool is_here = field != nullptr && columns_.find(name)->second.index < count_;
  return {where_.file, where_.line, is_here ? field->column : 1};
}

void Table::fail(std::string_view name, const std::string& message) const {
  csv::fail(place_of(name), message);
}

}  // namespace counterflex::measurement_file
