/// Equilibrium of the manipulator: balance, statuses, and what the continuation starts from.
#include "counterflex/statics/equilibrium.hpp"

#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

Vector6 sum_of_wrenches(const Configuration& configuration) {
  Vector6 sum = Vector6::Zero();
  for (const SeriesState& chain : configuration.chains) sum += chain.F;
  return sum;
}

double largest_wrench(const Configuration& configuration) {
  double size = 1;
  for (const SeriesState& chain : configuration.chains) size = std::max(size, chain.F.norm());
  return size;
}

Vector6 tip_deviation(const Model& model, const Configuration& nominal, const Load& load, const Stage& stage,
                      StaticsWork& work) {
  const Equilibrium e = solve_forward(model, nominal, load, stage, work);
  REQUIRE(e.status == Status::converged);
  return deviation(tip(model.mechanism, e.configuration), tip(model.mechanism, nominal));
}

const char* const rigid_group = R"(controlled = []
[springs.s]
stiffness_diag_si = [1e6, 2e6, 3e6, 4e3, 5e3, 6e3]
[branches.bar]
elements = [{ rigid = { xyz_mm = [100, 0, 0] } }]
[[chain]]
name = "only"
elements = [{ spring = "s" }, { parallel = ["bar", "bar"] }])";

}  // namespace

TEST_CASE("the wrenches of an unloaded assembly sum to zero, though they are not zero") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(81);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Equilibrium e = solve_forward(model, nominal, {}, {}, work);
    REQUIRE(e.status == Status::converged);
    CHECK(sum_of_wrenches(e.configuration).norm() < 1e-7 + 1e-8 * largest_wrench(e.configuration));
    if (trial.name == "orthoglide_case_b" || trial.name == "laws_mixed")
      CHECK(largest_wrench(e.configuration) > 2);
  }
}

TEST_CASE("chain wrenches sum to the applied one, whose moment is taken in the deflected pose") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(82);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Vector6 F = random.six(trial.force, trial.moment);
    for (const bool at_platform : {false, true}) {
      CAPTURE(at_platform);
      const Equilibrium e = solve_forward(model, nominal, {F, at_platform}, {}, work);
      REQUIRE(e.status == Status::converged);
      const Pose& X_MP = e.configuration.X_MP;
      const Vector3 r = at_platform ? Vector3::Zero() : Vector3(X_MP.R * model.mechanism.X_PT.p);
      CHECK((sum_of_wrenches(e.configuration) - wrench_at(F, r)).norm() < 1e-6);
    }
  }
}

TEST_CASE("forward solutions keep their actuators and their nominal configuration") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(83);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Equilibrium e = solve_forward(model, nominal, random.load(trial), {}, work);
    REQUIRE(e.status == Status::converged);
    CHECK(actuator_values(model.mechanism, e.configuration) == actuator_values(model.mechanism, nominal));
    for (std::size_t i = 0; i < nominal.chains.size(); ++i)
      CHECK(e.configuration.chains[i].x_nominal == nominal.chains[i].x);
  }
}

TEST_CASE("errors and loads do not quite add up, and come nearer to it as they shrink") {
  for (const std::string name : {"orthoglide_case_b", "hexapod_joint_springs"}) {
    CAPTURE(name);
    const Model model = model_of(name);
    StaticsWork work(model.mechanism);
    const Load load{(Vector6() << 215, -10, -25, 1, 21.5, 0).finished(), true};
    const auto discrepancy = [&](double s) {
      const auto D = [&](double e, double f) {
        return tip_deviation(model, model.home, load, {e, f, 1}, work);
      };
      return (D(s, s) - D(s, 0) - D(0, s) + D(0, 0)).norm();
    };
    const double whole = discrepancy(0.5), half = discrepancy(0.25);
    CHECK(whole > 1e-9);  // hundreds of times what a solution is accurate to
    CHECK(whole / half == doctest::Approx(4).epsilon(0.15));  // the leading term is bilinear
  }
}

TEST_CASE("a machine without load, errors and preloads deviates by nothing") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    CHECK(tip_deviation(model, model.home, {}, nominal_stage, work).norm() < 1e-11);
  }
}

TEST_CASE("redundant rigid closures converge, are marked, and share the load by minimum norm") {
  const Model model = model_of_text(rigid_group);
  StaticsWork work(model.mechanism);
  const Load load{(Vector6() << 100, 20, -30, 1, 2, 3).finished(), true};
  const Equilibrium e = solve_forward(model, model.home, load, {}, work);
  REQUIRE(e.status == Status::converged);
  CHECK(e.indeterminate);
  const auto& branches = e.configuration.chains[0].groups[0].branches;
  CHECK((branches[0].F - branches[1].F).norm() < 1e-9);
  CHECK(2 * branches[0].F.head<3>().norm() == doctest::Approx(load.F.head<3>().norm()).epsilon(1e-9));

  const Model single = model_of("cantilever");
  StaticsWork single_work(single.mechanism);
  CHECK_FALSE(solve_forward(single, single.home, load, {}, single_work).indeterminate);
}

TEST_CASE("a chain that cannot be condensed deflects by the closed form: one elastic joint, a large angle") {
  const Model model = model_of("arm");  // 5000 N m/rad, 1.2 m
  StaticsWork work(model.mechanism);
  const Load load{2500 * unit(1), false};
  const Equilibrium e = solve_forward(model, model.home, load, {}, work);
  REQUIRE(e.status == Status::converged);
  const Vector3 p = e.configuration.X_MP.p;
  const double theta = std::atan2(p[1], p[0]);
  CHECK(theta > 0.4);
  CHECK(5000 * theta == doctest::Approx(1.2 * 2500 * std::cos(theta)).epsilon(1e-11));
  CHECK(p.norm() == doctest::Approx(1.2).epsilon(1e-12));
}

TEST_CASE("a machine that a force finds loose is singular, and gives the twist") {
  const Model model = model_of_text(R"(controlled = []
[springs.s]
stiffness_diag_si = [1e6, 1e6, 1e6, 1e3, 1e3, 1e3]
[[chain]]
name = "only"
elements = [{ passive = "prismatic", axis = [0, 3, 4] }, { spring = "s" }])");
  StaticsWork work(model.mechanism);
  const Equilibrium e = solve_forward(model, model.home, {}, {}, work);
  REQUIRE(e.status == Status::singular);
  const Vector6 expected = (Vector6() << 0, 0.6, 0.8, 0, 0, 0).finished();
  const Vector6 weakest = e.weakest / e.weakest.norm();
  CHECK(std::abs(weakest.dot(expected)) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("a machine that does not resist a force is singular under it, too") {
  const Model model = model_of_text(R"(controlled = ["x", "y", "z"]
springs.k = { stiffness_diag_si = [1e7, 1e7, 0, 1e6, 1e6, 1e6] }
[[chain]]
name = "c"
elements = [ { actuator = "prismatic", axis = "x" }, { actuator = "prismatic", axis = "y" }, { actuator = "prismatic", axis = "z" }, { spring = "k" } ]
)");
  StaticsWork work(model.mechanism);
  for (const double z : {0.0, 30.0}) {
    CAPTURE(z);
    const Load load{(Vector6() << 10, 0, z, 0, 0, 0).finished(), false};
    const Equilibrium forward = solve_forward(model, model.home, load, {}, work),
                      target =
                          solve_target(model, model.home, tip(model.mechanism, model.home), load, {}, work);
    for (const Equilibrium& e : {forward, target}) {
      CHECK(e.status == Status::singular);
      CHECK(std::abs(e.weakest.normalized().z()) == doctest::Approx(1));
    }
  }
}

TEST_CASE("a zero mode that moves no platform is allowed") {
  const Model model = model_of_text(R"(controlled = []
[springs.s]
stiffness_diag_si = [1e6, 1e6, 1e6, 1e3, 1e3, 1e3]
[[chain]]
name = "strut"
elements = [
  { spring = "s" },
  { passive = "revolute", axis = "x" },
  { rigid = { xyz_mm = [100, 0, 0] } },
  { passive = "revolute", axis = "x" },
]
[[chain]]
name = "hold"
elements = [{ rigid = { xyz_mm = [100, 0, 0] } }, { spring = "s" }]
[home]
xyz_mm = [100, 0, 0])");
  StaticsWork work(model.mechanism);
  const Equilibrium e = solve_forward(model, model.home, {10 * unit(0), true}, {}, work);
  CHECK(e.status == Status::converged);
  CHECK_FALSE(e.indeterminate);
  CHECK(e.configuration.X_MP.p[0] - 0.1 == doctest::Approx(10 / 2e6).epsilon(1e-9));
}

TEST_CASE("a wrench beyond every equilibrium does not converge") {
  const Model model = model_of_text(R"(controlled = []
[springs.s]
stiffness_diag_si = [1e6, 1e6, 1e6, 1, 1, 1]
[[chain]]
name = "only"
elements = [{ spring = "s" }])");
  StaticsWork work(model.mechanism);
  const Equilibrium e = solve_forward(model, model.home, {std::nan("") * unit(0), true}, {}, work);
  CHECK(e.status == Status::not_converged);
}

TEST_CASE("iterations count the Newton steps of all stages: at least four stages") {
  const Model model = model_of("hexapod_free_joints");
  StaticsWork work(model.mechanism);
  const Load load{(Vector6() << 450, -300, -580, 0, 0, 0).finished(), false};
  const Equilibrium e = solve_forward(model, model.home, load, {}, work);
  REQUIRE(e.status == Status::converged);
  const Equilibrium again = refine_forward(model, e.configuration, load, {}, work);
  CHECK(e.iterations >= 8);
  CHECK(again.iterations <= 2);
}

TEST_CASE("an equilibrium is found again by its tip, and no other one is taken for it") {
  const Model model = model_of("hexapod_free_joints");
  StaticsWork work(model.mechanism);
  const Load load{(Vector6() << 450, -300, -580, 0, 0, 0).finished(), false};
  const Equilibrium e = solve_forward(model, model.home, load, {}, work);
  const Pose X_MT = tip(model.mechanism, e.configuration);
  const Equilibrium found = equilibrium_at(model, model.home, load, {}, X_MT, work);
  CHECK(found.status == Status::converged);
  CHECK(difference(tip(model.mechanism, found.configuration), X_MT).norm() < 1e-11);
  CHECK(found.iterations < e.iterations);
  const Pose beside{X_MT.R, X_MT.p + Vector3(0, 0, 1e-8)};
  CHECK(equilibrium_at(model, model.home, load, {}, beside, work).status == Status::not_converged);
}

TEST_CASE("a workspace may be used again, for other loads and kinds of solve, with the same bits") {
  const Model model = model_of("laws_mixed");
  StaticsWork fresh(model.mechanism), used(model.mechanism);
  const Load load{(Vector6() << 20, 30, -40, 1, 2, 3).finished(), false};
  solve_target(model, model.home, tip(model.mechanism, model.home), {5 * load.F, true}, {}, used);
  stiffness(model, model.home, nominal_stage, used);
  const Equilibrium a = solve_forward(model, model.home, load, {}, fresh);
  const Equilibrium b = solve_forward(model, model.home, load, {}, used);
  CHECK(a.configuration.X_MP.p == b.configuration.X_MP.p);
  CHECK(a.configuration.X_MP.R == b.configuration.X_MP.R);
  CHECK(a.iterations == b.iterations);
}

TEST_CASE("statuses have the names that reports print") {
  CHECK(to_string(Status::converged) == "converged");
  CHECK(to_string(Status::not_converged) == "not_converged");
  CHECK(to_string(Status::unreachable) == "unreachable");
  CHECK(to_string(Status::singular) == "singular");
  CHECK(to_string(Status::unstable) == "unstable");
  CHECK(to_string(Status::outside_travel) == "outside_travel");
}
