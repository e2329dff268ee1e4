#include "counterflex/machine/parameters.hpp"

#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "machine/machine_texts.hpp"

using namespace counterflex;

namespace {

const std::string named_arm = R"(format = "counterflex-machine 1"
controlled = ["x"]

[springs.post]
stiffness_diag_si = [1e7, 2e7, 0, 1e5, 1e5, 1e5]
[springs.bar]
beam = { length_mm = 300, EA_N = 1e7, GJ_Nm2 = 13, EIy_Nm2 = 100, EIz_Nm2 = 33 }

[[chain]]
name = "arm"
elements = [
  { actuator = "prismatic", axis = "x" },
  { error = "mount" },
  { compliance = "revolute", axis = "z", stiffness_Nm_per_rad = 1e6, name = "A1", mass = { kg = 3, name = "link" } },
  { compliance = "prismatic", axis = "z", stiffness_N_per_m = 1e8 },
  { spring = "post", mass = { kg = 5 } },
  { spring = "bar" },
]
errors.mount = { xyz_mm = [1, 2, 3], rpy_deg = [0, 0, 0.5] }
)";

Machine arm_with(const std::string& entries) {
  return read_machine(named_arm + "\n[parameters]\n" + entries, "arm.toml");
}

double parameter_value(const Machine& machine, const std::string& name) {
  for (const Parameter& parameter : parameters(machine))
    if (parameter.name == name) return parameter.value / parameter.unit;
  FAIL("no parameter " << name);
  return 0;
}

std::string parameter_error(const std::string& entries) {
  try {
    arm_with(entries);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("every number that measurements can identify has a name") {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters(read_machine(named_arm, "arm.toml")))
    names.push_back(parameter.name);
  CHECK(names == std::vector<std::string>{"mount.x_mm", "mount.y_mm", "mount.z_mm", "mount.rx_deg",
                                          "mount.ry_deg", "mount.rz_deg", "A1.compliance_rad_per_Nm",
                                          "link.kg", "compliance1.compliance_m_per_N", "post.x_m_per_N",
                                          "post.y_m_per_N", "post.rx_rad_per_Nm", "post.ry_rad_per_Nm",
                                          "post.rz_rad_per_Nm", "mass1.kg", "bar.compliance_m_per_N"});
}

TEST_CASE("values of parameters replace those of the elements") {
  const Machine machine = arm_with(R"("mount.y_mm" = { value = -4, source = "measured", sigma = 0.1 }
"A1.compliance_rad_per_Nm" = { value = 4e-6, source = "catalogue", prior_percent = 50 }
"post.x_m_per_N" = { value = 3e-7, source = "prior" }
"bar.compliance_m_per_N" = { value = 1e-6, source = "prior" }
)");
  CHECK(parameter_value(machine, "mount.y_mm") == doctest::Approx(-4));
  CHECK(parameter_value(machine, "mount.rz_deg") == doctest::Approx(0.5));
  CHECK(parameter_value(machine, "A1.compliance_rad_per_Nm") / 4e-6 == doctest::Approx(1));
  CHECK(parameter_value(machine, "post.x_m_per_N") / 3e-7 == doctest::Approx(1));
  CHECK(parameter_value(machine, "post.y_m_per_N") / 5e-8 == doctest::Approx(1));
  CHECK(parameter_value(machine, "bar.compliance_m_per_N") / 1e-6 == doctest::Approx(1));
  REQUIRE(machine.parameters.size() == 4);
  CHECK(machine.parameters[0].name == "mount.y_mm");
  CHECK(*machine.parameters[0].sigma / 1e-4 == doctest::Approx(1));
  CHECK(*machine.parameters[1].sigma / 2e-6 == doctest::Approx(1));
}

TEST_CASE("setting the values that a machine has changes no bit of it") {
  const Machine machine = read_machine(named_arm, "arm.toml");
  std::vector<double> values;
  for (const Parameter& parameter : parameters(machine)) values.push_back(parameter.value);
  const Machine same = with_parameters(machine, values);
  const auto& error = std::get<AssemblyError>(same.chains[0].elements[1]);
  CHECK(error.X == std::get<AssemblyError>(machine.chains[0].elements[1]).X);
}

TEST_CASE("parameters of a machine of several chains begin with the chain's name") {
  const std::vector<Parameter> all =
      parameters(load_machine(COUNTERFLEX_SOURCE_DIR "/samples/orthoglide-groove/machine.toml"));
  bool found = false;
  for (const Parameter& parameter : all) found = found || parameter.name == "y.mount.rx_deg";
  CHECK(found);
}

TEST_CASE("a machine is unmeasured if it states sources and no compliance among them is measured") {
  CHECK_FALSE(is_unmeasured(read_machine(named_arm, "arm.toml")));
  CHECK(is_unmeasured(arm_with(R"("mount.x_mm" = { source = "measured" })")));
  CHECK(is_unmeasured(arm_with(R"("post.x_m_per_N" = { source = "catalogue" })")));
  CHECK_FALSE(is_unmeasured(arm_with(R"("post.x_m_per_N" = { source = "measured" })")));
  const NumberSources sources = number_sources(arm_with(R"("post.x_m_per_N" = { source = "measured" }
"mount.x_mm" = { source = "prior" })"));
  CHECK(sources.measured == 1);
  CHECK(sources.prior == 1);
  CHECK(sources.total() == 2);
}

TEST_CASE("bad parameters are refused at their place") {
  CHECK(parameter_error(R"("mount.rz" = { source = "prior" })") ==
        "arm.toml:22:1: error: the machine has no parameter \"mount.rz\"; did you mean \"mount.rz_deg\"?; "
        "`check "
        "--parameters` lists them");
  CHECK(parameter_error(R"("mount.x_mm" = { sigma = 1 })").find("source") != std::string::npos);
  CHECK(parameter_error(R"("A1.compliance_rad_per_Nm" = { value = -1e-6, source = "measured" })")
            .find("value") != std::string::npos);
  CHECK(parameter_error(R"("mount.x_mm" = { sigma = 1, prior_percent = 3, source = "prior" })")
            .find("prior_percent") != std::string::npos);
  CHECK(parameter_error(R"("mount.rx_deg" = { prior_percent = 3, source = "prior" })").find("sigma") !=
        std::string::npos);
  CHECK(parameter_error(R"("mount.x_mm" = { source = "guess" })").find("\"guess\"") != std::string::npos);
}

TEST_CASE("the reversal of an actuator is a parameter by the name of its axis, also if it is zero") {
  const Machine machine = read_machine(
      "format = \"counterflex-machine 1\"\n[parameters]\n\"Y.reversal_um\" = { value = 7, source = "
      "\"measured\", sigma = 2 }\n[[chain]]\nname = \"axes\"\nelements = [\n"
      "{ actuator = \"prismatic\", axis = \"x\" },\n"
      "{ actuator = \"prismatic\", axis = \"y\", reversal_um = 0 },\n"
      "{ actuator = \"revolute\", axis = \"z\", reversal_arcsec = 18 },\n]\n",
      "m.toml");
  const std::vector<Parameter> list = parameters(machine);
  REQUIRE(list.size() == 2);
  CHECK(list[0].name == "Y.reversal_um");
  CHECK(list[0].kind == ParameterKind::reversal);
  CHECK(list[0].value / 7e-6 == doctest::Approx(1));
  CHECK(list[1].name == "C.reversal_mdeg");
  CHECK(list[1].value / list[1].unit == doctest::Approx(5));
  const Machine other = with_parameters(machine, {1e-5, list[1].value});
  CHECK(*std::get<Actuator>(other.chains[0].elements[1]).reversal == 1e-5);
}

TEST_CASE("harmonics, and the errors of a table that states their deviation, are parameters of their axis") {
  const std::string text = R"(
format = "counterflex-machine 1"
[error_tables.x]
positions_mm = [-50, 0, 33.5]
EXX_um = [1, 2, 3]
EYX_um = [7, 8, 9]
sigma_um = 4
[error_tables.y]
positions_mm = [0, 10]
EYY_um = [1, 2]
[[chain]]
name = "axes"
elements = [
  { actuator = "prismatic", axis = [-1, 0, 0], error_table = "x" },
  { actuator = "prismatic", axis = "y", error_table = "y" },
  { actuator = "revolute", axis = "z", harmonics_mdeg = [0, 5] },
]
)";
  const Machine machine = read_machine(text, "axes.toml");
  const std::vector<Parameter> list = parameters(machine);
  std::vector<std::string> names;
  std::vector<double> values;
  for (const Parameter& parameter : list) {
    names.push_back(parameter.name);
    values.push_back(parameter.value);
  }
  CHECK(names == std::vector<std::string>{"X.error[-50]_um", "X.error[0]_um", "X.error[33.5]_um",
                                          "C.sin_mdeg", "C.cos_mdeg"});
  CHECK(values[0] / 1e-6 == doctest::Approx(-1));  // along the axis
  CHECK(values[4] / deg == doctest::Approx(5e-3));
  values[2] = 6e-6, values[3] = 1e-4;
  const std::vector<Actuator> changed = actuators(with_parameters(machine, values));
  CHECK((changed[0].errors->errors[2].head<3>() - Vector3(-6e-6, 9e-6, 0)).norm() < 1e-18);
  CHECK(changed[2].harmonics[0] == 1e-4);
  CHECK(largest_harmonic(changed[2]) == doctest::Approx(std::hypot(1e-4, values[4])));
  CHECK(actuators(perfect(machine))[2].harmonics.empty());
}
