/// The whole static system beside the condensed one: two ways to the same step.
#include "theory/whole_system.hpp"

#include "solve/newton.hpp"
#include "statics/support/laws_tables.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

void compare(const SeriesState& a, const SeriesState& b, double force) {
  CHECK((a.x - b.x).norm() < 1e-10);
  CHECK((a.F - b.F).norm() < 1e-7 * force);
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    CHECK(difference(a.groups[g].X, b.groups[g].X).norm() < 1e-10);
    for (std::size_t i = 0; i < a.groups[g].branches.size(); ++i)
      compare(a.groups[g].branches[i], b.groups[g].branches[i], force);
  }
}

}  // namespace

TEST_CASE("the whole system takes the same Newton step as the condensed one, with and without weights") {
  for (const Trial& trial : controlled_machines())
    for (const bool weights : {false, true})
      for (const bool tables : {false, true}) {
        CAPTURE(trial.name);
        CAPTURE(weights);
        CAPTURE(tables);
        const Machine machine = weights ? heavy(machine_of(trial.name), 1) : machine_of(trial.name);
        const Model model = prepare(tables ? with_tables(machine, 0.3) : machine);
        const Units units{model.mechanism.length};
        StaticsWork work(model.mechanism);
        Random random(101);
        const Configuration nominal = somewhere(model, trial, random).configuration;
        const Equilibrium e = solve_forward(model, nominal, random.load(trial), {}, work);
        REQUIRE(e.status == Status::converged);
        const Problem problem{
            random.load(trial), {0.9, 1, 0.8, 0.7}, nullptr};  // from here the step is not small
        evaluate_all(model, e.configuration, problem.stage, work.impl());
        Configuration whole = e.configuration;
        const WholeStep step =
            solve_whole(whole_system(model, whole, problem, work.impl()), std::nullopt, units);
        CHECK_FALSE(step.redundant);
        CHECK(apply(model.mechanism, step, units, whole) > 1e-6);
        const Configuration condensed = condensed_step(model, e.configuration, problem, units, work.impl());
        CHECK(difference(whole.X_MP, condensed.X_MP).norm() < 1e-10);
        for (std::size_t i = 0; i < whole.chains.size(); ++i)
          compare(whole.chains[i], condensed.chains[i], 100);
      }
}

TEST_CASE("with actuators unknown and a target, the whole system's solution is the condensed one's") {
  for (const std::string name : {"orthoglide_case_b", "laws_mixed", "serial6r_link6",
                                 "laws_mixed with weights", "laws_mixed with weights and tables"}) {
    CAPTURE(name);
    const Model model = name.ends_with("weights") ? heavy_model_of("laws_mixed")
                        : name.ends_with("tables")
                            ? prepare(with_tables(heavy(machine_of("laws_mixed"), 1), 0.3))
                            : model_of(name);
    const Units units{model.mechanism.length};
    StaticsWork work(model.mechanism);
    const Load load{(Vector6() << 60, -40, 30, 2, -1, 3).finished(), false};
    const Pose X_MT = tip(model.mechanism, model.home);
    const Equilibrium direct = solve_target(model, model.home, X_MT, load, {}, work);
    REQUIRE(direct.status == Status::converged);
    Configuration c = direct.configuration;
    set_actuator_values(model.mechanism, actuator_values(model.mechanism, c).array() + 1e-4, c);
    const Problem problem{load, {}, &X_MT};
    for (int i = 0; i < 12; ++i) {
      evaluate_all(model, c, {}, work.impl());
      const auto target = tip_equations(model.mechanism, c.X_MP, X_MT, units);
      apply(model.mechanism, solve_whole(whole_system(model, c, problem, work.impl()), target, units), units,
            c);
    }
    const auto of = [&](const Configuration& of_c) { return actuator_values(model.mechanism, of_c); };
    CHECK((of(c) - of(direct.configuration)).cwiseAbs().maxCoeff() < 1e-10);
    CHECK(difference(c.X_MP, direct.configuration.X_MP).norm() < 1e-10);
  }
}

TEST_CASE(
    "coordinates are scaled by their own stiffness: the least eigenvalue of a body on one spring is 1") {
  const Model model = model_of_text(R"(controlled = []
[springs.s]
stiffness_diag_si = [1e6, 2e6, 4e6, 30000, 50000, 10000]
[[chain]]
name = "only"
elements = [{ spring = "s" }, { rigid = { xyz_mm = [0, 0, 0] } }])");
  StaticsWork work(model.mechanism);
  CHECK(model.mechanism.length == 0.1);  // the platform counts as held by 1 N / l: 1e-5 of the softest entry
  CHECK(stability(model, model.home, {}, {}, work) == doctest::Approx(1 / (1 + 1e-5)).epsilon(1e-9));
}

TEST_CASE(
    "a platform that ends elsewhere than predicted by more than half of its way has jumped, unless it is by "
    "next to nothing") {
  const Model model = model_of(controlled_machines().front().name);
  const double l = model.mechanism.length;
  const auto moved_by = [&](double way) {
    Configuration configuration = model.home;
    configuration.X_MP.p.x() += way * l;
    return configuration;
  };
  const auto jumps = [&](double foreseen, double way) {
    return ends_elsewhere(model.mechanism, model.home, moved_by(foreseen), moved_by(way));
  };
  CHECK(!jumps(0.01, 0.01));
  CHECK(!jumps(0.01, 0.0149));
  CHECK(jumps(0.01, 0.0151));
  CHECK(jumps(0.01, 0.0049));
  CHECK(!jumps(0, 0.9e-4));
  CHECK(jumps(0, 1.1e-4));
}
