// Masses of tools, against masses of elements and forces in their place.
#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/nominal.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

Machine tool_sample(const std::string& name) {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/samples/" + name + "/machine.toml");
}

const Vector3 gravity_down(0, 0, -9.81);

Tool tool_of_mass(double kg, const Vector3& at) {
  Tool tool;
  tool.mass = PointMass{kg, at, "tool"};
  return tool;
}

Configuration home_under(const Model& model, const Load& load = {}) {
  StaticsWork work(model.mechanism);
  const Equilibrium found = solve_forward(model, model.home, load, {}, work);
  REQUIRE(found.status == Status::converged);
  return found.configuration;
}

}  // namespace

TEST_CASE("the mass of a tool acts as its weight at its place, on serial and parallel machines") {
  for (const char* name : {"mill3", "orthoglide-groove", "hexapod", "robot-ur10"}) {
    CAPTURE(name);
    Machine machine = tool_sample(name);
    machine.gravity = {gravity_down};
    const Model base = prepare(machine);
    const Vector3 at(0.01, -0.02, 0.07);
    const double kg = 4;
    const Model model = prepare_with_tool(machine, base, tool_of_mass(kg, at));
    const Pose X_MT = tip(model.mechanism, home_under(model));
    Load weight;
    weight.F << kg * gravity_down, (X_MT.R * at).cross(Vector3(kg * gravity_down));
    const Pose expected = tip(base.mechanism, home_under(base, weight));
    CHECK((X_MT.p - expected.p).norm() < 1e-9);
    CHECK((X_MT.R - expected.R).norm() < 1e-8);
    CHECK((X_MT.p - tip(base.mechanism, home_under(base)).p).norm() > 1e-8);
  }
}

TEST_CASE("the weight of a tool loads the ends of all chains as the same force on the platform does") {
  for (const char* name : {"mill3", "orthoglide-groove", "hexapod", "robot-ur10"})
    for (const bool bends : {false, true}) {
      CAPTURE(name);
      CAPTURE(bends);
      Machine machine = tool_sample(name);
      machine.gravity = {gravity_down};
      const Model base = prepare(machine);
      Tool tool = tool_of_mass(4, {0.01, -0.02, 0.07});
      if (bends) tool.yields = radial_tool(2e7);
      const Model model = prepare_with_tool(machine, base, tool);
      const Configuration heavy = home_under(model);
      const Pose X_MT = heavy.X_MP * model.mechanism.X_PT;
      const Vector3 arm = X_MT.R * tool.mass->at, force = 4 * gravity_down;
      Load weight;
      weight.F << force, arm.cross(force);
      const auto expected = loads(base.mechanism, base, home_under(base, weight));
      const auto found = loads(base.mechanism, model, heavy);
      REQUIRE(found.size() == expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        CAPTURE(i);
        CHECK((found[i].wrench - expected[i].wrench).norm() < 1e-5 * (1 + expected[i].wrench.norm()));
      }
    }
}

TEST_CASE("a tool with a mass replaces that of [tool], and a tool without one keeps it") {
  Machine machine = tool_sample("mill3");
  machine.gravity = {gravity_down};
  machine.chains[0].elements.push_back(PointMass{7, machine.X_PT * Vector3(0, 0, 0.05), "tool"});
  machine.ends_with_tool_mass = true;
  CHECK(total_mass(with_tool(machine, tool_of_mass(2, Vector3::Zero()))) == 2);
  Tool long_tool;
  long_tool.yields = radial_tool(2e7);
  CHECK(total_mass(with_tool(machine, long_tool)) == 7);
  long_tool.mass = PointMass{3, Vector3::Zero(), "tool"};
  CHECK(total_mass(with_tool(machine, long_tool)) == 3);
  CHECK(changes_model(machine, tool_of_mass(2, Vector3::Zero())));
  machine.gravity = {};
  CHECK_FALSE(changes_model(machine, tool_of_mass(2, Vector3::Zero())));
}

TEST_CASE("a mass in front of a tool that bends is carried by the machine, not by the tool") {
  for (const char* name : {"mill3", "orthoglide-groove", "hexapod"}) {
    CAPTURE(name);
    Machine machine = tool_sample(name);
    machine.gravity = {gravity_down};
    const Model base = prepare(machine);
    Tool tool = tool_of_mass(5, Vector3(0, 0, 0.1));
    const double without_tool = total_mass(machine);
    const Model rigid = prepare_with_tool(machine, base, tool);
    const Pose stiff = tip(rigid.mechanism, home_under(rigid));
    tool.yields = radial_tool(1e6);
    CHECK(total_mass(with_tool(machine, tool)) == without_tool + 5);
    const Model bent = prepare_with_tool(machine, base, tool);
    CHECK((tip(bent.mechanism, home_under(bent)).p - stiff.p).norm() < 1e-9);
  }
}
