/// Single waypoints solved by the kernel, beside steps of the whole system.
#include "solve/newton.hpp"
#include "statics/support/laws_tables.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

void compare(const SeriesState& a, const SeriesState& b) {
  CHECK((a.x - b.x).norm() < 1e-10);
  CHECK((a.F - b.F).norm() < 1e-7 * (1 + b.F.norm()));
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    CHECK(difference(a.groups[g].X, b.groups[g].X).norm() < 1e-10);
    for (std::size_t i = 0; i < a.groups[g].branches.size(); ++i)
      compare(a.groups[g].branches[i], b.groups[g].branches[i]);
  }
}

}  // namespace

TEST_CASE("the kernel's configuration in any stage solves the whole system, in every coordinate and wrench") {
  for (const Trial& trial : controlled_machines())
    for (const double kg : {0.0, 1.0, 2.0}) {
      CAPTURE(trial.name);
      CAPTURE(kg);
      const Machine machine = kg > 0 ? heavy(machine_of(trial.name), kg) : machine_of(trial.name);
      const Model model = prepare(kg == 2 ? with_tables(machine, 0.3) : machine);
      StaticsWork work(model.mechanism);
      Random random(301);
      const Configuration nominal = somewhere(model, trial, random).configuration;
      const Pose X_MT = tip(model.mechanism, nominal);
      for (const bool is_target : {false, true}) {
        CAPTURE(is_target);
        const Stage stage{0.7, 0.9, 0.4, 0.6};
        const Problem problem{
            {random.six(trial.force, trial.moment), true}, stage, is_target ? &X_MT : nullptr};
        const Equilibrium e = is_target ? solve_target(model, nominal, X_MT, problem.load, stage, work)
                                        : solve_forward(model, nominal, problem.load, stage, work);
        REQUIRE(e.status == Status::converged);
        Configuration by_kernel = e.configuration, whole = e.configuration;
        CHECK(work.impl().kernel.solve(model.mechanism, problem, by_kernel).accepted);
        const NewtonResult steps = newton_of_whole_system(model, problem, work.impl(), whole);
        CHECK(steps.converged);
        CHECK(steps.iterations <= 2);
        CHECK_FALSE(steps.jumped);
        CHECK(difference(by_kernel.X_MP, whole.X_MP).norm() < 1e-11);
        for (std::size_t i = 0; i < whole.chains.size(); ++i) compare(by_kernel.chains[i], whole.chains[i]);
      }
    }
}

TEST_CASE("a machine that the kernel does not take is solved by steps of the whole system") {
  std::string text =
      "controlled = []\n[springs.s]\nstiffness_diag_si = [1e6, 2e6, 4e6, 3e4, 5e4, 1e4]\n"
      "[[chain]]\nname = \"axes\"\nelements = [\n";
  for (int i = 0; i < 13; ++i)
    text += "  { actuator = \"prismatic\", axis = \"x\", min_mm = -1, max_mm = 1 },\n";
  const Model model = model_of_text(text + "  { spring = \"s\" },\n]\n");
  StaticsWork work(model.mechanism);
  const Load load{300 * unit(1), false};
  Configuration start = model.home;
  CHECK_FALSE(work.impl().kernel.solve(model.mechanism, {load, {}, nullptr}, start).accepted);
  const Equilibrium e = solve_forward(model, model.home, load, {}, work);
  REQUIRE(e.status == Status::converged);
  CHECK(e.configuration.X_MP.p.y() == doctest::Approx(300 / 2e6).epsilon(1e-12));
}
