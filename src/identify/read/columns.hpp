#pragma once
/// The columns of a measurement file: which quantity each one has, and in which unit.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex::measurement_file {

/// Where a quantity is read.
struct Column {
  std::size_t index = 0;           ///< of the field
  double si = 1;                   ///< its unit in SI
  std::optional<double> constant;  ///< SI: the same for all rows, no field
  bool is_angle = false;           ///< its unit is one of angles
};

/// Quantities by name: "q1" to "q9", "x", "rx", "fx", "mx", "gx", "mass", "gauge_x", "force_x", "reading",
/// "length", "radius", "sigma", "sigma_angle", "sigma_squareness", "sigma_scale", "squareness", "scale",
/// "position", "deviation", "reversal", "torque"; texts "session", "kind", "bar", "axes", "axis",
/// "direction", "point", "phase", "place".
using Columns = std::map<std::string, Column, std::less<>>;

/// The quantity and unit of a column's name, "q1_deg". Names of actuators, "X_mm" and "A1_deg", are those of
/// `q1` and so on. None for other names.
struct Quantity {
  std::string name;
  double si = 1;
  bool is_angle = false;
  std::string unit{};  ///< as in the column's name; empty: none
};
std::optional<Quantity> quantity_of(std::string_view column, const Machine& machine);

/// The name of an actuator without its kind: "X" of "axis X", "A1" of "axis A1".
std::string_view letter_of(const std::string& actuator);

/// All names that a column may have, for diagnostics.
std::string column_names(const Machine& machine);

/// The number in a field. With `decimal_comma` the only comma of a field without a point is its point.
/// Throws at the field.
double number_of(const csv::Field& field, std::string_view name, bool decimal_comma, const Location& line);

}  // namespace counterflex::measurement_file
