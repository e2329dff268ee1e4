#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/import/import.hpp"
#include "import/serial_arm.hpp"
#include "import/toml_text.hpp"

namespace counterflex {
namespace import {
namespace {

constexpr std::size_t most_joints = 12;

struct Cell {
  std::string_view text;
  Location at;
};

/// The cells of the lines that are neither blank nor comments. Cells are separated by semicolons, if the
/// header has one, else by commas.
std::vector<std::vector<Cell>> rows_of(std::string_view text, const std::string& file, char& separator) {
  std::vector<std::vector<Cell>> rows;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view whole = csv::take_line(text), content = csv::trimmed(whole);
    if (content.empty() || content.starts_with('#')) continue;
    if (rows.empty()) separator = whole.find(';') != whole.npos ? ';' : ',';
    std::vector<Cell>& cells = rows.emplace_back();
    for (const csv::Field& field : csv::split(whole, 1, separator))
      cells.push_back({field.text, {file, line, field.column}});
  }
  return rows;
}

/// A quantity of a joint, and the columns that may give it, by unit.
struct Quantity {
  std::string_view name;
  std::array<std::string_view, 4> columns;
};
constexpr std::array<double, 4> units = {deg, 1, mm, 1};
constexpr bool is_length(std::size_t unit) {
  return unit >= 2;
}

constexpr std::array<Quantity, 7> quantities = {{{"a", {"", "", "a_mm", "a_m"}},
                                                 {"alpha", {"alpha_deg", "alpha_rad", "", ""}},
                                                 {"d", {"", "", "d_mm", "d_m"}},
                                                 {"theta", {"theta_deg", "theta_rad", "", ""}},
                                                 {"min", {"min_deg", "min_rad", "min_mm", "min_m"}},
                                                 {"max", {"max_deg", "max_rad", "max_mm", "max_m"}},
                                                 {"home", {"home_deg", "home_rad", "home_mm", "home_m"}}}};
constexpr std::size_t required_quantities = 4;

struct Column {
  std::string name;
  int quantity = -1;  ///< index in `quantities`; -1: `joint` or `type`
  std::size_t unit = 0;
};

std::vector<std::string_view> known_columns() {
  std::vector<std::string_view> known = {"joint", "type"};
  for (const Quantity& quantity : quantities)
    for (const std::string_view column : quantity.columns)
      if (!column.empty()) known.push_back(column);
  return known;
}

Column column_of(const Cell& cell) {
  Column column{std::string(cell.text)};
  if (cell.text == "joint" || cell.text == "type") return column;
  for (std::size_t q = 0; q < quantities.size(); ++q)
    for (std::size_t unit = 0; unit < units.size(); ++unit)
      if (!cell.text.empty() && cell.text == quantities[q].columns[unit])
        return {column.name, static_cast<int>(q), unit};
  const std::vector<std::string_view> known = known_columns();
  const std::string_view meant = nearest(cell.text, known);
  fail(cell.at,
       fmt::format("unknown column '{}'{}; allowed: {}", without_controls(cell.text),
                   meant.empty() ? "" : fmt::format("; did you mean {}?", meant), fmt::join(known, ", ")));
}

std::vector<Column> read_header(const std::vector<Cell>& cells) {
  std::vector<Column> columns;
  for (const Cell& cell : cells) {
    const Column column = column_of(cell);
    for (const Column& before : columns) {
      const bool same_unit = is_length(before.unit) == is_length(column.unit);
      if (before.name == column.name ||
          (column.quantity >= 0 && before.quantity == column.quantity && same_unit))
        fail(cell.at, fmt::format("column '{}' repeats '{}'; remove one", column.name, before.name));
    }
    columns.push_back(column);
  }
  for (std::size_t q = 0; q < required_quantities; ++q) {
    const bool given = std::any_of(columns.begin(), columns.end(), [&](const Column& column) {
      return column.quantity == static_cast<int>(q);
    });
    const auto& names = quantities[q].columns;
    if (!given)
      fail(cells.front().at,
           fmt::format("column {} is missing: a table has a, alpha, d and theta of each joint, with the "
                       "unit in the name ({} or {})",
                       quantities[q].name, names[0].empty() ? names[2] : names[0],
                       names[0].empty() ? names[3] : names[1]));
  }
  return columns;
}

/// One row: values in SI by quantity.
struct Row {
  std::string name;
  JointKind kind = JointKind::revolute;
  std::array<std::optional<double>, quantities.size()> values{};

  double operator[](std::size_t quantity) const { return values[quantity].value_or(0); }
};

double number_in(const Cell& cell, char separator, const std::string& name) {
  std::string text(cell.text);
  if (separator == ';') std::replace(text.begin(), text.end(), ',', '.');
  return read_usable(text, cell.at, name);
}

void check_home(const Row& row, const Location& at) {
  const auto &min = row.values[4], &max = row.values[5], &home = row.values[6];
  const bool is_below = home && min && *home < *min - 1e-9, is_above = home && max && *home > *max + 1e-9;
  if (!is_below && !is_above) return;
  const bool turns = row.kind == JointKind::revolute;
  const auto shown = [&](double value) {
    return turns ? fmt::format("{:.9g} deg", value / deg) : fmt::format("{:.9g} mm", value / mm);
  };
  const std::string where = min && max
                                ? fmt::format("outside its travel from {} to {}", shown(*min), shown(*max))
                            : is_below ? "below its min, " + shown(*min)
                                       : "above its max, " + shown(*max);
  fail(at, fmt::format("the joint's home, {}, is {}", shown(*home), where));
}

Row read_row(const std::vector<Cell>& cells, const std::vector<Column>& columns, char separator) {
  if (cells.size() != columns.size())
    fail(cells.front().at,
         fmt::format("the row has {} cells, the header has {} columns", cells.size(), columns.size()));
  Row row;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == "joint") row.name = cells[i].text;
    if (columns[i].name != "type" || cells[i].text.empty()) continue;
    if (cells[i].text != "revolute" && cells[i].text != "prismatic")
      fail(cells[i].at,
           fmt::format("type is '{}'; it must be revolute or prismatic", without_controls(cells[i].text)));
    row.kind = cells[i].text == "revolute" ? JointKind::revolute : JointKind::prismatic;
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].quantity < 0) continue;
    const auto quantity = static_cast<std::size_t>(columns[i].quantity);
    if (cells[i].text.empty()) {
      if (quantity < required_quantities)
        fail(cells[i].at, fmt::format("{} is empty; a joint needs it", columns[i].name));
      continue;
    }
    const bool of_joint = quantity >= required_quantities;
    if (of_joint && is_length(columns[i].unit) != (row.kind == JointKind::prismatic))
      fail(cells[i].at, fmt::format("{} is given for a {} joint; leave the cell empty", columns[i].name,
                                    row.kind == JointKind::prismatic ? "prismatic" : "revolute"));
    row.values[quantity] = number_in(cells[i], separator, columns[i].name) * units[columns[i].unit];
  }
  if (row.values[4] && row.values[5] && !(*row.values[4] + 1e-9 < *row.values[5]))
    fail(cells.front().at, "the joint's max is not above its min");
  check_home(row, cells.front().at);
  return row;
}

ArmJoint joint_of(const Row& row, DhConvention convention) {
  const double a = row[0], alpha = row[1], d = row[2], theta = row[3];
  ArmJoint joint;
  joint.name = row.name;
  joint.joint.kind = row.kind;
  joint.min = row.values[4];
  joint.max = row.values[5];
  joint.home = row.values[6];
  if (convention == DhConvention::modified) joint.before.push_back({{a, 0, 0}, {alpha, 0, 0}});
  joint.before.push_back({Vector3::Zero(), {0, 0, theta}});
  if (convention == DhConvention::modified)
    joint.after.push_back({{0, 0, d}, Vector3::Zero()});
  else
    joint.after.push_back({{a, 0, d}, {alpha, 0, 0}});
  return joint;
}

}  // namespace
}  // namespace import

std::string import_dh(std::string_view text, const std::string& file, DhConvention convention) {
  using namespace import;
  char separator = ',';
  const auto rows = rows_of(text, file, separator);
  if (rows.empty()) fail({file, 1, 1}, "the table is empty; its first line names the columns");
  const std::vector<Column> columns = read_header(rows.front());
  if (rows.size() < 2)
    fail(rows.front().front().at, "the table has no joint; each line behind the header is one");
  if (rows.size() > most_joints + 1)
    fail(rows[most_joints + 1].front().at, fmt::format("the table has more than {} joints", most_joints));
  const bool standard = convention == DhConvention::standard;
  SerialArm arm;
  arm.name = file_stem(file);
  arm.head = {fmt::format("{}dh: the Denavit-Hartenberg parameters of {}", import_mark, file_name(file)),
              standard ? "# Convention: standard, Rz(theta) Tz(d) Tx(a) Rx(alpha)."
                       : "# Convention: modified, Rx(alpha) Tx(a) Rz(theta) Tz(d) of Craig."};
  for (std::size_t i = 1; i < rows.size(); ++i)
    arm.joints.push_back(joint_of(read_row(rows[i], columns, separator), convention));
  arm.kinematics_comment = "PLACEHOLDER: the control computes with the lengths of the table";
  arm.mass_comment =
      "the table has none. Add mass = { kg = ..., at_mm = [...], name = \"...\" } to elements, and "
      "gravity_m_s2";
  return machine_text(arm);
}

}  // namespace counterflex
