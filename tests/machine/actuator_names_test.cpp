#include <doctest/doctest.h>

#include "counterflex/machine/read_machine.hpp"

using namespace counterflex;

namespace {

std::vector<std::string> names_of(const std::string& chains) {
  return actuator_names(read_machine("format = \"counterflex-machine 1\"\n" + chains, "machine.toml"));
}

std::string chain_of(const std::string& elements, const std::string& name = "axes") {
  return "[[chain]]\nname = \"" + name + "\"\nelements = [" + elements + "]\n";
}

const char* const linear = "{ actuator = \"prismatic\", axis = \"x\" },";
const char* const turn_z = "{ actuator = \"revolute\", axis = \"z\" },";

}  // namespace

TEST_CASE(
    "linear axes have the letter of the machine axis to which they are parallel at home, rotary ones A, B, "
    "C") {
  CHECK(names_of(chain_of(std::string(linear) + "{ actuator = \"prismatic\", axis = [0, 0, -1] }," +
                          turn_z)) == std::vector<std::string>{"axis X", "axis Z", "axis C"});
  CHECK(names_of(chain_of("{ rigid = { rpy_deg = [0, 0, 90] } }," + std::string(linear))) ==
        std::vector<std::string>{"axis Y"});
}

TEST_CASE("two axes in one direction, and oblique ones, have numbers") {
  CHECK(names_of(chain_of(std::string(linear) + linear)) ==
        std::vector<std::string>{"actuator 1", "actuator 2"});
  CHECK(names_of(chain_of("{ actuator = \"prismatic\", axis = [1, 1, 0] },")) ==
        std::vector<std::string>{"actuator 1"});
}

TEST_CASE("the rotary axes of an arm count from A1, the rail under it has its letter") {
  std::string arm = linear;
  for (int i = 0; i < 4; ++i) arm += turn_z;
  CHECK(names_of(chain_of(arm)) ==
        std::vector<std::string>{"axis X", "axis A1", "axis A2", "axis A3", "axis A4"});
}

TEST_CASE("the actuators of a parallel machine have the names of their chains") {
  const std::string home = "[home]\nxyz_mm = [0, 0, 0]\n";
  CHECK(names_of(home + chain_of(linear, "left") + chain_of(std::string(linear) + turn_z, "right")) ==
        std::vector<std::string>{"chain left", "actuator 2", "actuator 3"});
}
