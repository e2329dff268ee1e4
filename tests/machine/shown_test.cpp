#include "counterflex/machine/shown.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

/// An arm whose control shows J2 from the vertical and J3 from the horizontal, upwards.
Machine arm() {
  return machine_of(
      "{ actuator = \"revolute\", axis = \"z\", min_deg = -185, max_deg = 185, home_deg = 10 }, "
      "{ actuator = \"revolute\", axis = \"y\", shown_zero_deg = 90, min_deg = -60, max_deg = 75, "
      "home_deg = 20 }, "
      "{ actuator = \"revolute\", axis = \"y\", shown_sign = -1, shown_zero_deg = -90, shown_with = { J2 = "
      "-1 }, "
      "min_deg = -132, max_deg = 230, home_deg = 5 }");
}

Eigen::Vector3d degrees(double a, double b, double c) {
  return Eigen::Vector3d(a, b, c) * deg;
}

}  // namespace

TEST_CASE("a shown value is the joint value with its sign, plus the zero, plus the coupled shown values") {
  const ShownActuators shown = shown_actuators(arm());
  REQUIRE(shown.differ());
  // J2 = q2 + 90 and J3 = -q3 - 90 - J2
  CHECK((shown_values(shown, degrees(7, -90, 0)) - degrees(7, 0, -90)).norm() < 1e-12);
  CHECK((shown_values(shown, degrees(0, -60, 50)) - degrees(0, 30, -170)).norm() < 1e-12);
}

TEST_CASE("joint values are the inverse of shown values") {
  const ShownActuators shown = shown_actuators(arm());
  const Eigen::Vector3d q = degrees(12, -33, 71);
  CHECK((joint_values(shown, shown_values(shown, q)) - q).norm() < 1e-12);
}

TEST_CASE("a machine without these keys shows its joint values") {
  const ShownActuators shown = shown_actuators(machine_of(x_axis));
  CHECK_FALSE(shown.differ());
  CHECK(shown_values(shown, Eigen::VectorXd::Constant(1, 0.25))[0] == 0.25);
  CHECK(joint_values(shown, Eigen::VectorXd::Constant(1, 0.25))[0] == 0.25);
}

TEST_CASE("home values of a file are shown values") {
  const Machine machine = arm();
  CHECK((home_values(machine) - degrees(10, -70, -115)).norm() < 1e-12);
  CHECK((shown_homes(machine) - degrees(10, 20, 5)).norm() < 1e-12);
}

TEST_CASE("the description has the shown values and how they come from the joint values") {
  const std::string text = describe(arm());
  CAPTURE(text);
  CHECK(text.find("actuator 2   revolute about y, -60 to 75 deg, starts at 20 deg, shown = q + 90 deg\n") !=
        std::string::npos);
  CHECK(text.find("   3  arm     revolute about y         -132 to 230 deg, shown = -q - 90 deg - 1 J2\n") !=
        std::string::npos);
}

TEST_CASE("whether home is in the travel is judged by shown values") {
  for (const std::string& note : structural_notes(arm())) CHECK(note.find("outside") == std::string::npos);
  const Machine outside = machine_of(
      "{ actuator = \"revolute\", axis = \"y\", shown_sign = -1, min_deg = 0, max_deg = 90, home_deg = -1 }");
  bool is_noted = false;
  for (const std::string& note : structural_notes(outside))
    is_noted = is_noted || note.find("starts at -1 deg, outside its travel 0 to 90 deg") != std::string::npos;
  CHECK(is_noted);
}

TEST_CASE("the stiffness of a rotary joint may be in N m per minute of arc") {
  const double k = 1000 * 10800 / pi;
  const auto c =
      read_part<Compliance>("{ compliance = \"revolute\", axis = \"y\", stiffness_Nm_per_arcmin = 1000 }");
  CHECK(c.stiffness == doctest::Approx(k).epsilon(1e-14));
  const auto p = read_part<Passive>(
      "{ passive = \"revolute\", axis = \"z\", stiffness_Nm_per_arcmin = 1000, preload_deg = 90 }");
  CHECK(p.stiffness == doctest::Approx(k).epsilon(1e-14));
  CHECK(p.rest == doctest::Approx(pi / 2));
}

TEST_CASE("the file states the lengths with which the control computes") {
  CHECK(machine_of(x_axis).kinematics == ControlKinematics::unstated);
  CHECK(machine_with("[controller]\nkinematics = \"catalogue\"\n").kinematics ==
        ControlKinematics::catalogue);
  const Machine factory = machine_with("[controller]\nkinematics = \"factory\"\n");
  CHECK(factory.kinematics == ControlKinematics::factory);
  CHECK(describe(factory).find("controller   computes with calibrated lengths") != std::string::npos);
  CHECK(describe(machine_of(x_axis)).find("controller") == std::string::npos);
}
