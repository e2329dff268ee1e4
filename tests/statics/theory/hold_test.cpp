#include "counterflex/statics/chain.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

double energy_of(const Model& model, const Configuration& configuration) {
  double energy = 0;
  for (std::size_t i = 0; i < configuration.chains.size(); ++i) {
    energy += elastic_energy(model.mechanism.chains[i], configuration.chains[i], {});
    energy += weight_energy(model.mechanism.chains[i], configuration.chains[i], {}, model.mechanism.gravity);
  }
  return energy;
}

HeldPlatform held_at(const Model& model, const Configuration& nominal, const Pose& X_MP, StaticsWork& work) {
  HeldPlatform held = hold_platform(model, nominal, X_MP, {}, work);
  REQUIRE(held.status == Status::converged);
  return held;
}

}  // namespace

TEST_CASE("the wrench that holds the platform is the gradient of the energy by its pose") {
  for (const Trial& trial : controlled_machines()) {
    if (trial.name == "hexapod_free_joints") continue;  // its legs have no stiffness of their own
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(5);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Pose X_MP = moved(nominal.X_MP, random.six(2e-4, 1e-3));
    const Vector6 F = holding_wrench(held_at(model, nominal, X_MP, work).configuration);
    Vector6 expected;
    for (int k = 0; k < 6; ++k)
      expected[k] = central_difference(
          [&](double h) {
            return energy_of(model, held_at(model, nominal, moved(X_MP, h * unit(k)), work).configuration);
          },
          k < 3 ? 2e-6 : 2e-5);
    CAPTURE(F.transpose());
    CAPTURE(expected.transpose());
    CHECK(F.norm() > 1);
    CHECK((F - expected).norm() < 1e-5 * F.norm());
  }
}

TEST_CASE(
    "a platform held where the loaded machine is needs that load, and its chains carry the same wrenches") {
  for (const char* name : {"orthoglide_case_b", "serial6r_link6", "laws_mixed"}) {
    CAPTURE(name);
    const Model model = model_of(name);
    StaticsWork work(model.mechanism);
    const Load load{(Vector6() << 60, -20, 30, 1, 2, -1).finished(), false};
    const Equilibrium loaded = solve_forward(model, model.home, load, {}, work);
    REQUIRE(loaded.status == Status::converged);
    const HeldPlatform held = held_at(model, model.home, loaded.configuration.X_MP, work);
    CHECK((holding_wrench_at_tip(model.mechanism, held.configuration) - load.F).norm() < 1e-5);
    for (std::size_t i = 0; i < held.configuration.chains.size(); ++i)
      CHECK((held.configuration.chains[i].F - loaded.configuration.chains[i].F).norm() < 1e-5);
  }
}

TEST_CASE("a machine with a chain that has no stiffness of its own cannot be held, and its name is known") {
  const Model model = model_of_text(R"(
controlled = ["x"]
[[chain]]
name = "slide"
elements = [ { actuator = "prismatic", axis = "x" }, { compliance = "prismatic", axis = "y", stiffness_N_per_m = 4e6 } ]
)");
  StaticsWork work(model.mechanism);
  const HeldPlatform held = hold_platform(model, model.home, translation(Vector3(0, 1e-4, 0)), {}, work);
  CHECK(held.status == Status::singular);
  CHECK(held.chain == 0);
}
