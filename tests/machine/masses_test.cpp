/// Masses, gravity, and when the control's zero was set.
#include <algorithm>

#include "counterflex/machine/read_machine.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

const std::string pulled = "controlled = [\"x\"]\ngravity_m_s2 = [0, 0, -9.81]\n";
const std::string heavy_axis =
    "{ actuator = \"prismatic\", axis = \"x\", min_mm = 0, max_mm = 100, mass = { kg = 12.5 } }";

// One of every kind of element, each with a mass of its own.
const std::string every_kind = R"(
[springs.s]
stiffness_diag_si = [1, 1, 1, 1, 1, 1]
[branches.bar]
elements = [{ rigid = {}, mass = { kg = 7 } }]
[[chain]]
name = "arm"
elements = [
  { rigid = { xyz_mm = [0, 0, 310] }, mass = { kg = 1, at_mm = [10, -20, 30] } },
  { error = "e", mass = { kg = 2 } },
  { actuator = "prismatic", axis = "x", min_mm = 0, max_mm = 1, mass = { kg = 3 } },
  { passive = "revolute", axis = "y", mass = { kg = 4 } },
  { spring = "s", mass = { kg = 5 } },
  { compliance = "prismatic", axis = "z", stiffness_N_per_m = 1, mass = { kg = 6 } },
  { parallel = ["bar", "bar"], mass = { kg = 8 } },
])";

std::vector<std::string> notes_with(const std::string& part, const Machine& machine) {
  std::vector<std::string> notes = structural_notes(machine);
  std::erase_if(notes, [&](const std::string& note) { return note.find(part) == std::string::npos; });
  return notes;
}

}  // namespace

TEST_CASE("a mass is in the frame after its element, for all kinds of elements") {
  const Machine machine = read_machine(header + every_kind, "machine.toml");
  const Chain& arm = machine.chains.at(0);
  REQUIRE(arm.elements.size() == 14);
  const double expected[] = {1, 2, 3, 4, 5, 6, 8};
  for (std::size_t i = 0; i < 7; ++i) {
    CAPTURE(i);
    CHECK_FALSE(std::holds_alternative<PointMass>(arm.elements[2 * i]));
    CHECK(part<PointMass>(arm, 2 * i + 1).kg == expected[i]);
  }
  CHECK((part<PointMass>(arm, 1).at - Vector3(0.01, -0.02, 0.03)).norm() < 1e-15);
  CHECK(part<PointMass>(arm, 3).at.isZero(0));
}

TEST_CASE("the mass of a chain counts every branch of its groups") {
  const Machine machine = read_machine(header + every_kind, "machine.toml");
  CHECK(total_mass(machine.chains.at(0)) == 1 + 2 + 3 + 4 + 5 + 6 + 7 + 7 + 8);
  CHECK(total_mass(machine) == total_mass(machine.chains.at(0)));
}

TEST_CASE("a template's masses take each chain's own numbers") {
  const std::string leg =
      "home = {}\n[templates.leg]\nelements = [{ rigid = {}, mass = { kg = \"$m\", at_mm = [0, 0, \"$z\"] } "
      "}]\n";
  const auto chain = [](const std::string& name, const std::string& values) {
    return "[[chain]]\nname = \"" + name + "\"\nuse = \"leg\"\nvalues = " + values + "\n";
  };
  const Machine machine = read_machine(
      header + leg + chain("a", "{ m = 3, z = 40 }") + chain("b", "{ m = 5, z = -40 }"), "machine.toml");
  CHECK(part<PointMass>(machine.chains[0], 1).kg == 3);
  CHECK(part<PointMass>(machine.chains[1], 1).kg == 5);
  CHECK(part<PointMass>(machine.chains[1], 1).at[2] == doctest::Approx(-0.04));
}

TEST_CASE("gravity is in machine axes, in m/s2, and zero by default") {
  CHECK(machine_of(heavy_axis).gravity.g.isZero(0));
  const Machine machine = machine_of(heavy_axis, "gravity_m_s2 = [1, 2, -9.5]\n");
  CHECK(machine.gravity.g == Vector3(1, 2, -9.5));
  CHECK_FALSE(machine.gravity.true_at_home);
}

TEST_CASE("the control's zero was set unloaded, or at home if the file states it") {
  CHECK_FALSE(machine_of(heavy_axis, pulled + "gravity_reference = \"unloaded\"\n").gravity.true_at_home);
  const Machine machine = machine_of(heavy_axis, pulled + "gravity_reference = \"home\"\n");
  CHECK(machine.gravity.true_at_home);
  CHECK(machine.gravity.reference_at.line == 4);
  CHECK(machine.gravity.reference_at.column == 21);
}

TEST_CASE("a description shows the mass of each chain, gravity, and when the zero was set") {
  const std::string text = describe(machine_of(heavy_axis, pulled + "gravity_reference = \"home\"\n"));
  CHECK(
      text.find(
          "gravity      0 0 -9.81 m/s2 on 12.5 kg; the control's zero was set under the weights at home\n") !=
      std::string::npos);
  CHECK(text.find("chain arm    1 actuator, no passive joints, no elastic coordinates, 12.5 kg\n"
                  "   1  actuator 1   prismatic along x, 0 to 100 mm\n"
                  "      mass         12.5 kg at 0 0 0 mm\n") != std::string::npos);
  CHECK(describe(machine_of(heavy_axis, pulled)).find("on 12.5 kg; the control's zero was set unloaded\n") !=
        std::string::npos);
  CHECK(describe(machine_of(heavy_axis)).find("gravity      not given: 12.5 kg without weight\n") !=
        std::string::npos);
  CHECK(describe(machine_of(x_axis)).find("gravity") == std::string::npos);
}

TEST_CASE("elements keep their numbers in a description with masses between them") {
  const std::string text = describe(read_machine(header + every_kind, "machine.toml"));
  CHECK(text.find("   7  parallel     2 branches\n") != std::string::npos);
}

TEST_CASE("masses without gravity are noted, and gravity without masses") {
  CHECK(notes_with("no weight", machine_of(heavy_axis)) ==
        std::vector<std::string>{"masses of 12.5 kg but no gravity_m_s2: there is no weight"});
  CHECK(notes_with("no weight", machine_of(x_axis, pulled)) ==
        std::vector<std::string>{"gravity_m_s2 but no masses: there is no weight"});
  CHECK(notes_with("no weight", machine_of(heavy_axis, pulled)).empty());
  CHECK(notes_with("no weight", machine_of(x_axis)).empty());
}
