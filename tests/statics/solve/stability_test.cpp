/// Condition and stability of a configuration, and how pivots and bounds prove them.
#include <fmt/format.h>

#include "counterflex/machine/machine.hpp"
#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/nominal.hpp"
#include "solve/newton.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

const char* const all_machines[] = {"orthoglide_case_b",  "hexapod_free_joints", "hexapod_joint_springs",
                                    "serial6r_joints",    "serial6r_link6",      "laws_mixed",
                                    "bar_buckling",       "antagonistic",        "cantilever",
                                    "two_chains_coupled", "parallel_bars_pinned"};

// Its chains are the branches of a group, with a soft spring behind them.
Model with_slender_tool(const Machine& machine) {
  const Tool tool{.from = ToolStiffness::cantilever,
                  .yields = {cantilever_tool(0.008, 0.04, ToolMaterial::steel)}};
  return prepare_with_tool(machine, prepare(machine), tool);
}

template <class Check>
void for_shaken_configurations(const Model& model, unsigned seed, const Check& check) {
  StaticsWork work(model.mechanism);
  Random random(seed);
  for (const double size : {0.0, 0.01, 0.3})
    for (const double wrench : {0.0, 1.0, 30.0, 1000.0}) {
      CAPTURE(size);
      CAPTURE(wrench);
      const Load load{random.six(500 * wrench, 200 * wrench), false};
      check(model, shaken(model.mechanism, model.home, random, size, wrench), load, work);
    }
}

// All machines in configurations that are more and more unlike an equilibrium, without masses and with such
// that sway it.
template <class Check>
void for_any_configurations(unsigned seed, const Check& check) {
  for (const std::string name : all_machines) {
    CAPTURE(name);
    for (const double kg : {0.0, 300.0}) {
      CAPTURE(kg);
      for_shaken_configurations(kg > 0 ? heavy_model_of(name, kg) : model_of(name), seed, check);
    }
    if (name != all_machines[0]) continue;
    for_shaken_configurations(with_slender_tool(machine_of(name)), seed, check);
    for_shaken_configurations(with_slender_tool(heavy(machine_of(name), 1)), seed, check);
  }
}

WholeSystem whole_system_at(const Model& model, const Configuration& c, const Load& load, StaticsWork& work) {
  evaluate_all(model, c, {}, work.impl());
  return whole_system(model, c, {load, {}, nullptr}, work.impl());
}

Vector6 push(double P) {
  return -P * unit(0);
}

// A machine elsewhere: every chain and the home pose after X.
Machine placed(Machine machine, const Pose& X) {
  for (Chain& chain : machine.chains) chain.elements.insert(chain.elements.begin(), Rigid{X});
  if (machine.home_X_MP) machine.home_X_MP = X * *machine.home_X_MP;
  return machine;
}

Load turned(const Load& load, const Matrix3& R) {
  Load result = load;
  result.F << R * load.F.head<3>(), R * load.F.tail<3>();
  return result;
}

}  // namespace

TEST_CASE("a bound on the condition is never below it, and is near for ordinary configurations" *
          doctest::test_suite("long")) {
  int near = 0;
  for_any_configurations(
      72, [&](const Model& model, const Configuration& c, const Load& load, StaticsWork& work) {
        const double exact = static_condition(model, c, load, {}, work);
        const double bound = condition_bound(whole_system_at(model, c, load, work));
        CHECK(exact <= bound * (1 + 1e-9));
        near += exact > bound / 1e3;
      });
  CHECK(near > 60);
}

TEST_CASE("the bound leaves room where a slender tool bends behind chains side by side") {
  const Model model = with_slender_tool(machine_of(all_machines[0]));
  StaticsWork work(model.mechanism);
  CHECK(condition_bound(whole_system_at(model, model.home, {}, work)) < 1e8);
}

TEST_CASE(
    "machines in use are proved stable and well conditioned, with masses in branches that lean and without") {
  for (const Trial& trial : controlled_machines())
    for (const double kg : {0.0, 1.0, 3.0}) {
      CAPTURE(trial.name);
      CAPTURE(kg);
      const Model model = kg > 0 ? heavy_model_of(trial.name, kg) : model_of(trial.name);
      StaticsWork work(model.mechanism);
      Random random(76);
      const Configuration nominal = somewhere(model, trial, random).configuration;
      const Load load = random.load(trial);
      const Equilibrium e = solve_forward(model, nominal, load, {}, work);
      REQUIRE(e.status == Status::converged);
      const Stability form = judge_stability(model, e.configuration, {load, {}, nullptr}, work.impl());
      CHECK(form.stable);
      if (kg == 0 || trial.name != "laws_mixed") CHECK(form.well_conditioned);
      CHECK(condition_bound(whole_system_at(model, e.configuration, load, work)) < 1e8);
    }
}

TEST_CASE("pivots prove no equilibrium that the whole system does not find stable and well conditioned") {
  int proved = 0, unstable = 0;
  double largest = 0;
  for (const std::string name : all_machines) {
    CAPTURE(name);
    for (const double kg : {0.0, 1.0, 30.0}) {
      CAPTURE(kg);
      const Model model = kg > 0 ? heavy_model_of(name, kg) : model_of(name);
      StaticsWork work(model.mechanism);
      Random random(73);
      for (const double size : {1.0, 300.0, 300.0, 3000.0, 30000.0}) {
        CAPTURE(size);
        const Load load{random.six(size, 0.1 * size), false};
        const Equilibrium e = refine_forward(model, model.home, load, {}, work);
        if (e.status == Status::not_converged) continue;
        const double least = stability(model, e.configuration, load, {}, work);
        const Stability form = judge_stability(model, e.configuration, {load, {}, nullptr}, work.impl());
        CHECK(form.stable == (least >= 0));
        unstable += least < 0;
        if (!form.well_conditioned) continue;
        ++proved;
        largest = std::max(largest, static_condition(model, e.configuration, load, {}, work));
      }
    }
  }
  CHECK(largest < 1e7);
  CHECK(proved > 60);
  CHECK(unstable > 2);
}

TEST_CASE("the reference machines stay below a condition of 2e5") {
  for (const Trial& trial : controlled_machines()) {
    if (trial.name == "laws_mixed") continue;
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(74);
    for (int n = 0; n < 3; ++n) {
      const Configuration nominal = somewhere(model, trial, random).configuration;
      const Load load = random.load(trial);
      const Equilibrium e = solve_forward(model, nominal, load, {}, work);
      REQUIRE(e.status == Status::converged);
      CHECK(static_condition(model, e.configuration, load, {}, work) < 2e5);
      CHECK(stability(model, e.configuration, load, {}, work) >= 0);
    }
  }
}

TEST_CASE("turning and moving the whole machine leaves its stability as it is and turns the answer") {
  const Pose X{exp_so3({0.7, -1.1, 0.4}), {0.3, -0.2, 0.5}};
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Machine machine = machine_of(trial.name);
    const Model here = prepare(machine), there = prepare(placed(machine, X));
    StaticsWork work_here(here.mechanism), work_there(there.mechanism);
    CHECK(there.mechanism.length == doctest::Approx(here.mechanism.length).epsilon(1e-12));
    Random random(75);
    const Load load = random.load(trial), load_there = turned(load, X.R);
    const Equilibrium a = solve_forward(here, here.home, load, {}, work_here);
    const Equilibrium b = solve_forward(there, there.home, load_there, {}, work_there);
    REQUIRE(a.status == Status::converged);
    REQUIRE(b.status == Status::converged);
    CHECK(difference(b.configuration.X_MP, X * a.configuration.X_MP).norm() < 1e-10);
    const double ratio = stability(here, a.configuration, load, {}, work_here);
    CHECK(std::abs(stability(there, b.configuration, load_there, {}, work_there) - ratio) <
          1e-10 + 1e-6 * std::abs(ratio));
    const double condition = static_condition(here, a.configuration, load, {}, work_here);
    CHECK(static_condition(there, b.configuration, load_there, {}, work_there) ==
          doctest::Approx(condition).epsilon(1e-6));
  }
}

TEST_CASE(
    "a straight pinned strut is stable below 2 k / a and unstable above, although its ends do not show it") {
  const Model model = model_of("bar_buckling");  // k = 500 N m/rad, a = 0.2 m: 5000 N
  StaticsWork work(model.mechanism);
  for (const double P : {1000.0, 4990.0}) {
    CAPTURE(P);
    const Equilibrium e = solve_forward(model, model.home, {push(P), false}, {}, work);
    CHECK(e.status == Status::converged);
    CHECK(stability(model, e.configuration, {push(P), false}, {}, work) > 0);
    CHECK(chain_stiffness(model, 0, e.configuration.chains[0], {}, work).K_C(2, 2) < 0);
  }
  for (const double P : {5010.0, 8000.0}) {
    CAPTURE(P);
    CHECK(solve_forward(model, model.home, {push(P), false}, {}, work).status == Status::unstable);
  }
}

// The spring between its halves is `stiff` along every axis, and 1000 N m/rad against the kink: P_cr = 2 k /
// a = 4000 N.
Model strut_beside(double stiff) {
  return model_of_text(fmt::format(R"(controlled = ["x"]
[home]
xyz_mm = [1000, 0, 0]
[springs.mid]
stiffness_diag_si = [{0}, {0}, {0}, 1e6, 1000, 1e6]
[springs.guide]
stiffness_diag_si = [{0}, {0}, {0}, 1e7, 1e7, 1e7]
[[chain]]
name = "strut"
elements = [
  {{ actuator = "prismatic", axis = "x" }},
  {{ passive = "revolute", axis = "y" }},
  {{ rigid = {{ xyz_mm = [500, 0, 0] }} }},
  {{ spring = "mid" }},
  {{ rigid = {{ xyz_mm = [500, 0, 0] }} }},
  {{ passive = "revolute", axis = "y" }},
]
[[chain]]
name = "guide"
elements = [{{ rigid = {{ xyz_mm = [1000, 0, 0] }} }}, {{ passive = "prismatic", axis = "x" }}, {{ spring = "guide" }}])",
                                   stiff));
}

TEST_CASE(
    "a stiff spring hides no buckled strut and rejects no straight one: right to 1e-4 of the critical load") {
  constexpr double critical = 4000;
  for (const double stiff : {1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14}) {
    CAPTURE(stiff);
    const Model model = strut_beside(stiff);
    StaticsWork work(model.mechanism);
    for (const double part : {0.9, 0.99, 0.999, 0.9999, 1.000001, 1.0001, 1.001, 1.01, 1.1}) {
      CAPTURE(part);
      const Load load{push(part * critical), false};
      const Equilibrium e = solve_forward(model, model.home, load, {}, work);
      CHECK(e.status == (part < 1 ? Status::converged : Status::unstable));
      const Equilibrium target =
          solve_target(model, model.home, tip(model.mechanism, model.home), load, {}, work);
      CHECK(target.status == e.status);
      if (part < 1) CHECK(stability(model, e.configuration, load, {}, work) > 0.1 * (1 - part));
    }
  }
}

TEST_CASE("a buckled start finds the buckled form, which is stable above 2 k / a") {
  const Model model = model_of("bar_buckling");
  StaticsWork work(model.mechanism);
  Configuration start = model.home;  // half angle of the kink
  const double alpha = 0.4;
  SeriesState& strut = start.chains[0];
  for (const Part& part : model.mechanism.chains[0].parts) {
    if (part.kind == PartKind::spring) strut.x[part.column + 4] = 2 * alpha;
    if (part.kind == PartKind::passive) strut.x[part.column] = -alpha;
  }
  const double P = 5200, closed = P * 0.2 / (2 * 500);
  const Equilibrium e = refine_forward(model, start, {push(P), false}, {}, work);
  REQUIRE(e.status == Status::converged);
  double kink = 0;
  for (const Part& part : model.mechanism.chains[0].parts)
    if (part.kind == PartKind::spring) kink = e.configuration.chains[0].x[part.column + 4];
  const double half = std::abs(kink) / 2;
  CHECK(half / std::sin(half) == doctest::Approx(closed).epsilon(1e-9));  // alpha / sin(alpha) = P a / 2k
  CHECK(stability(model, e.configuration, {push(P), false}, {}, work) > 0);
}
