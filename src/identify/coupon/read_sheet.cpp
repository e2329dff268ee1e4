#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/coupon.hpp"
#include "identify/coupon/sheet_columns.hpp"
#include "identify/read/columns.hpp"

namespace counterflex {
namespace {

using measurement_file::number_of;

constexpr double farthest = 5 * mm;  // a measured value from its nominal one

bool is_table_line(std::string_view line) {
  return line.find_first_not_of(" \t,;\"") != std::string_view::npos &&
         line[line.find_first_not_of(" \t\"")] != '#';
}

char separator_of(std::string_view header) {
  if (header.find(';') != std::string_view::npos) return ';';
  return header.find('\t') != std::string_view::npos ? '\t' : ',';
}

/// Fields without the quotes that a spreadsheet adds.
std::vector<csv::Field> fields_of(std::string_view line, char separator) {
  std::vector<csv::Field> fields = csv::split(line, 1, separator);
  for (csv::Field& field : fields)
    if (field.text.size() >= 2 && field.text.front() == '"' && field.text.back() == '"')
      field.text = field.text.substr(1, field.text.size() - 2);
  return fields;
}

/// Reads both tables of a sheet.
class SheetReader {
 public:
  SheetReader(const std::string& file, const Machine& machine, Measurements& all)
      : file_(file), machine_(machine), all_(all), actuators_(actuators(machine)) {}

  void read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    Location where{file_, 0, 1};
    while (!text.empty()) {
      const std::string_view line = csv::take_line(text);
      ++where.line;
      if (!is_table_line(line)) continue;
      if (columns_.empty()) separator_ = separator_of(line);
      fields_ = fields_of(line, separator_);
      if (fields_[0].text == "feature" || fields_[0].text == "place_of")
        read_header(where);
      else if (is_places_)
        read_place(where);
      else
        read_quantity(where);
    }
    add_rows();
  }

 private:
  void read_header(const Location& where) {
    is_places_ = fields_[0].text == "place_of";
    columns_.clear();
    for (std::size_t i = 0; i < fields_.size(); ++i) columns_.emplace(fields_[i].text, i);
    std::vector<std::string> needed = {"half", "quantity", "nominal_mm", "measured_mm", "sigma_um"};
    if (is_places_) {
      needed = {"half",  "quantity", "tool", "fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm",
                "mz_Nm", "x_mm",     "y_mm", "z_mm", "wx",   "wy",   "wz",    "wr"};
      for (std::size_t i = 0; i < actuators_.size(); ++i) {
        needed.push_back(value_column(actuators_[i], i));
        if (actuators_[i].reversal) needed.push_back(direction_column(i));
      }
    }
    for (const std::string& name : needed)
      if (!columns_.contains(name))
        csv::fail(
            {file_, where.line, 1},
            fmt::format("the table has no column \"{}\"; use the sheet as testcut wrote it for this machine",
                        name));
  }

  const csv::Field& field(const std::string& name, const Location& where) const {
    const std::size_t i = columns_.find(name)->second;
    if (i >= fields_.size())
      csv::fail(
          {file_, where.line, 1},
          fmt::format("the row has {} fields; the field of column \"{}\" is missing", fields_.size(), name));
    return fields_[i];
  }

  double number(const std::string& name, const Location& where) const {
    return number_of(field(name, where), name, separator_ != ',', where);
  }

  /// "wall 1, corrected, width_mm".
  std::string row_name(const Location& where) const {
    std::string name(fields_[0].text);
    for (const char* column : {"half", "quantity"})
      if (const csv::Field& part = field(column, where); !part.text.empty())
        name += ", " + without_controls(part.text);
    return without_controls(name);
  }

  void read_quantity(const Location& where) {
    const std::string name = row_name(where);
    Measurement row;
    row.at = {file_, where.line, 1};
    const auto [at, is_new] = rows_.emplace(name, std::nullopt);
    if (!is_new) csv::fail(row.at, fmt::format("the row of \"{}\" is there twice", name));
    const csv::Field& measured = field("measured_mm", where);
    if (measured.text.empty()) {
      ++all_.empty_rows;
      return;
    }
    const double value_mm = number("measured_mm", where), nominal_mm = number("nominal_mm", where);
    row.value = (value_mm - nominal_mm) * mm;
    if (std::abs(row.value) > farthest)
      csv::fail(
          {file_, where.line, measured.column},
          fmt::format("measured_mm is {:.6g}, {:.3g} mm from the nominal value {:.6g}; at most {} mm is "
                      "allowed: check the unit, the alignment and the row",
                      value_mm, row.value / mm, nominal_mm, farthest / mm));
    row.sigma = number("sigma_um", where) * um;
    if (!(row.sigma > 0))
      csv::fail({file_, where.line, field("sigma_um", where).column},
                fmt::format("sigma_um is {:.6g}; a standard deviation must be positive", row.sigma / um));
    order_.push_back(name);
    at->second = std::move(row);
  }

  int direction(const std::string& name, const Location& where) const {
    const double value = number(name, where);
    if (value != 0 && std::abs(value) != 1)
      csv::fail({file_, where.line, field(name, where).column},
                fmt::format("{} is {:.6g}; the direction of an actuator is 1, -1, or 0 where it is not known",
                            name, value));
    return static_cast<int>(value);
  }

  void read_place(const Location& where) {
    const std::string name = row_name(where);
    const auto found = rows_.find(name);
    if (found == rows_.end())
      csv::fail({file_, where.line, 1}, fmt::format("the first table has no row of \"{}\"", name));
    if (!found->second) return;
    Measurement& row = *found->second;
    CommandedState state;
    state.shown.resize(static_cast<Eigen::Index>(actuators_.size()));
    for (std::size_t i = 0; i < actuators_.size(); ++i) {
      state.shown[static_cast<Eigen::Index>(i)] =
          number(value_column(actuators_[i], i), where) *
          (actuators_[i].joint.kind == JointKind::revolute ? deg : mm);
      if (actuators_[i].reversal) state.directions.set(i, direction(direction_column(i), where));
    }
    state.F << number("fx_N", where), number("fy_N", where), number("fz_N", where), number("mx_Nm", where),
        number("my_Nm", where), number("mz_Nm", where);
    state.tool = static_cast<long>(number("tool", where));
    if (state.tool != 0 && !machine_.tools.contains(state.tool))
      csv::fail({file_, where.line, field("tool", where).column},
                fmt::format("tool T{} is not in the machine file; add it to [tools]", state.tool));
    row.states.push_back(std::move(state));
    row.places.push_back({Vector3(number("x_mm", where), number("y_mm", where), number("z_mm", where)) * mm,
                          Vector3(number("wx", where), number("wy", where), number("wz", where))});
    row.offset_share += number("wr", where);
  }

  void add_rows() {
    if (order_.empty())
      csv::fail({file_, 0, 0}, "no row has a measured value; write them into the column measured_mm");
    all_.sessions.push_back(
        {std::filesystem::path(file_).stem().generic_string(), MeasurementKind::cmm_feature, true, Pose{}});
    for (const std::string& name : order_) {
      Measurement& row = *rows_.at(name);
      if (row.states.empty())
        csv::fail(row.at, fmt::format("the sheet has no places of \"{}\"; keep the second table that testcut "
                                      "wrote",
                                      name));
      row.session = all_.sessions.size() - 1;
      all_.rows.push_back(std::move(row));
    }
  }

  std::string file_;
  const Machine& machine_;
  Measurements& all_;
  std::vector<Actuator> actuators_;
  char separator_ = ',';
  bool is_places_ = false;
  std::map<std::string, std::size_t, std::less<>> columns_;
  std::vector<csv::Field> fields_;
  std::map<std::string, std::optional<Measurement>> rows_;  ///< none: not measured
  std::vector<std::string> order_;                          ///< of the measured ones
};

}  // namespace

bool is_coupon_sheet(std::string_view csv) {
  if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);
  while (!csv.empty()) {
    const std::string_view line = csv::take_line(csv);
    if (is_table_line(line)) return fields_of(line, separator_of(line))[0].text == "feature";
  }
  return false;
}

void read_coupon_sheet(std::string_view csv, const std::string& file, const Machine& machine,
                       Measurements& all) {
  SheetReader(file, machine, all).read(csv);
}

}  // namespace counterflex
