/// Tables as programs of trackers write them, mapped by a description.
#include <doctest/doctest.h>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/measurements.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "files/folder.hpp"

using namespace counterflex;

namespace {

Machine sample_mill() {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml");
}

constexpr std::string_view states =
    "point,X_mm,Y_mm,Z_mm\n"
    "P2,20,0,-10\n"
    "P1,10,5,-20\n";

/// Semicolons, decimal commas, lines before the table, a row of units, a separator at the end of rows.
constexpr std::string_view leica =
    "Leica Geosystems AG;AT960;Job: cell 4\r\n"
    "Date;26.11.2026\r\n"
    "\r\n"
    "Point ID;X;Y;Z;RMS;Time\r\n"
    ";[mm];[mm];[mm];[mm];\r\n"
    "P1;1234,567;-20,5;3,25;0,004;10:21\r\n"
    "P2;1244,571;-25,5;13,25;0,005;10:22\r\n";

/// Blanks, comments, no names.
constexpr std::string_view faro =
    "// SpatialAnalyzer working frame: world\n"
    "// units: inches\n"
    "A::main P1  48.6050  -0.8071  0.1280\n"
    "A::main P2  48.9988  -1.0039  0.5217\n";

struct Export {
  test::Folder folder;

  Measurements read(std::string_view table, std::string_view description) const {
    write_file(folder.file("table.txt"), table);
    write_file(folder.file("states.csv"), states);
    write_file(folder.file("map.toml"), description);
    Measurements all;
    load_measurements(folder.file("map.toml"), sample_mill(), all);
    return all;
  }

  std::string error_of(std::string_view table, std::string_view description) const {
    try {
      read(table, description);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder.path.string().size() + 1);
    }
    return "";
  }
};

constexpr std::string_view leica_map = R"(
format = "counterflex-measurements 1"
file = "table.txt"
states = "states.csv"
kind = "tracker_point"
names_line = 4
units_line = 5
[columns]
point = "Point ID"
x_mm = "X"
y_mm = "Y"
z_mm = "Z"
sigma_mm = 0.02
)";

}  // namespace

TEST_CASE(
    "an export with lines before its table, units, decimal commas and actuator values in another file") {
  const Measurements all = Export{}.read(leica, leica_map);
  REQUIRE(all.rows.size() == 2);
  CHECK(all.rows[0].X.p.isApprox(Vector3(1.234567, -0.0205, 0.00325), 1e-12));
  CHECK(all.rows[0].states[0].shown.isApprox(Vector3(0.010, 0.005, -0.020), 1e-12));
  CHECK(all.rows[1].states[0].shown.isApprox(Vector3(0.020, 0, -0.010), 1e-12));
  CHECK(all.rows[1].at.line == 7);
}

TEST_CASE("an export without names has columns by number") {
  const Measurements all = Export{}.read(faro, R"(
format = "counterflex-measurements 1"
file = "table.txt"
states = "states.csv"
kind = "tracker_point"
names_line = 0
first_row = 3
separator = "blank"
[columns]
point = "#2"
x_in = "#3"
y_in = "#4"
z_in = "#5"
)");
  REQUIRE(all.rows.size() == 2);
  CHECK(all.rows[0].X.p.isApprox(Vector3(48.6050, -0.8071, 0.1280) * inch, 1e-12));
  CHECK(all.rows[0].states[0].shown.isApprox(Vector3(0.010, 0.005, -0.020), 1e-12));
}

TEST_CASE("exports that do not fit their description are refused at their place") {
  const Export files;
  std::string inches(leica_map);
  inches.replace(inches.find("x_mm"), 4, "x_in");
  CHECK(files.error_of(leica, inches).starts_with("table.txt:5:2: error: the unit of column \"X\" is mm; "));
  std::string other(leica_map);
  other.replace(other.find("\"Y\""), 3, "\"y\"");
  CHECK(
      files.error_of(leica, other).starts_with("table.txt:5:1: error: the file has no column \"y\", which "));
  std::string point(leica);
  point.replace(point.find("P2"), 2, "P7");
  const std::string unknown = files.error_of(point, leica_map);
  CHECK(unknown.starts_with("table.txt:7:1: error: "));
  CHECK(unknown.ends_with("states.csv has no point \"P7\""));
  std::string behind(leica_map);
  behind.replace(behind.find("units_line = 5"), 14, "units_line = 3");
  CHECK(files.error_of(leica, behind) ==
        "map.toml:7:14: error: units_line is 3; it must be behind names_line (4)");
}
