// Masses of tools, the fixture and the temperature in machine files.
#include <algorithm>

#include "counterflex/geometry/types.hpp"
#include "machine/machine_texts.hpp"

using namespace counterflex;

TEST_CASE("the mass of [tool] is at the end of the first chain, that of another tool waits for it") {
  const Machine machine = machine_with(
      "gravity_m_s2 = [0, 0, -9.81]\n[tool]\nxyz_mm = [0, 0, -80]\nmass = { kg = 3.5, at_mm = [0, 0, 60] }\n"
      "[tools.T3]\nmass = { kg = 6 }\n");
  REQUIRE(machine.ends_with_tool_mass);
  const auto& mass = std::get<PointMass>(machine.chains[0].elements.back());
  CHECK(mass.kg == 3.5);
  CHECK(mass.at.isApprox(Vector3(0, 0, -0.02), 1e-12));
  CHECK(total_mass(machine) == 3.5);
  CHECK(total_mass(with_tool(machine, machine.tools.at(3))) == 6);
  CHECK(weighs(machine));
}

TEST_CASE("a fixture is placed in a work offset, or in the machine frame") {
  const std::string work = "[work.G54]\nxyz_mm = [100, 0, 0]\nrpy_deg = [0, 0, 90]\n";
  const Machine placed = machine_with(
      work + "[fixture]\nwork = \"G54\"\nxyz_mm = [10, 0, 0]\nstiffness_N_per_um = [20, 10, 50]\n");
  REQUIRE(placed.fixture);
  CHECK(placed.fixture->X_MF.p.isApprox(Vector3(0.1, 0.01, 0), 1e-12));
  CHECK(placed.fixture->C(1, 1) == doctest::Approx(1e-7));
  CHECK(placed.fixture->C.bottomRightCorner<3, 3>().isZero(0));
  const Machine full = machine_with(
      "[fixture]\nxyz_mm = [0, 0, 5]\nstiffness_si = [[2e7,0,0,0,0,0],[0,2e7,0,0,0,0],[0,0,2e7,0,0,0],"
      "[0,0,0,1e5,0,0],[0,0,0,0,1e5,0],[0,0,0,0,0,1e5]]\n");
  CHECK(full.fixture->C(3, 3) == doctest::Approx(1e-5));
  CHECK(full.fixture->X_MF.p.z() == doctest::Approx(0.005));
}

TEST_CASE("the shift of a machine is linear between the temperatures of its table") {
  const Machine machine = machine_with(
      "[tool]\nrpy_deg = [0, 90, 0]\n"
      "[thermal]\ntemperature_C = [18, 22, 30]\nx_um = [0, 8, -8]\nspindle_um = [0, 10, 50]\n");
  REQUIRE(machine.thermal);
  const ThermalShift at = thermal_shift(*machine.thermal, 24);
  CHECK(at.shift.isApprox(Vector3(4e-6, 0, 0), 1e-9));
  CHECK(at.growth / 20e-6 == doctest::Approx(1));
  CHECK(thermal_shift(*machine.thermal, 18).shift.isZero(0));
  CHECK(thermal_shift(*machine.thermal, 30).growth / 50e-6 == doctest::Approx(1));
  const Machine warm = at_temperature(machine, 24);
  CHECK(warm.temperature == 24);
  const auto& elements = warm.chains[0].elements;
  CHECK(std::get<AssemblyError>(elements.front()).X.p.isApprox(Vector3(4e-6, 0, 0), 1e-9));
  // The tip's z is the platform's x: the spindle grows along -x.
  CHECK(std::get<AssemblyError>(elements.back()).X.p.isApprox(Vector3(-20e-6, 0, 0), 1e-9));
}

TEST_CASE("the spindle grows along its own axis where the file has [spindle]") {
  const Machine machine = machine_with(
      "[tool]\nxyz_mm = [0, 0, -80]\n[spindle]\nrpy_deg = [0, 90, 0]\n"
      "[thermal]\ntemperature_C = [20, 30]\nspindle_um = [0, 40]\n");
  const Machine warm = at_temperature(machine, 30);
  CHECK(std::get<AssemblyError>(warm.chains[0].elements.back()).X.p.isApprox(Vector3(-40e-6, 0, 0), 1e-9));
}

TEST_CASE("a control that corrects weights keeps the zero of home, on which preloads act") {
  const Machine machine =
      machine_of(x_axis,
                 "controlled = [\"x\"]\ngravity_m_s2 = [0, 0, -9.81]\ngravity_reference = \"home\"\n"
                 "[controller]\nalready_corrects = [\"gravity\"]\n");
  CHECK(machine.gravity.g.isZero(0));
  CHECK(machine.gravity.true_at_home);
}

TEST_CASE("a machine at another temperature keeps its errors, whatever their names are") {
  Machine machine =
      machine_with("[thermal]\ntemperature_C = [20, 30]\nx_um = [0, 30]\nspindle_um = [0, 40]\n");
  for (const char* name : {"thermal_shift", "spindle_growth"})
    machine.chains[0].elements.push_back(AssemblyError{name, translation({5e-5, 0, 0})});
  const std::size_t count = machine.chains[0].elements.size();
  const Machine warm = at_temperature(at_temperature(machine, 25), 30);
  CHECK(warm.chains[0].elements.size() == count + 2);
  const auto is_own = [](const Element& element) {
    const auto* error = std::get_if<AssemblyError>(&element);
    return error != nullptr && error->X.p.isApprox(Vector3(5e-5, 0, 0), 1e-9);
  };
  CHECK(std::ranges::count_if(warm.chains[0].elements, is_own) == 2);
}
