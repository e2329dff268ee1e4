#include <doctest/doctest.h>

#include "counterflex/files/input_error.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

const std::string leg = R"(
home = {}
[branches.bar]
elements = [{ rigid = { xyz_mm = ["$reach", 0, 0] } }, { actuator = "revolute", axis = [0, 0, "$sense"] }]
[branches.frame]
elements = [{ error = "frame" }, { parallel = ["bar", "bar"] }]
[templates.leg]
elements = [
  { rigid = "anchor" },
  { error = "mount" },
  { actuator = "prismatic", axis = "x", min_mm = 0, max_mm = "$stroke" },
  { parallel = ["frame"] },
]
)";

const std::string chain_a = R"(
[[chain]]
name = "a"
use = "leg"
transforms.anchor = { xyz_mm = [1, 2, 3] }
values = { reach = 10, sense = -2, stroke = 400 }
errors.frame = { xyz_mm = [0.5, 0, 0] }
)";

const std::string chain_b = R"(
[[chain]]
name = "b"
base = { xyz_mm = [0, 0, 7] }
use = "leg"
platform = { rpy_deg = [0, 0, 180] }
transforms.anchor = { xyz_mm = [4, 5, 6] }
values = { reach = 20, sense = 1, stroke = 500 }
)";

Machine two_legs() {
  return read_machine(header + leg + chain_a + chain_b, "legs.toml");
}

const Branch& first_branch(const Branch& chain, std::size_t group) {
  return part<Group>(chain, group).branches.at(0);
}

}  // namespace

TEST_CASE("each chain fills its template with its own transforms, values and errors") {
  const Machine machine = two_legs();
  const Chain& a = machine.chains[0];
  CHECK(part<Rigid>(a, 0).X.p[0] == doctest::Approx(1e-3));
  CHECK(part<Actuator>(a, 2).max == doctest::Approx(0.4));
  const Chain& b = machine.chains[1];
  CHECK(part<Rigid>(b, 1).X.p[0] == doctest::Approx(4e-3));
  CHECK(part<Actuator>(b, 3).max == doctest::Approx(0.5));
}

TEST_CASE("values reach into branches of branches, and into arrays there") {
  const Machine machine = two_legs();
  const Branch& bar = first_branch(first_branch(machine.chains[0], 3), 1);
  CHECK(part<Rigid>(bar, 0).X.p[0] == doctest::Approx(10e-3));
  CHECK(part<Actuator>(bar, 1).joint.axis == -Vector3::UnitZ());
  CHECK(part<Rigid>(first_branch(first_branch(machine.chains[1], 4), 1), 0).X.p[0] == doctest::Approx(20e-3));
}

TEST_CASE("an error slot that a chain does not fill is identity, one inside a branch is filled like others") {
  const Machine machine = two_legs();
  CHECK(part<AssemblyError>(machine.chains[0], 1).X.p.isZero(0));
  CHECK(part<AssemblyError>(first_branch(machine.chains[0], 3), 0).X.p[0] == doctest::Approx(0.5e-3));
  CHECK(part<AssemblyError>(first_branch(machine.chains[1], 4), 0).X.p.isZero(0));
}

TEST_CASE("base comes before the template and platform after it, if they are given") {
  const Machine machine = two_legs();
  CHECK(machine.chains[0].elements.size() == 4);
  REQUIRE(machine.chains[1].elements.size() == 6);
  CHECK(part<Rigid>(machine.chains[1], 0).X.p[2] == doctest::Approx(7e-3));
  CHECK(part<Rigid>(machine.chains[1], 5).X.R(0, 0) == doctest::Approx(-1));
}

TEST_CASE("actuators are numbered in the order of chains, then of elements, through the branches of groups") {
  const std::vector<Actuator> all = actuators(two_legs());
  REQUIRE(all.size() == 6);
  CHECK(all[0].max == doctest::Approx(0.4));
  CHECK(all[1].joint.axis == -Vector3::UnitZ());
  CHECK(all[2].joint.axis == -Vector3::UnitZ());
  CHECK(all[3].max == doctest::Approx(0.5));
  CHECK(all[5].joint.axis == Vector3::UnitZ());
}

TEST_CASE("the perfect machine has no errors, neither in chains nor in branches, and is the same otherwise") {
  Machine machine = two_legs();
  std::get<AssemblyError>(machine.chains[1].elements[2]).X.p[1] = 1e-3;
  const Machine ideal = perfect(machine);
  CHECK(part<AssemblyError>(ideal.chains[1], 2).X.p.isZero(0));
  CHECK(part<AssemblyError>(first_branch(ideal.chains[0], 3), 0).X.p.isZero(0));
  CHECK(part<AssemblyError>(first_branch(ideal.chains[0], 3), 0).name == "frame");
  CHECK(part<Rigid>(ideal.chains[0], 0).X.p == part<Rigid>(machine.chains[0], 0).X.p);
  CHECK(part<AssemblyError>(first_branch(machine.chains[0], 3), 0).X.p[0] != 0);
}

TEST_CASE("a chain can list its elements itself, also with named values") {
  const Machine machine = read_machine(
      header + chain_text("{ rigid = { xyz_mm = [\"$h\", 0, 0] } }", "values.h = 3\n"), "machine.toml");
  CHECK(part<Rigid>(machine.chains[0], 0).X.p[0] == doctest::Approx(3e-3));
}

TEST_CASE("a chain can use one branch twice in series, but not inside itself") {
  const std::string branch = "[branches.bar]\nelements = [{ rigid = {} }]\n";
  CHECK_NOTHROW(machine_of("{ parallel = [\"bar\"] }, { parallel = [\"bar\", \"bar\"] }", branch));
  CHECK_THROWS_AS(
      machine_of("{ parallel = [\"bar\"] }", "[branches.bar]\nelements = [{ parallel = [\"bar\"] }]\n"),
      InputError);
}
