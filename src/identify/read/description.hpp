#pragma once
/// A TOML file of the format "counterflex-measurements 1": the columns of a CSV file.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "counterflex/identify/measurements.hpp"
#include "identify/read/columns.hpp"

namespace counterflex::measurement_file {

struct Description {
  std::string file;  ///< of the description
  std::string csv;   ///< path of the measurements
  std::optional<MeasurementKind> kind;
  std::string session;
  std::string direction;      ///< of all rows without a column for it: signs, or "previous"
  std::string states;         ///< path of a second table with the actuator values; empty: none
  int names_line = 0;         ///< of the row of names, from 1; 0: the first row that is not a comment
  int units_line = 0;         ///< of a row of units; 0: none
  int first_row = 0;          ///< line of the first row with numbers; 0: the one behind names and units
  bool has_no_names = false;  ///< columns are "#1", "#2"
  char separator = 0;         ///< ' ': blanks; 0: found in the row of names
  bool is_mapped = false;     ///< it names columns; all others are ignored
  std::vector<std::pair<std::string, Quantity>> names;  ///< of columns in the CSV file
  Columns constants;                                    ///< quantities that are the same in all rows
  Pose X_TB;                                            ///< probe B in the tip's frame
  bool has_known_frame = false;                         ///< see `Session`
  std::optional<double> probe_sigma;                    ///< m, of its position
  /// The rotation that three angles (rad) of a measured orientation mean.
  std::function<Matrix3(const Vector3&)> rotation_of = exp_so3;
};

/// Throws `InputError` (ErrorKind::machine_or_force) with line and column.
Description read_description(std::string_view text, const std::string& file, const Machine& machine);

}  // namespace counterflex::measurement_file
