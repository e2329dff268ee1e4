#include "counterflex/machine/program_axes.hpp"

#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

const std::string rail =
    "{ actuator = \"prismatic\", axis = \"x\", program_axis = \"E1\", min_mm = 0, max_mm = 5000, home_mm = "
    "100 }, ";
const std::string table =
    "{ actuator = \"revolute\", axis = \"z\", program_axis = \"E3\", min_deg = -90, max_deg = 90 }, ";

}  // namespace

TEST_CASE("an actuator with a program axis is no numbered actuator, and needs no controlled component") {
  const Machine machine =
      machine_of(rail + x_axis + ", " + table + "{ actuator = \"prismatic\", axis = \"y\" }",
                 "controlled = [\"x\", \"y\"]\n");
  CHECK(actuators(machine).size() == 2);
  CHECK(actuator_names(machine) == std::vector<std::string>{"axis X", "axis Y"});
  CHECK(freedoms(machine.chains[0]).actuators == 2);
  CHECK_FALSE(turns_joints(machine));
  REQUIRE(program_axes(machine).size() == 2);
  CHECK(program_axes(machine)[0].program_axis == 1);
  CHECK(program_axes(machine)[1].program_axis == 3);
}

TEST_CASE("program axes take the values of the program in mm or degrees, and stay at home without a value") {
  const Machine machine = machine_of(rail + table + x_axis, "controlled = [\"x\"]\n");
  const auto placed = program_axes(at_program_axes(machine, {850.0, {}, -30.0}));
  CHECK(placed[0].home == doctest::Approx(0.85));
  CHECK(placed[1].home == doctest::Approx(-30 * deg));
  const auto at_home = program_axes(at_program_axes(machine, {}));
  CHECK(at_home[0].home == doctest::Approx(0.1));
  CHECK(at_home[1].home == 0);
}

TEST_CASE("a program axis inside a branch takes its value, too") {
  const Machine machine =
      machine_of("{ parallel = [\"bar\"] }", "[branches.bar]\nelements = [" + rail + x_axis + "]\n");
  CHECK(program_axes(at_program_axes(machine, {850.0}))[0].home == doctest::Approx(0.85));
}

TEST_CASE("the description names the external axis, its travel and its value without a program") {
  const std::string text = describe(machine_of(rail + x_axis, "controlled = [\"x\"]\n"));
  CAPTURE(text);
  CHECK(text.find("axis E1      prismatic along x, 0 to 5000 mm, at 100 mm unless the program gives it\n") !=
        std::string::npos);
  CHECK(text.find("  E1  arm     prismatic along x        0 to 5000 mm\n") != std::string::npos);
  CHECK(text.find("actuator 1   prismatic along x") != std::string::npos);
}
