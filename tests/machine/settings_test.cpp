#include <doctest/doctest.h>

#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

TEST_CASE("a machine file needs only its format and a chain; the rest has defaults") {
  const Machine machine = machine_with("");
  CHECK(machine.name.empty());
  CHECK(machine.controlled.empty());
  CHECK_FALSE(machine.home_X_MP.has_value());
  CHECK(machine.X_PT.p.isZero(0));
  CHECK(machine.work.empty());
  CHECK(machine.control.dialect == "auto");
  CHECK(machine.control.units.empty());
  CHECK_FALSE(machine.control.tool_change_moves.has_value());
  CHECK(machine.max_correction == 1e-3);
}

TEST_CASE("serial number and date of a machine file are kept; a date may be a date of TOML or be in quotes") {
  const Machine machine = machine_with("serial = \"VF2-\\u0007 0815\"\ndate = 2024-02-29\n");
  CHECK(machine.serial == "VF2-\\x07 0815");
  CHECK(machine.date == "2024-02-29");
  CHECK(describe(machine).find("serial       VF2-\\x07 0815\ndate         2024-02-29\n") !=
        std::string::npos);
  CHECK(machine_with("date = \"0999-12-31\"\n").date == "0999-12-31");
  CHECK(machine_with("").serial.empty());
  CHECK(machine_with("").date.empty());
}

TEST_CASE("controlled components have the order of six-vectors, for any order in the file") {
  const std::string three = "{ actuator = \"revolute\", axis = \"x\" }, " + x_axis + ", " + x_axis;
  const Machine machine = machine_of(three, "controlled = [\"rz\", \"y\", \"x\"]\n");
  CHECK(machine.controlled == std::vector{Component::x, Component::y, Component::rz});
}

TEST_CASE("an empty list of controlled components fits any number of actuators, seven too") {
  std::string seven = x_axis;
  for (int i = 1; i < 7; ++i) seven += ", " + x_axis;
  CHECK(machine_of(seven, "controlled = []\n").controlled.empty());
  CHECK(machine_of("{ rigid = {} }", "controlled = []\n").controlled.empty());
}

TEST_CASE("home and tool are transforms") {
  const Machine machine =
      machine_with("home.xyz_mm = [1, 2, 3]\n[tool]\nxyz_mm = [0, 0, -150]\nrpy_deg = [180, 0, 0]\n");
  REQUIRE(machine.home_X_MP.has_value());
  CHECK(machine.home_X_MP->p[2] == doctest::Approx(3e-3));
  CHECK(machine.X_PT.p[2] == doctest::Approx(-0.15));
  CHECK(machine.X_PT.R(2, 2) == doctest::Approx(-1));
}

TEST_CASE("work offsets have a pose and a datum: the true pose, a touched point, or not stated") {
  const Machine machine = machine_with(
      "[work.G54]\nxyz_mm = [100, 0, 0]\ndatum = \"true\"\n[work.\"G59.1\"]\ndatum = { touched_at_mm = [1, "
      "2, 3] }\n[work.G55]\n[work.G56]\ndatum = \"machine\"\n");
  REQUIRE(machine.work.size() == 4);
  CHECK(machine.work.at("G54").datum.is_machine);
  CHECK(machine.work.at("G56").datum.is_machine);
  CHECK_FALSE(machine.work.at("G55").datum.stated());
  CHECK(machine.work.at("G59.1").datum.stated());
  CHECK_FALSE(machine.work_is_machine_frame);
  const Machine confirmed = machine_with("work = \"machine\"\n");
  CHECK(confirmed.work.empty());
  CHECK(confirmed.work_is_machine_frame);
  CHECK(machine.work.at("G54").X_MW.p[0] == doctest::Approx(0.1));
  CHECK_FALSE(machine.work.at("G54").datum.touched_at.has_value());
  CHECK_FALSE(machine.work.at("G55").datum.touched_at.has_value());
  REQUIRE(machine.work.at("G59.1").datum.touched_at.has_value());
  CHECK(machine.work.at("G59.1").datum.touched_at->z() == doctest::Approx(3e-3));
}

TEST_CASE("the control's settings are kept, axes in upper case, and no axis differs from all axes") {
  const ControlSettings control =
      machine_with("[program]\ndialect = \"fanuc\"\nunits = \"inch\"\ntool_change_moves = [\"z\"]\n").control;
  CHECK(control.dialect == "fanuc");
  CHECK(control.units == "inch");
  CHECK(control.tool_change_moves == std::vector<std::string>{"Z"});
  CHECK(control.harmless_calls.empty());
  const ControlSettings calls =
      machine_with("[program]\nharmless_calls = [\"Spindle on\", 'TNC:\\on.h']\n").control;
  CHECK(calls.harmless_calls == std::set<std::string, std::less<>>{"SPINDLEON", "TNC:\\ON.H"});
  const ControlSettings none = machine_with("[program]\ntool_change_moves = []\n").control;
  REQUIRE(none.tool_change_moves.has_value());
  CHECK(none.tool_change_moves->empty());
}

TEST_CASE("work offsets have the names by which programs select them, in any spelling") {
  const Machine machine = machine_with(
      "[work.g55]\n[work.\"G54.1P007\"]\n[work.\"g154 p99\"]\n[work.G505]\n"
      "[work.\"uf 05\"]\n[work.\"base_data[3]\"]\n[work.\"user 3\"]\n[work.ROBOT]\n[work.w5]\n[work.FP1]\n"
      "[work.\"$BASE\"]\n[work.\"$base02\"]\n[work.\"$NULLFRAME\"]\n");
  for (const char* name : {"G55", "G54.1 P7", "G54.1 P99", "G505", "UF 5", "BASE_DATA[3]", "USER 3", "ROBOT",
                           "w5", "FP1", "$BASE", "$BASE 2", "$NULLFRAME"}) {
    CAPTURE(name);
    CHECK(machine.work.count(name) == 1);
  }
}

TEST_CASE("names that select no work offset are refused") {
  for (const char* name :
       {"",          "G",          "G53",  "G60",    "G59.4", "G54.1",        "G54.1 P0",    "G54.1 P301",
        "G154 P100", "G54 P1",     "G499", "G600",   "G54x",  "54",           "G-54",        "G54.1 P-1",
        "G154",      "G54.1 P1.5", "g60",  "UF 100", "UF x",  "BASE_DATA[0]", "BASE_DATA[1", "USER 0",
        "a-b",       "$BASE 0",    "$TOOL"}) {
    CAPTURE(name);
    CHECK_FALSE(work_offset_name(name).has_value());
  }
}

TEST_CASE("[tool] and [spindle] are frames of the control, whose spindle_axis points to the spindle") {
  const std::string frames = "[tool]\nxyz_mm = [1, 2, 3]\nrpy_deg = [0, 90, 0]\n";
  const Machine in_z = machine_with(frames + "[spindle]\nrpy_deg = [0, 0, 90]\n"),
                in_x = machine_with(frames + "spindle_axis = \"-x\"\n[spindle]\nrpy_deg = [0, 0, 90]\n");
  CHECK(in_x.X_PT.p == in_z.X_PT.p);
  CHECK((in_x.X_PT.R.col(2) + in_z.X_PT.R.col(0)).norm() < 1e-15);
  REQUIRE(in_x.X_PS);
  CHECK((in_x.X_PS->R.col(2) + in_z.X_PS->R.col(0)).norm() < 1e-15);
}

TEST_CASE("tools have lengths, negative ones too, by number") {
  const Machine machine = machine_with("[tools.T3]\nlength_mm = 72.5\n[tools.12]\nlength_mm = -4\n");
  REQUIRE(machine.tools.size() == 2);
  CHECK(machine.tools.at(3).length.value() == doctest::Approx(0.0725));
  CHECK(machine.tools.at(12).length.value() == doctest::Approx(-0.004));
  CHECK(describe(machine).find("tools        T3 72.5 mm, T12 -4 mm long\n") != std::string::npos);
  CHECK(describe(machine_with("")).find("tools") == std::string::npos);
}

TEST_CASE("the limit of the correction is in millimetres") {
  CHECK(machine_with("limits.max_correction_mm = 2.5\n").max_correction == doctest::Approx(2.5e-3));
}

TEST_CASE("limits of loads are in the units of their keys, and a machine without any has none") {
  const Machine machine = machine_with(
      "[limits]\nmoment_max_Nm = 40\nspring_translation_max_mm = 0.5\npassive_change_max_deg = 3\n");
  REQUIRE(machine.load_limits.size() == 1);
  const LoadLimits& limits = machine.load_limits[0];
  CHECK(limits[LoadKind::moment] == doctest::Approx(40));
  CHECK(limits[LoadKind::spring_translation] == doctest::Approx(0.5e-3));
  CHECK(limits[LoadKind::passive_change] == doctest::Approx(3 * 3.14159265 / 180));
  CHECK_FALSE(limits[LoadKind::spring_force].has_value());
  CHECK(machine.max_correction == 1e-3);
  CHECK(machine_with("limits.max_correction_mm = 2\n").load_limits.empty());
}

TEST_CASE("every kind of load has its own key, and that key is read as this kind") {
  for (const LoadKind kind : load_kinds) {
    const std::string key(name_of(kind).key);
    CAPTURE(key);
    const Machine machine = machine_with("limits." + key + " = 2\n");
    REQUIRE(machine.load_limits.size() == 1);
    for (const LoadKind other : load_kinds)
      CHECK(machine.load_limits[0][other].has_value() == (other == kind));
    CHECK(*machine.load_limits[0][kind] == doctest::Approx(2 * name_of(kind).si));
    CHECK(key.ends_with(name_of(kind).unit == "N m" ? "_Nm" : "_" + std::string(name_of(kind).unit)));
  }
}

TEST_CASE("a chain's own limits override the machine's, kind by kind") {
  const Machine machine = read_machine(
      header +
          "controlled = []\nhome.xyz_mm = [0, 0, 0]\n[limits]\nmoment_max_Nm = 40\nspring_force_max_N = "
          "500\n" +
          chain_text(x_axis, "limits = { moment_max_Nm = 25, group_moment_max_Nm = 3 }\n", "left") +
          chain_text(x_axis, "", "right"),
      "machine.toml");
  REQUIRE(machine.load_limits.size() == 2);
  const LoadLimits &left = machine.load_limits[0], &right = machine.load_limits[1];
  CHECK(left[LoadKind::moment] == 25);
  CHECK(left[LoadKind::spring_force] == 500);
  CHECK(left[LoadKind::group_moment] == 3);
  CHECK(right[LoadKind::moment] == 40);
  CHECK(right[LoadKind::spring_force] == 500);
  CHECK_FALSE(right[LoadKind::group_moment].has_value());
}
