/// The corrected target by Newton on (22), and by the paper's scheme (23): one answer.
#include "counterflex/statics/theory.hpp"
#include "statics/support/laws_tables.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

Vector6 controlled(const Model& model, const Vector6& all) {
  Vector6 part = Vector6::Zero();
  for (Component c : model.mechanism.controlled) part[static_cast<int>(c)] = all[static_cast<int>(c)];
  return part;
}

// What was solved for a machine at one random target.
struct SolvedTarget {
  Pose X_MT;
  Configuration nominal;
  Load load;
  Stage stage;
  Equilibrium direct;
};

template <class Check>
void for_random_targets(unsigned seed, int count, const Check& check) {
  for (const Trial& trial : controlled_machines())
    for (const bool weights : {false, true}) {
      CAPTURE(trial.name);
      CAPTURE(weights);
      const Model model =
          weights ? prepare(with_tables(heavy(machine_of(trial.name), 1), 0.3)) : model_of(trial.name);
      StaticsWork work(model.mechanism);
      Random random(seed);
      for (int n = 0; n < count; ++n) {
        CAPTURE(n);
        SolvedTarget s;
        s.nominal = somewhere(model, trial, random).configuration;
        s.X_MT = tip(model.mechanism, s.nominal);
        s.load = random.load(trial);
        s.stage = {n % 3 == 1 ? 0.0 : 1.0, n % 3 == 2 ? 0.0 : 1.0, 1};
        s.direct = solve_target(model, s.nominal, s.X_MT, s.load, s.stage, work);
        REQUIRE(s.direct.status == Status::converged);
        check(model, s, work);
      }
    }
}

}  // namespace

TEST_CASE("direct and nested targets agree to 1e-9 m over random poses, loads and errors" *
          doctest::test_suite("long")) {
  for_random_targets(51, 6, [](const Model& model, const SolvedTarget& s, StaticsWork& work) {
    const Equilibrium nested = solve_target_nested(model, s.nominal, s.X_MT, s.load, s.stage, work);
    REQUIRE(nested.status == Status::converged);
    const auto of = [&](const Configuration& c) { return actuator_values(model.mechanism, c); };
    CHECK((of(nested.configuration) - of(s.direct.configuration)).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(difference(nested.configuration.X_MP, s.direct.configuration.X_MP).norm() < 1e-9);
    CHECK(nested.iterations > 3 * s.direct.iterations);
  });
}

TEST_CASE("a corrected target puts the tip of the loaded machine where it is wanted") {
  for_random_targets(52, 6, [](const Model& model, const SolvedTarget& s, StaticsWork& work) {
    const Eigen::VectorXd rho = actuator_values(model.mechanism, s.direct.configuration);
    const NominalResult commanded = nominal_forward(model, s.nominal, rho);
    REQUIRE(commanded.status == Status::converged);
    const Equilibrium back = solve_forward(model, commanded.configuration, s.load, s.stage, work);
    REQUIRE(back.status == Status::converged);
    const Vector6 d = deviation(tip(model.mechanism, back.configuration), s.X_MT);
    CHECK(controlled(model, d).norm() < 1e-10);
  });
}

TEST_CASE("an unloaded perfect machine without preload is where its nominal kinematics defines") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(53);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Pose X_MT = tip(model.mechanism, nominal);
    const Stage errors_only{0, 1, 0, 1};
    const Equilibrium target = solve_target(model, nominal, X_MT, {}, errors_only, work);
    REQUIRE(target.status == Status::converged);
    CHECK((actuator_values(model.mechanism, target.configuration) - actuator_values(model.mechanism, nominal))
              .norm() < 1e-11);
    const Equilibrium forward = solve_forward(model, nominal, {}, errors_only, work);
    REQUIRE(forward.status == Status::converged);
    CHECK(deviation(tip(model.mechanism, forward.configuration), X_MT).norm() < 1e-11);
  }
}

TEST_CASE("a warm start beside a solution finds the same solution in fewer steps") {
  for_random_targets(54, 2, [](const Model& model, const SolvedTarget& s, StaticsWork& work) {
    Load more = s.load;
    more.F *= 1.05;
    const Equilibrium cold = solve_target(model, s.nominal, s.X_MT, more, s.stage, work);
    const Equilibrium warm = refine_target(model, s.direct.configuration, s.X_MT, more, s.stage, work);
    REQUIRE(cold.status == Status::converged);
    REQUIRE(warm.status == Status::converged);
    const auto of = [&](const Equilibrium& e) { return actuator_values(model.mechanism, e.configuration); };
    CHECK((of(cold) - of(warm)).cwiseAbs().maxCoeff() < 1e-10);
    CHECK(warm.iterations < cold.iterations);
  });
}

TEST_CASE("nested uses the whole system inside where a chain has no stiffness of its own") {
  const Model model = model_of("arm");
  StaticsWork work(model.mechanism);
  const Load load{(Vector6() << 0, 800, 0, 0, 0, 50).finished(), false};
  const NominalResult at = nominal_forward(model, model.home, Eigen::VectorXd::Constant(1, 0.2));
  const Pose X_MT = tip(model.mechanism, at.configuration);
  const Equilibrium direct = solve_target(model, at.configuration, X_MT, load, {}, work);
  const Equilibrium nested = solve_target_nested(model, at.configuration, X_MT, load, {}, work);
  REQUIRE(direct.status == Status::converged);
  REQUIRE(nested.status == Status::converged);
  // The gear holds 1.2 m times the force across the arm, which is at the wanted 0.2 rad.
  const double theta = (1.2 * 800 * std::cos(0.2) + 50) / 5000;
  CHECK(actuator_values(model.mechanism, direct.configuration)[0] ==
        doctest::Approx(0.2 - theta).epsilon(1e-11));
  CHECK(actuator_values(model.mechanism, nested.configuration)[0] ==
        doctest::Approx(0.2 - theta).epsilon(1e-9));
}

TEST_CASE("a target that nominal kinematics cannot reach is not reported as converged by either method") {
  const Model model = model_of("orthoglide_case_b");
  StaticsWork work(model.mechanism);
  const Pose X_MT = translation({2, 2, 2});
  CHECK(solve_target(model, model.home, X_MT, {}, {}, work).status != Status::converged);
  CHECK(solve_target_nested(model, model.home, X_MT, {}, {}, work).status != Status::converged);
}
