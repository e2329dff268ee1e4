#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/measurements.hpp"
#include "counterflex/machine/read_machine.hpp"

using namespace counterflex;

namespace {

Machine mill() {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml");
}

Measurements read(const std::string& csv, const Machine& machine = mill()) {
  Measurements all;
  read_measurements(csv, "data.csv", machine, all);
  return all;
}

std::string error_of(const std::string& csv) {
  try {
    read(csv);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a session has stated deviations if any of its rows has one, in any order") {
  const std::string head = "kind,X_mm,Y_mm,Z_mm,fx_N,gx,gy,gz,reading_um,sigma_um\n";
  const std::string with = "static_push,10,0,0,400,1,0,0,20,4\n",
                    without = "static_push,20,0,0,400,1,0,0,20,\n";
  for (const std::string& rows : {with + without, without + with}) {
    const Measurements all = read(head + rows);
    REQUIRE(all.sessions.size() == 1);
    CHECK(all.sessions[0].sigma_given);
  }
  CHECK_FALSE(read(head + without + without).sessions[0].sigma_given);
}

TEST_CASE("columns have units in their names, and actuators have numbers or letters") {
  const Measurements all = read(
      "kind,session,X_mm,q2_m,Z_in,x_mm,y_m,z_in,sigma_um\n"
      "tracker_point,one,10,0.02,1,1,2,3,40\n");
  REQUIRE(all.rows.size() == 1);
  CHECK(all.rows[0].states[0].shown.isApprox(Vector3(0.01, 0.02, 0.0254), 1e-12));
  CHECK(all.rows[0].X.p.isApprox(Vector3(0.001, 2, 0.0762), 1e-12));
  CHECK(all.rows[0].sigma / 4e-5 == doctest::Approx(1));
  CHECK(all.sessions[0].name == "one");
  CHECK(all.sessions[0].sigma_given);
}

TEST_CASE("files of one name in two folders are two sessions") {
  const std::string row = "kind,X_mm,Y_mm,Z_mm,x_mm,y_mm,z_mm\ntracker_point,10,20,30,1,2,3\n";
  const Machine machine = mill();
  Measurements all;
  for (const std::string file :
       {"day1/tracker.csv", "day2/tracker.csv", "day2/tracker.csv", "day2/other.csv"})
    read_measurements(row, file, machine, all);
  std::vector<std::string> names;
  for (const Session& session : all.sessions) names.push_back(session.name);
  CHECK(names == std::vector<std::string>{"tracker", "day2/tracker.csv", "other"});
}

TEST_CASE("semicolons come with decimal commas") {
  const Measurements all = read(
      "# an export\n"
      "kind;X_mm;Y_mm;Z_mm;x_mm;y_mm;z_mm\r\n"
      "tracker_point;1,5;2.5;-3;1E+02;0;0,25\r\n");
  CHECK(all.rows[0].states[0].shown.isApprox(Vector3(0.0015, 0.0025, -0.003), 1e-12));
  CHECK(all.rows[0].X.p.isApprox(Vector3(0.1, 0, 0.00025), 1e-12));
  CHECK_FALSE(all.sessions[0].sigma_given);
}

TEST_CASE("a push has the machine with and without its force") {
  const Measurements all = read(
      "kind,X_mm,Y_mm,Z_mm,fx_N,fy_N,fz_N,gx,gy,gz,reading_um\n"
      "static_push,0,0,0,200,0,0,2,0,0,7\n");
  REQUIRE(all.rows[0].states.size() == 2);
  CHECK(all.rows[0].states[0].F[0] == 200);
  CHECK(all.rows[0].states[1].F.isZero(0));
  CHECK(all.rows[0].direction.isApprox(Vector3::UnitX(), 1e-12));
  CHECK(all.rows[0].value / 7e-6 == doctest::Approx(1));
}

TEST_CASE("the two rows of a bar are one measurement") {
  const Measurements all = read(
      "kind,X_mm,Y_mm,Z_mm,bar,length_mm\n"
      "length_bar,0,0,0,a,300.01\n"
      "length_bar,300,0,0,a,300.01\n");
  REQUIRE(all.rows.size() == 1);
  CHECK(all.rows[0].states.size() == 2);
  CHECK(all.rows[0].value == doctest::Approx(0.30001));
}

TEST_CASE("a squareness names two linear axes") {
  const Measurements all = read("kind,axes,squareness_um_per_m\nsquareness,XY,-18\n");
  REQUIRE(all.rows.size() == 1);
  CHECK(all.rows[0].states.size() == 4);
  CHECK(all.rows[0].value / -18e-6 == doctest::Approx(1));
}

TEST_CASE("the deviation of a squareness is an angle in a column of its own") {
  const Measurements all = read(
      "kind,axes,squareness_arcsec,sigma_squareness_um_per_m,sigma_um,X_mm,Y_mm,Z_mm,x_mm,y_mm,z_mm\n"
      "squareness,XY,2,3,,,,,,,\n"
      "tracker_point,,,,40,1,2,3,1,2,3\n");
  REQUIRE(all.rows.size() == 2);
  CHECK(all.rows[0].value / (2 * deg / 3600) == doctest::Approx(1));
  CHECK(all.rows[0].sigma / 3e-6 == doctest::Approx(1));
  CHECK(all.rows[1].sigma / 40e-6 == doctest::Approx(1));
  CHECK(error_of("kind,axes,squareness_um_per_m,sigma_um\nsquareness,XY,-18,2\n") ==
        "data.csv:2:19: error: sigma is a length; give the deviation of a squareness in a column "
        "sigma_squareness_um_per_m, and leave this field empty");
}

TEST_CASE("bad measurements are refused at their place") {
  CHECK(error_of("") == "data.csv: error: the file has no row with the names of its columns");
  CHECK(error_of("kind,speed\n")
            .starts_with("data.csv:1:6: error: unknown column \"speed\"; known columns: q1_mm, "));
  CHECK(error_of("kind,X_mm,X_mm\n") == "data.csv:1:11: error: column \"X_mm\" is there twice");
  CHECK(error_of("kind,X_mm,X_in,Y_mm,Z_mm,x_mm,y_mm,z_mm\n") ==
        "data.csv:1:11: error: columns \"X_mm\" and \"X_in\" are the same quantity; keep one");
  const std::string header = "kind,X_mm,Y_mm,Z_mm,x_mm,y_mm,z_mm\n";
  CHECK(
      error_of(header + "tracker,0,0,0,0,0,0\n") ==
      "data.csv:2:1: error: kind is \"tracker\"; it must be one of tracker_point, tracker_pose, static_push, "
      "hung_weight, plane_contact, length_bar, squareness, axis_position, axis_table, reversal, scale, "
      "clamped_torque, ballbar, repeat");
  CHECK(error_of(header + "tracker_point,0,0,0,0,nan,0\n") ==
        "data.csv:2:23: error: y is \"nan\"; it must be a number");
  CHECK(error_of(header + "tracker_point,0,0,0,0\n") ==
        "data.csv:2:1: error: the row has 5 fields; the first row names 7 columns");
  CHECK(error_of(header + "static_push,0,0,0,0,0,0\n") ==
        "data.csv:2:1: error: rows of kind static_push need a column \"reading\"");
  CHECK(error_of("kind,X_mm,Y_mm,Z_mm,bar,length_mm\nlength_bar,0,0,0,a,300\n") ==
        "data.csv:2:1: error: bar \"a\" has one end; a bar has two rows, one for each end");
  CHECK(error_of("kind,X_mm,Y_mm,Z_mm,bar,length_mm\nlength_bar,0,0,0,a,300\nlength_bar,0,50,0,a,300.5\n") ==
        "data.csv:3:21: error: the length of the bar is 300.5 mm here and 300 mm in line 2");
  CHECK(error_of("kind,axes,squareness_um_per_m,radius_mm\nsquareness,XY,-18,0\n") ==
        "data.csv:2:19: error: the radius is 0 mm; it must be above 0");
  CHECK(error_of("kind,axis,scale_um_per_m,radius_mm\nscale,X,20,-5\n") ==
        "data.csv:2:12: error: the radius is -5 mm; it must be above 0");
  CHECK(error_of("kind,axes,squareness_um_per_m\nsquareness,XB,-18\n") ==
        "data.csv:2:12: error: axes is \"XB\"; it must name two linear axes of the machine, as XY");
}

TEST_CASE("a weight hangs along gravity, also where the control corrects the weight of the machine") {
  std::string text = read_file(COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml");
  text.insert(text.find("name ="), "gravity_m_s2 = [0, 0, 9.81]\n");
  text += "\n[controller]\nalready_corrects = [\"gravity\"]\n";
  const Measurements all = read(
      "kind,X_mm,Y_mm,Z_mm,fx_N,gx,gy,gz,mass_kg,reading_um\nhung_weight,0,0,0,,,,,20,40\n"
      "static_push,0,0,0,100,1,0,0,,7\n",
      read_machine(text, "ceiling.toml"));
  CHECK(all.rows[0].states[0].F[2] == doctest::Approx(196.2));
  CHECK(all.rows[0].direction.isApprox(Vector3::UnitZ()));
}

TEST_CASE("a description states the frame of its rows and where the probe is expected") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const std::string table = (folder / "counterflex_described.csv").string(),
                    description = (folder / "counterflex_described.toml").string();
  std::ofstream(table) << "X_mm,Y_mm,Z_mm,a,b,c\n1,2,3,4,5,6\n";
  const auto described = [&](const std::string& lines) {
    std::ofstream(description) << "format = \"counterflex-measurements 1\"\n"
                                  "file = \"counterflex_described.csv\"\nkind = \"tracker_point\"\n"
                               << lines
                               << "[columns]\nX_mm = \"X_mm\"\nY_mm = \"Y_mm\"\nZ_mm = \"Z_mm\"\n"
                                  "x_mm = \"a\"\ny_mm = \"b\"\nz_mm = \"c\"\n";
    Measurements all;
    load_measurements(description, mill(), all);
    REQUIRE(all.sessions.size() == 1);
    return all.sessions[0];
  };
  const Session plain = described("");
  CHECK_FALSE(plain.has_known_frame);
  CHECK(plain.probe_sigma == 0.3);
  const Session stated = described("frame = \"machine\"\nprobe = { xyz_mm = [1, 2, 3], sigma_mm = 2 }\n");
  CHECK(stated.has_known_frame);
  CHECK(stated.X_TB.p.isApprox(Vector3(1e-3, 2e-3, 3e-3), 1e-12));
  CHECK(stated.probe_sigma / 2e-3 == doctest::Approx(1));
  CHECK_THROWS_AS(described("probe = { sigma_mm = 0 }\n"), InputError);
}
