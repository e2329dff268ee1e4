/// Machines under their own weight, against closed forms and the laws of weights.
#include <fmt/format.h>

#include "counterflex/statics/theory.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double g = 9.81;
const Stage weights_alone{0, 0, 0, 1};

Equilibrium under_weight(const Model& model, const Stage& stage = weights_alone) {
  StaticsWork work(model.mechanism);
  return solve_forward(model, model.home, {}, stage, work);
}

Vector6 sag(const Model& model, const Stage& stage = weights_alone) {
  const Equilibrium e = under_weight(model, stage);
  REQUIRE(e.status == Status::converged);
  return deviation(tip(model.mechanism, e.configuration), tip(model.mechanism, model.home));
}

// A cantilever of 1 m along x in n beams, its 12 kg shared by their ends: half a share at the tip.
Model cantilever_of(int n) {
  std::string elements;
  for (int i = 1; i <= n; ++i)
    elements += fmt::format(
        "{{ rigid = {{ xyz_mm = [{}, 0, 0] }} }}, {{ spring = \"piece\", mass = {{ kg = {} }} }},\n",
        1000.0 / n, (i < n ? 12.0 : 6.0) / n);
  return model_of_text(
      fmt::format("controlled = []\ngravity_m_s2 = [0, 0, -{}]\n[springs.piece]\nbeam = {{ length_mm = {}, "
                  "EA_N = 1e8, GJ_Nm2 = 2e4, "
                  "EIy_Nm2 = 3e4, EIz_Nm2 = 5e4 }}\n[[chain]]\nname = \"beam\"\nelements = [{}]",
                  g, 1000.0 / n, elements));
}

// A mass at the end of a link above a joint of stiffness `k` (N m/rad) or, at 0, on a free one.
Model pendulum(double k, double length_mm, double kg) {
  const std::string joint =
      k > 0 ? fmt::format("{{ compliance = \"revolute\", axis = \"y\", stiffness_Nm_per_rad = {} }}", k)
            : "{ passive = \"revolute\", axis = \"y\" }";
  return model_of_text(
      fmt::format("controlled = []\ngravity_m_s2 = [0, 0, -{}]\n[[chain]]\nname = \"link\"\nelements = [{}, "
                  "{{ rigid = {{ xyz_mm = [0, 0, {}] }}, mass = {{ kg = {} }} }}]",
                  g, joint, length_mm, kg));
}

Machine turned(Machine machine, const Matrix3& R) {
  for (Chain& chain : machine.chains) chain.elements.insert(chain.elements.begin(), Rigid{rotation(R)});
  if (machine.home_X_MP) machine.home_X_MP = rotation(R) * *machine.home_X_MP;
  machine.gravity.g = R * machine.gravity.g;
  return machine;
}

}  // namespace

TEST_CASE(
    "a cantilever of lumped masses sags by w L^4 / 8EI (1 + h^2 / 3), h its pieces' part of the length") {
  const double w = 12 * g, EI = 3e4, closed = w / (8 * EI);
  double before = 0;
  for (const int n : {2, 4, 8, 16}) {
    CAPTURE(n);
    const double z = -sag(cantilever_of(n))[2], miss = z / closed - 1;
    CHECK(miss == doctest::Approx(1.0 / (3.0 * n * n)).epsilon(1e-3));
    if (n > 2) CHECK(before / miss == doctest::Approx(4).epsilon(1e-3));  // second order
    before = miss;
  }
}

TEST_CASE(
    "two chains under gravity alone: they sink by (m1 + m2) g / (k1 + k2) and lean by a root in closed "
    "form") {
  const double k1 = 2e5, k2 = 3e5, r1 = 900, r2 = 700, m1 = 11, m2 = 7, a = 0.25;
  const Model model = model_of_text(R"(controlled = []
gravity_m_s2 = [0, 0, -9.81]
home = {}
[springs.first]
stiffness_diag_si = [1e6, 1e6, 2e5, 1e3, 900, 1e3]
[springs.second]
stiffness_diag_si = [2e6, 1e6, 3e5, 2e3, 700, 1e3]
[[chain]]
name = "one"
elements = [{ spring = "first", mass = { kg = 11, at_mm = [250, 0, 0] } }]
[[chain]]
name = "two"
elements = [{ spring = "second", mass = { kg = 7 } }])");
  const Equilibrium e = under_weight(model);
  REQUIRE(e.status == Status::converged);
  const Vector6 d = deviation(e.configuration.X_MP, Pose{});
  double theta = 0;  // (r1 + r2) theta = m1 g a cos(theta), contracting
  for (int i = 0; i < 100; ++i) theta = m1 * g * a * std::cos(theta) / (r1 + r2);
  CHECK(d[2] == doctest::Approx(-(m1 + m2) * g / (k1 + k2)).epsilon(1e-11));
  CHECK(d[4] == doctest::Approx(theta).epsilon(1e-11));
  CHECK(std::abs(d[0]) + std::abs(d[1]) + std::abs(d[3]) + std::abs(d[5]) < 1e-12);
  const Vector6 F1 = e.configuration.chains[0].F,
                F2 = e.configuration.chains[1].F;  // exerted by the platform
  CHECK(F1[2] == doctest::Approx(k1 * d[2] + m1 * g).epsilon(1e-10));
  CHECK(F2[2] == doctest::Approx(k2 * d[2] + m2 * g).epsilon(1e-10));
  CHECK(F2[4] == doctest::Approx(r2 * theta).epsilon(1e-10));
  CHECK((F1 + F2).norm() < 1e-8);
}

TEST_CASE("an arm of two elastic joints at finite angles satisfies the equations written for it by hand") {
  const Model model = model_of_text(R"(controlled = ["x", "z"]
gravity_m_s2 = [0, 0, -9.81]
[[chain]]
name = "arm"
elements = [
  { actuator = "revolute", axis = "y", home_deg = -50 },
  { compliance = "revolute", axis = "y", stiffness_Nm_per_rad = 4000 },
  { rigid = { xyz_mm = [900, 0, 0] }, mass = { kg = 35 } },
  { actuator = "revolute", axis = "y", home_deg = 80 },
  { compliance = "revolute", axis = "y", stiffness_Nm_per_rad = 1500 },
  { rigid = { xyz_mm = [600, 0, 0] }, mass = { kg = 20, at_mm = [-200, 0, 0] } },
])");
  const Equilibrium e = under_weight(model);
  REQUIRE(e.status == Status::converged);
  const Eigen::VectorXd& x = e.configuration.chains[0].x;  // q1, theta1, q2, theta2
  const double a1 = x[0] + x[1], a12 = a1 + x[2] + x[3];
  CHECK(x[1] > 0.05);
  CHECK(4000 * x[1] ==
        doctest::Approx(g * ((35 + 20) * 0.9 * std::cos(a1) + 20 * 0.4 * std::cos(a12))).epsilon(1e-11));
  CHECK(1500 * x[3] == doctest::Approx(g * 20 * 0.4 * std::cos(a12)).epsilon(1e-11));
}

TEST_CASE("an inverted pendulum is stable up to k = m g L and unstable beyond") {
  const double k = 500, L = 0.8, critical = k / (g * L);
  const Model below = pendulum(k, 1e3 * L, 0.999 * critical), above = pendulum(k, 1e3 * L, 1.001 * critical);
  CHECK(under_weight(below).status == Status::converged);
  CHECK(under_weight(above).status == Status::unstable);
}

TEST_CASE("a column buckles under the mass on its top at pi^2 EI / 4 L^2, with or without masses along it") {
  const auto column = [](double kg) {
    std::string elements;
    for (int i = 1; i <= 8; ++i)
      elements += "{ rigid = { xyz_mm = [0, 0, 125] } }, { spring = \"piece\" },\n";
    return model_of_text(
        fmt::format("controlled = []\ngravity_m_s2 = [0, 0, -{}]\n[springs.piece]\nbeam = {{ length_mm = "
                    "125, EA_N = 1e8, GJ_Nm2 = 2e4, "
                    "EIy_Nm2 = 100, EIz_Nm2 = 200, axis = \"z\" }}\n[[chain]]\nname = \"column\"\nelements = "
                    "[{}{{ rigid = {{}}, mass "
                    "= {{ kg = {} }} }}]",
                    g, elements, kg));
  };
  const double critical = std::numbers::pi * std::numbers::pi * 100 / 4 / g;
  CHECK(under_weight(column(0.98 * critical)).status == Status::converged);
  CHECK(under_weight(column(1.02 * critical)).status == Status::unstable);
}

TEST_CASE("a pendulum that hangs on a free joint is stable, and one that is upright on it is not") {
  const Model hanging = pendulum(0, -600, 5), standing = pendulum(0, 600, 5);
  CHECK(under_weight(hanging).status == Status::converged);
  CHECK(under_weight(standing).status == Status::unstable);
  CHECK(under_weight(hanging, nominal_stage).status == Status::singular);  // without weight nothing holds it
}

TEST_CASE("a mass on the platform weighs the same, whichever chain it is listed in") {
  const PointMass mass{9, {0.1, -0.05, 0.2}};
  for (const std::string name : {"orthoglide_case_b", "hexapod_joint_springs", "laws_mixed"}) {
    CAPTURE(name);
    const auto with_mass_in = [&](std::size_t chain) {
      Machine machine = machine_of(name);
      machine.gravity.g = tilted_gravity;
      machine.chains[chain].elements.push_back(mass);
      return sag(prepare(machine), {});
    };
    CHECK((with_mass_in(0) - with_mass_in(1)).norm() < 1e-10);
    CHECK((with_mass_in(0) - sag(model_of(name), {})).norm() > 1e-6);
  }
}

TEST_CASE("a weight on the platform is a force at its place") {
  const double kg = 9;
  for (const std::string name : {"orthoglide_case_b", "serial6r_link6", "laws_mixed"}) {
    CAPTURE(name);
    Machine machine = machine_of(name);
    const Vector3 at_tip = machine.X_PT.p;
    const Model light = prepare(machine);
    machine.gravity.g = tilted_gravity;
    machine.chains[0].elements.push_back(PointMass{kg, at_tip});
    const Model heavy_model = prepare(machine);
    StaticsWork work_light(light.mechanism), work_heavy(heavy_model.mechanism);
    Vector6 weight = Vector6::Zero();
    weight.head<3>() = kg * tilted_gravity;
    const Equilibrium a = solve_forward(light, light.home, {weight, false}, {}, work_light);
    const Equilibrium b = solve_forward(heavy_model, heavy_model.home, {}, {}, work_heavy);
    REQUIRE(a.status == Status::converged);
    REQUIRE(b.status == Status::converged);
    CHECK(difference(a.configuration.X_MP, b.configuration.X_MP).norm() < 1e-10);
  }
}

TEST_CASE("turning machine and gravity together turns the answer") {
  const Matrix3 R = exp_so3({0.7, -1.1, 0.4});
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Machine machine = heavy(machine_of(trial.name), 3);
    const Model here = prepare(machine), there = prepare(turned(machine, R));
    const Equilibrium a = under_weight(here, {}), b = under_weight(there, {});
    REQUIRE(a.status == Status::converged);
    REQUIRE(b.status == Status::converged);
    CHECK(difference(b.configuration.X_MP, rotation(R) * a.configuration.X_MP).norm() < 1e-10);
    Machine left = turned(machine, R);
    left.gravity = machine.gravity;  // turning the machine alone does not
    CHECK(difference(under_weight(prepare(left), {}).configuration.X_MP, b.configuration.X_MP).norm() > 1e-6);
  }
}

TEST_CASE("doubling the masses doubles a small sag, but for a rest of second order") {
  for (const std::string name : {"serial6r_link6", "laws_mixed", "orthoglide_perfect"}) {
    CAPTURE(name);
    const auto rest = [&](double kg) -> Vector6 {
      return sag(heavy_model_of(name, 2 * kg)) - 2 * sag(heavy_model_of(name, kg));
    };
    const double size = sag(heavy_model_of(name, 0.2)).norm();
    CHECK(rest(0.2).norm() < 0.1 * size);
    CHECK(rest(0.2).norm() / rest(0.1).norm() == doctest::Approx(4).epsilon(0.1));
  }
}

TEST_CASE("weights count for what a force residual is measured by") {
  const Model model = heavy_model_of("laws_mixed");
  StaticsWork work(model.mechanism);
  evaluate_all(model, model.home, {}, work.impl());
  Residual residual;
  add_residual(model.mechanism.chains[0], zero_configuration(model.mechanism).chains[0],
               work.impl().chains[0], {model.mechanism.length}, residual);
  CHECK(residual.largest ==
        doctest::Approx(model.mechanism.chains[0].mass * tilted_gravity.norm()).epsilon(1e-12));
}
