#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/program_axes.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/nominal.hpp"

using namespace counterflex;

namespace {

Machine machine_with(const std::string& elements) {
  return read_machine(
      "format = \"counterflex-machine 1\"\n[[chain]]\nname = \"arm\"\nelements = [" + elements + "]\n",
      "machine.toml");
}

/// J2 = q2 + 90 deg, J3 = -q3 - J2.
Mechanism coupled() {
  return compile(machine_with(
      "{ actuator = \"revolute\", axis = \"z\", min_deg = -180, max_deg = 180 }, "
      "{ actuator = \"revolute\", axis = \"y\", shown_zero_deg = 90, min_deg = -60, max_deg = 75 }, "
      "{ rigid = { xyz_mm = [1000, 0, 0] } }, "
      "{ actuator = \"revolute\", axis = \"y\", shown_sign = -1, shown_with = { J2 = -1 }, min_deg = -80, "
      "max_deg = 40 }"));
}

Eigen::VectorXd degrees(double a, double b, double c) {
  return Eigen::Vector3d(a, b, c) * deg;
}

}  // namespace

TEST_CASE("travel is that of the shown values, with their zeros, signs and couplings") {
  const Mechanism mechanism = coupled();
  CHECK(within_travel(mechanism, degrees(0, -90, 79)));
  CHECK_FALSE(within_travel(mechanism, degrees(0, -90, 81)));
  CHECK(within_travel(mechanism, degrees(0, -120, 109)));
  CHECK_FALSE(within_travel(mechanism, degrees(0, -120, 111)));  // coupled: the limit moves with J2
  CHECK_FALSE(within_travel(mechanism, degrees(0, -10, 0)));     // J2 = 80
}

TEST_CASE("the end of a travel is inside of it, to the rounding of solutions") {
  const Mechanism mechanism = coupled();
  const double rounding = 1e-12;
  CHECK(within_travel(mechanism, Eigen::VectorXd(degrees(180, -90, 0).array() + rounding)));
  CHECK(tightest_axis(mechanism, degrees(180, -90, 0).array() + rounding)->margin == 0);
  CHECK_FALSE(within_travel(mechanism, degrees(180.0001, -90, 0)));
  CHECK_FALSE(within_travel(mechanism, degrees(NAN, -90, 0)));
}

TEST_CASE("the tightest axis and its words have the shown value") {
  const Mechanism mechanism = coupled();
  const auto axis = tightest_axis(mechanism, degrees(0, -120, 111));  // J2 = -30, J3 = -81
  REQUIRE(axis);
  CHECK(axis->actuator == 2);
  CHECK(axis->value == doctest::Approx(-81 * deg));
  CHECK(axis->margin == doctest::Approx(-1 * deg));
  CHECK(outside_travel_words(mechanism.travel[2], axis->value)
            .find("-81.0 deg is outside its travel (-80 to 40 deg)") != std::string::npos);
}

TEST_CASE("an actuator with a program axis is a fixed transform at its value, in front of a spring, too") {
  const std::string rest =
      "{ spring = \"post\" }, { actuator = \"prismatic\", axis = \"z\" }, { rigid = { xyz_mm = [10, 0, 0] } "
      "}";
  const auto machine = [&](const std::string& first) {
    return read_machine(
        "format = \"counterflex-machine 1\"\ncontrolled = [\"z\"]\n[springs.post]\n"
        "stiffness_diag_si = [1e7, 1e7, 1e7, 1e6, 1e6, 1e6]\n[[chain]]\nname = \"a\"\nelements = [" +
            first + rest + "]\n",
        "machine.toml");
  };
  const Machine rail = machine("{ actuator = \"prismatic\", axis = \"y\", program_axis = \"E1\" }, "),
                turn = machine("{ actuator = \"revolute\", axis = \"z\", program_axis = \"E2\" }, ");
  const Model moved = prepare(at_program_axes(rail, {850.0}));
  CHECK(moved.mechanism.travel.size() == 1);
  CHECK((tip(moved.mechanism, moved.home).p - Vector3(0.01, 0.85, 0)).norm() < 1e-12);
  const Model turned = prepare(at_program_axes(turn, {std::nullopt, 90.0}));
  CHECK((tip(turned.mechanism, turned.home).p - Vector3(0, 0.01, 0)).norm() < 1e-12);
}
