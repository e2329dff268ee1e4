#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/theory.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// A chain with springs in all directions; `joint` is elastic about z.
std::string elastic_chain(const std::string& joint, const std::string& branches = "") {
  return R"(controlled = ["x", "y", "z"]
gravity_m_s2 = [0, -9.81, 0]
[springs]
k = { stiffness_diag_si = [1e6, 1e6, 1e6, 1e5, 1e5, 1e5], preload_si = [0, 1e-5, 0, 0, 0, 0] }
)" + branches +
         R"([[chain]]
name = "c"
elements = [ { actuator = "prismatic", axis = "x" }, { actuator = "prismatic", axis = "y" }, { actuator = "prismatic", axis = "z" },
             )" +
         joint +
         R"(, { rigid = { xyz_mm = [300, 0, 100] }, mass = { kg = 20, at_mm = [50, 0, 0] } }, { spring = "k" },
             { rigid = { xyz_mm = [0, 0, 200] } } ]
)";
}

// The same: two joints, each of which is rigid in five directions, share its moment.
Model with_two_joints() {
  return model_of_text(elastic_chain("{ parallel = [\"r1\", \"r2\"] }", R"([branches]
r1 = { elements = [ { compliance = "revolute", axis = "z", stiffness_Nm_per_rad = 1e5 } ] }
r2 = { elements = [ { passive = "revolute", axis = "z", stiffness_Nm_per_rad = 5e4 } ] }
)"));
}

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

TEST_CASE("branches that are rigid in some directions do not keep an elastic chain from being held") {
  const Model model = with_two_joints();
  const Model same = model_of_text(
      elastic_chain("{ compliance = \"revolute\", axis = \"z\", stiffness_Nm_per_rad = 1.5e5 }"));
  StaticsWork work(model.mechanism), same_work(same.mechanism);
  Random random(3);
  for (int k = 0; k < 5; ++k) {
    const Pose X_MP = k == 0 ? model.home.X_MP : moved(model.home.X_MP, random.six(1e-3, 5e-3));
    const HeldPlatform held = held_at(model, model.home, X_MP, work),
                       expected = held_at(same, same.home, X_MP, same_work);
    const Vector6 F = holding_wrench(held.configuration), F_same = holding_wrench(expected.configuration);
    CAPTURE(F.transpose());
    CHECK(F_same.norm() > 10);
    CHECK((F - F_same).norm() < 1e-7 * F_same.norm());
    const ChainStiffness K = chain_stiffness(model, 0, held.configuration.chains[0], {}, work),
                         K_same = chain_stiffness(same, 0, expected.configuration.chains[0], {}, same_work);
    REQUIRE(K.available);
    CHECK(size_in_units(K.K_C - K_same.K_C, 0.3) < 1e-7 * size_in_units(K_same.K_C, 0.3));
    REQUIRE(K.K_Ctheta.rows() == 6);  // of the spring: the group's branches are not listed
    CHECK(K.K_Cq.rows() == 0);
    CHECK((K.K_Ctheta - K_same.K_Ctheta.bottomRows<6>()).norm() < 1e-7 * K_same.K_Ctheta.norm());
    const ManipulatorStiffness sum = stiffness(model, held.configuration, {}, work);
    CHECK(sum.available);
    CHECK(sum.K == K.K_C);
  }
}

TEST_CASE("nested corrects a machine whose chain has such branches, as direct does") {
  const Model model = with_two_joints();
  StaticsWork work(model.mechanism);
  const Load load{(Vector6() << 100, -50, 80, 1, 2, -3).finished(), false};
  const Pose X_MT = tip(model.mechanism, model.home);
  const Equilibrium direct = solve_target(model, model.home, X_MT, load, {}, work),
                    nested = solve_target_nested(model, model.home, X_MT, load, {}, work);
  REQUIRE(direct.status == Status::converged);
  REQUIRE(nested.status == Status::converged);
  CHECK((actuator_values(model.mechanism, direct.configuration) -
         actuator_values(model.mechanism, nested.configuration))
            .norm() < 1e-9);
}
