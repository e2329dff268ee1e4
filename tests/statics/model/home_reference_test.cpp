/// A controller whose zero was set at home, under the machine's own weight.
#include <fmt/format.h>

#include "counterflex/statics/theory.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

const Stage own_weight{0, 0, 1, 1};

Model held_at_home(const std::string& name, double kg = 2) {
  Machine machine = heavy(machine_of(name), kg);
  machine.gravity.true_at_home = true;
  return prepare(machine);
}

Vector6 controlled_deviation(const Model& model, const Configuration& nominal, const Stage& stage,
                             StaticsWork& work) {
  const Equilibrium e = solve_forward(model, nominal, {}, stage, work);
  REQUIRE(e.status == Status::converged);
  const Vector6 all = deviation(tip(model.mechanism, e.configuration), tip(model.mechanism, nominal));
  Vector6 part = Vector6::Zero();
  for (Component c : model.mechanism.controlled) part[static_cast<int>(c)] = all[static_cast<int>(c)];
  return part;
}

Eigen::VectorXd offsets_of(const Model& model) {
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.mechanism.travel.size()));
  const auto collect = [&](const auto& self, const Series& series) -> void {
    for (const Part& part : series.parts)
      if (part.kind == PartKind::actuator) offsets[part.actuator] = part.offset;
    for (const SeriesGroup& group : series.groups)
      for (const Series& branch : group.branches) self(self, branch);
  };
  for (const Series& chain : model.mechanism.chains) collect(collect, chain);
  return offsets;
}

}  // namespace

TEST_CASE(
    "a zero set at home makes the perfect machine's tip true at home, and leaves the rest of its sag "
    "elsewhere") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model held = held_at_home(trial.name), unloaded = heavy_model_of(trial.name, 2);
    REQUIRE(held.gravity_status == Status::converged);
    StaticsWork work(held.mechanism), work_unloaded(unloaded.mechanism);
    CHECK(controlled_deviation(held, held.home, own_weight, work).norm() < 1e-10);
    CHECK(controlled_deviation(unloaded, unloaded.home, own_weight, work_unloaded).norm() > 1e-6);
    Random random(301);
    double there = 0, without_zero = 0;
    for (int n = 0; n < 10; ++n) {
      const Configuration nominal = somewhere(held, trial, random).configuration;
      there += controlled_deviation(held, nominal, own_weight, work).norm();
      without_zero += controlled_deviation(unloaded, nominal, own_weight, work_unloaded).norm();
    }
    CHECK(there > 1e-6);
    CHECK(there < without_zero);
  }
}

TEST_CASE("configurations keep the commanded values: a home that is true needs no correction") {
  for (const std::string name : {"orthoglide_case_b", "serial6r_link6", "laws_mixed"}) {
    CAPTURE(name);
    const Model held = held_at_home(name);
    StaticsWork work(held.mechanism);
    const Eigen::VectorXd home = actuator_values(held.mechanism, held.home);
    const Equilibrium target =
        solve_target(held, held.home, tip(held.mechanism, held.home), {}, own_weight, work);
    REQUIRE(target.status == Status::converged);
    CHECK((actuator_values(held.mechanism, target.configuration) - home).cwiseAbs().maxCoeff() < 1e-11);
    CHECK(offsets_of(held).cwiseAbs().maxCoeff() > 1e-7);
    CHECK(offsets_of(heavy_model_of(name, 2)).isZero(0));
  }
}

TEST_CASE("a zero set at home is the unloaded machine with its offsets commanded") {
  const std::string name =
      "orthoglide_case_b";  // its passive joints have no springs that would distinguish the two
  const Model held = held_at_home(name), unloaded = heavy_model_of(name, 2);
  StaticsWork work(held.mechanism), work_unloaded(unloaded.mechanism);
  const Load load{(Vector6() << 100, -60, 40, 0, 0, 0).finished(), false};
  const NominalResult at = follow(held, held.home, translation({0.05, 0.02, -0.03}));
  REQUIRE(at.status == Status::converged);
  const Eigen::VectorXd rho = actuator_values(held.mechanism, at.configuration);
  const NominalResult shifted = nominal_forward(unloaded, at.configuration, rho + offsets_of(held));
  REQUIRE(shifted.status == Status::converged);
  const Equilibrium a = solve_forward(held, at.configuration, load, {}, work);
  const Equilibrium b = solve_forward(unloaded, shifted.configuration, load, {}, work_unloaded);
  REQUIRE(a.status == Status::converged);
  REQUIRE(b.status == Status::converged);
  CHECK(difference(a.configuration.X_MP, b.configuration.X_MP).norm() < 1e-10);
  CHECK(actuator_values(held.mechanism, a.configuration) == rho);
}

TEST_CASE("where gravity does not act, neither do the offsets against it") {
  const Model held = held_at_home("laws_mixed"), light = model_of("laws_mixed");
  StaticsWork work(held.mechanism), work_light(light.mechanism);
  const Equilibrium a = solve_forward(held, held.home, {}, {1, 1, 1, 0}, work);
  const Equilibrium b = solve_forward(light, light.home, {}, {}, work_light);
  REQUIRE(a.status == Status::converged);
  CHECK(difference(a.configuration.X_MP, b.configuration.X_MP).norm() < 1e-12);
}

TEST_CASE("with a zero set at home, linear theory and nested targets agree with the finite model as ever") {
  for (const std::string name : {"orthoglide_case_b", "serial6r_link6", "laws_mixed"}) {
    CAPTURE(name);
    const Model held = held_at_home(name);
    StaticsWork work(held.mechanism);
    const Load load{(Vector6() << 60, -40, 30, 2, -1, 3).finished(), false};
    const Pose X_MT = tip(held.mechanism, held.home);
    const auto miss = [&](double s) {
      const Stage stage{s, s, s, s};
      const LinearResult linear = linear_deviation(held, held.home, load, stage, work);
      const Equilibrium finite = solve_forward(held, held.home, load, stage, work);
      REQUIRE(linear.status == Status::converged);
      REQUIRE(finite.status == Status::converged);
      return (deviation(tip(held.mechanism, finite.configuration), X_MT) - linear.dt_T).norm();
    };
    CHECK(miss(0.125) / miss(0.0625) == doctest::Approx(4).epsilon(0.1));
    const Equilibrium direct = solve_target(held, held.home, X_MT, load, {}, work);
    const Equilibrium nested = solve_target_nested(held, held.home, X_MT, load, {}, work);
    REQUIRE(direct.status == Status::converged);
    REQUIRE(nested.status == Status::converged);
    CHECK((actuator_values(held.mechanism, direct.configuration) -
           actuator_values(held.mechanism, nested.configuration))
              .cwiseAbs()
              .maxCoeff() < 1e-9);
  }
}

TEST_CASE("a machine that cannot be held at home under its weight has no such zero, and gives the reason") {
  const std::string text = R"(controlled = ["x"]
gravity_m_s2 = [0, 0, -9.81]
gravity_reference = "home"
[[chain]]
name = "link"
elements = [
  { actuator = "prismatic", axis = "x" },
  { compliance = "revolute", axis = "y", stiffness_Nm_per_rad = 500 },
  { rigid = { xyz_mm = [0, 0, 800] }, mass = { kg = )";
  CHECK(model_of_text(text + "63 } }]").gravity_status == Status::converged);  // 63.7 kg: k = m g L
  CHECK(model_of_text(text + "65 } }]").gravity_status == Status::unstable);
}

TEST_CASE(
    "a zero set at home is continuous in the mass: a machine without masses is the limit of light ones") {
  // Two preloaded springs against each other; the first one moves with the actuator.
  const auto machine = [](const std::string& mass) {
    return model_of_text(R"(controlled = ["x"]
gravity_m_s2 = [0, 0, -9.81]
gravity_reference = "home"
[home]
xyz_mm = [0, 0, 0]
[springs.a]
stiffness_diag_si = [1e6, 1e6, 1e6, 1e5, 1e5, 1e5]
preload_si = [3e-4, 0, 0, 0, 0, 0]
[springs.b]
stiffness_diag_si = [2e6, 2e6, 2e6, 1e5, 1e5, 1e5]
[[chain]]
name = "a"
elements = [{ actuator = "prismatic", axis = "x" }, { spring = "a")" +
                         mass + R"( }]
[[chain]]
name = "b"
elements = [{ passive = "prismatic", axis = "x", stiffness_N_per_m = 1e5, preload_mm = 0.1 }, { spring = "b" }])");
  };
  const auto tip_at_home = [](const Model& model) {
    StaticsWork work(model.mechanism);
    const Equilibrium e = solve_forward(model, model.home, {}, {}, work);
    REQUIRE(e.status == Status::converged);
    return tip(model.mechanism, e.configuration).p;
  };
  const Model without = machine("");
  CHECK(offsets_of(without).cwiseAbs().maxCoeff() > 1e-4);
  CHECK(std::abs(tip_at_home(without).x()) < 1e-12);
  for (const double kg : {1e-2, 1e-4, 1e-6}) {
    CAPTURE(kg);
    const Model light = machine(fmt::format(", mass = {{ kg = {} }}", kg));
    CHECK((tip_at_home(light) - tip_at_home(without)).norm() < 1e-4 * kg + 1e-12);
    CHECK((offsets_of(light) - offsets_of(without)).norm() < 1e-4 * kg + 1e-12);
  }
}
