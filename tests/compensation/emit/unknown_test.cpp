// Positions that the text does not give: which are held, which are listed. No word is made up for them.
#include "compensation/support/shop.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A gantry of three springs: 100, 200 and 400 N move each axis by 0.1 mm.
Machine gantry(const std::string& controlled = R"("x", "y", "z")", bool has_z = true) {
  const std::string z = has_z ? R"({ actuator = "prismatic", axis = "z" },)" : "";
  return read_machine(R"(
format = "counterflex-machine 1"
name = "gantry"
controlled = [)" + controlled +
                          R"(]
[springs.s]
stiffness_diag_si = [1e6, 2e6, 4e6, 1e12, 1e12, 1e12]
[[chain]]
name = "a"
elements = [
  { actuator = "prismatic", axis = "x" },
  { actuator = "prismatic", axis = "y" },)" +
                          z + R"(
  { spring = "s" },
]
)",
                      "gantry.toml");
}

Vector6 tenth_of_a_millimetre() {
  return (Vector6() << 100, 200, 400, 0, 0, 0).finished();
}

std::string corrected(const Shop& shop) {
  return compensated(shop).text;
}

}  // namespace

TEST_CASE("a feed move from an unknown position is listed: its cutting force is not known") {
  const Shop shop({.machine = gantry(),
                   .text = "G21 G90 F100\nG1 X0 Y0 Z5\nM30\n",
                   .force = constant_force(tenth_of_a_millimetre())});
  const Compensation result = compensated(shop);
  REQUIRE(result.left_alone.size() == 1);
  CHECK(result.left_alone[0].line == 2);
  CHECK(result.left_alone[0].why.find("without cutting force") != std::string::npos);
  CHECK(result.corrected_moves == 0);
}

TEST_CASE("behind a block that may be skipped the correction is held, and each such move is listed") {
  const Shop shop({.machine = gantry(),
                   .text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F100\n/X10\nY10\nX20 Y20\nX30\n",
                   .force = constant_force(tenth_of_a_millimetre())});
  const Compensation result = compensated(shop);
  CHECK(result.text.find("\nY9.9\nX19.9 Y19.9\n") != std::string::npos);
  REQUIRE(result.left_alone.size() == 2);
  CHECK(result.left_alone[0].line == 5);
  CHECK(result.left_alone[1].line == 6);
  CHECK(result.left_alone[1].why.substr(0, 4) == "held");
}

TEST_CASE("a G49 block takes no further words: it holds the other axes and is listed") {
  const Shop shop({.machine = gantry(),
                   .text = "G21 G90\nG0 X0 Y0 Z5\nG43 Z2 H1\nG1 Z0 F100\nX10\nG49 Z5\nX0\nM30\n",
                   .force = constant_force(tenth_of_a_millimetre())});
  const Compensation result = compensated(shop);
  CHECK(result.text.find("\nG49 Z5\n") != std::string::npos);
  REQUIRE(!result.left_alone.empty());
  CHECK(result.left_alone[0].line == 6);
  CHECK(result.left_alone[0].why.find("0.1414 mm") != std::string::npos);
}

TEST_CASE("no word is written for an axis that the machine does not control") {
  Order order{.machine = gantry(R"("x", "y")", false),
              .text = "G21 G90\nG0 X0 Y0\nG1 X10 F100\nY10\n",
              .force = constant_force((Vector6() << 100, 200, 0, 0, 0, 0).finished()),
              .ignored = {false, false, true}};
  const std::string text = corrected(Shop(order));
  CHECK(text.find('Z') == std::string::npos);
  CHECK(text.find("X9.9 F100\nY9.9\n") != std::string::npos);
}

TEST_CASE("a block that states the unit is split like any other") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G90 G21\nG0 X-73.65 Y-73.65 Z-63.65\nG1 Z-73.65 F300\nG21 G1 Y126.35 F600\nM30\n",
                   .force = constant_force(milling())});
  const Compensation result = compensated(shop);
  CHECK(result.left_alone.empty());
  CHECK(result.counts.inserted_blocks >= 7);
}
