#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

const Tool& tool_3(const Machine& machine) {
  return machine.tools.at(3);
}

Matrix6 compliance_of(const Tool& tool) {
  return std::get<Spring>(tool.yields.at(0)).K.inverse();
}

}  // namespace

TEST_CASE("a tool that is a length alone is rigid") {
  const Machine machine = machine_with("[tools.T3]\nlength_mm = 80\n");
  CHECK(tool_3(machine).from == ToolStiffness::rigid);
  CHECK(tool_3(machine).yields.empty());
  CHECK(tool_3(machine).length.value() == doctest::Approx(0.08));
  CHECK_FALSE(changes_model(machine, tool_3(machine)));
}

TEST_CASE("tool number 0, no known tool, can have a length") {
  const Machine machine = machine_with("[spindle]\n[tools.T0]\nlength_mm = 80\n");
  CHECK(machine.tools.at(0).length.value() == doctest::Approx(0.08));
}

TEST_CASE("a radial stiffness is one of two compliances, along x and y of the tip") {
  const Machine machine = machine_with("[tools.T3]\nholder_N_per_um = 20\n");
  const Tool& tool = tool_3(machine);
  REQUIRE(tool.yields.size() == 2);
  for (const int axis : {0, 1}) {
    const auto& compliance = std::get<Compliance>(tool.yields[static_cast<std::size_t>(axis)]);
    CHECK(compliance.joint.kind == JointKind::prismatic);
    CHECK(compliance.joint.axis == Vector3::Unit(axis));
    CHECK(compliance.stiffness == 20e6);
  }
  CHECK(radial_stiffness(tool) == doctest::Approx(20e6));
  CHECK(changes_model(machine, tool));
}

TEST_CASE("a 6x6 matrix of a tool is its stiffness or compliance at the tip") {
  const std::string matrix =
      " = [\n[4e7, 0, 0, 0, -2e5, 0],\n[0, 2e7, 0, 1e5, 0, 0],\n[0, 0, 9e7, 0, 0, 0],\n"
      "[0, 1e5, 0, 9e4, 0, 0],\n[-2e5, 0, 0, 0, 8e4, 0],\n[0, 0, 0, 0, 0, 7e4]]\n";
  const Tool stiff = tool_3(machine_with("[tools.T3]\nstiffness_si" + matrix));
  CHECK(stiff.from == ToolStiffness::matrix);
  const Matrix6 K = std::get<Spring>(stiff.yields.at(0)).K;
  CHECK(K(0, 0) == 4e7);
  CHECK(K(0, 4) == -2e5);
  const Tool soft = tool_3(machine_with("[tools.T3]\ncompliance_si" + matrix));
  CHECK((std::get<Spring>(soft.yields.at(0)).K * K - Matrix6::Identity()).norm() < 1e-9);
}

TEST_CASE("a diameter and a stick-out make a cantilever of 0.8 of the diameter along the tool") {
  const Tool tool = tool_3(machine_with("[tools.T3]\ndiameter_mm = 10\nstickout_mm = 40\n"));
  CHECK(tool.from == ToolStiffness::cantilever);
  const Matrix6 C = compliance_of(tool);
  const double L = 0.04, d = 0.008, E = 600e9, G = E / 2.44;
  const double A = std::numbers::pi * d * d / 4, I = std::numbers::pi * std::pow(d, 4) / 64;
  for (const int axis : {0, 1})
    CHECK(C(axis, axis) == doctest::Approx(L * L * L / (3 * E * I)).epsilon(1e-9));
  for (const int axis : {3, 4}) CHECK(C(axis, axis) == doctest::Approx(L / (E * I)).epsilon(1e-9));
  CHECK(C(2, 2) == doctest::Approx(L / (E * A)).epsilon(1e-9));
  CHECK(C(5, 5) == doctest::Approx(L / (G * 2 * I)).epsilon(1e-9));
  // The tip hangs below its holder: pushed along x it turns about -y, along y about x.
  CHECK(C(4, 0) == doctest::Approx(-L * L / (2 * E * I)).epsilon(1e-9));
  CHECK(C(3, 1) == doctest::Approx(L * L / (2 * E * I)).epsilon(1e-9));
  CHECK(std::abs(C(2, 0)) < 1e-9 * C(2, 2));
  CHECK(radial_stiffness(tool) == doctest::Approx(3 * E * I / (L * L * L)).epsilon(1e-9));
}

TEST_CASE("a steel cutter is softer than one of carbide by their moduli") {
  const std::string size = "diameter_mm = 10\nstickout_mm = 40\n";
  const double carbide =
      radial_stiffness(tool_3(machine_with("[tools.T3]\nmaterial = \"carbide\"\n" + size)));
  const double steel = radial_stiffness(tool_3(machine_with("[tools.T3]\nmaterial = \"steel\"\n" + size)));
  CHECK(carbide / steel == doctest::Approx(600.0 / 210));
}

TEST_CASE("a given stiffness overrides the cantilever, and a diameter alone defines no stiffness") {
  const Tool given =
      tool_3(machine_with("[tools.T3]\nholder_N_per_um = 20\ndiameter_mm = 10\nstickout_mm = 40\n"));
  CHECK(given.from == ToolStiffness::radial);
  CHECK(given.stickout.value() == doctest::Approx(0.04));
  CHECK(tool_3(machine_with("[tools.T3]\ndiameter_mm = 10\n")).from == ToolStiffness::rigid);
}

TEST_CASE("a tool's tip is its length below the spindle's gauge line, and [tool] without one of them") {
  const std::string tool =
      "[tool]\nxyz_mm = [0, 0, -80]\n[tools.T3]\nlength_mm = 50\n[tools.T4]\ndiameter_mm = 8\n";
  const Machine plain = machine_with(tool);
  CHECK(tip_of(plain, tool_3(plain)).p.z() == doctest::Approx(-0.08));
  const Machine turned = machine_with(tool + "[spindle]\nxyz_mm = [1, 2, 3]\nrpy_deg = [0, 90, 0]\n");
  const Pose X_PT = tip_of(turned, tool_3(turned));
  CHECK((X_PT.p - Vector3(0.001 - 0.05, 0.002, 0.003)).norm() <
        1e-15);  // -z of the spindle is -x of the platform
  CHECK((X_PT.R - turned.X_PS->R).norm() == 0);
  CHECK(tip_of(turned, turned.tools.at(4)).p.z() == doctest::Approx(-0.08));
  CHECK(changes_model(turned, tool_3(turned)));
  CHECK_FALSE(changes_model(turned, turned.tools.at(4)));
}

TEST_CASE("an elastic tool is the last part of a serial machine, whose platform is then the tip") {
  const Machine machine = machine_with(
      "home.xyz_mm = [0, 0, 7]\n[tool]\nxyz_mm = [0, 0, -80]\n[tools.T3]\nholder_N_per_um = 20\n");
  const Machine bent = with_tool(machine, tool_3(machine));
  REQUIRE(bent.chains.size() == 1);
  const auto &before = machine.chains[0].elements, &after = bent.chains[0].elements;
  REQUIRE(after.size() == before.size() + 3);
  CHECK(std::get<Rigid>(after[before.size()]).X.p.z() == doctest::Approx(-0.08));
  CHECK(bent.X_PT.p.isZero(0));
  CHECK(bent.home_X_MP->p.z() == doctest::Approx(-0.073));
  CHECK(bent.p_EP.z() == doctest::Approx(0.08));
}

TEST_CASE("parallel chains become a group before the tool, and their actuators keep their numbers") {
  Machine machine = machine_with("[tools.T3]\nholder_N_per_um = 20\n");
  machine.chains.push_back(machine.chains[0]);
  std::get<Actuator>(machine.chains[1].elements[0]).max = 7;
  const Machine bent = with_tool(machine, tool_3(machine));
  REQUIRE(bent.chains.size() == 1);
  CHECK(std::get<Group>(bent.chains[0].elements[0]).branches.size() == 2);
  REQUIRE(actuators(bent).size() == actuators(machine).size());
  CHECK(actuators(bent).back().max == 7);
}

TEST_CASE("a description shows the source of a tool's stiffness, also of a default") {
  const std::string text =
      describe(machine_with("[spindle]\nxyz_mm = [0, 0, -60]\n[tools.T1]\nlength_mm = "
                            "50\n[tools.T3]\nlength_mm = 60\ndiameter_mm = "
                            "10\nstickout_mm = 25\n[tools.T4]\nholder_N_per_um = 12.34\n"));
  CHECK(text.find("spindle      gauge line of tools' lengths at xyz 0 0 -60 mm from the platform\n") !=
        std::string::npos);
  CHECK(text.find("tools        T1 50 mm long\n") != std::string::npos);
  CHECK(text.find("tool T3      60 mm long, 10 mm diameter, 25 mm sticking out, stiffness from a carbide "
                  "cantilever of 0.8 diameter core, 25 mm long: 23.2 N/um at its tip\n") !=
        std::string::npos);
  CHECK(text.find("tool T4      stiffness from holder_N_per_um: 12.3 N/um at its tip\n") !=
        std::string::npos);
}
