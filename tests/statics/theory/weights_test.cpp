/// The weights' energy and its derivatives, and how Newton's method takes them.
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// Gradient and second derivatives of the weights alone, over all variables of the whole system, without unit.
struct WeightTerms {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd A;
};

WeightTerms weight_terms(const Model& model, const Configuration& c, StaticsWork& work) {
  const Units units{model.mechanism.length};
  const auto system = [&](const Stage& stage) {
    evaluate_all(model, c, stage, work.impl());
    return assemble_whole(model.mechanism, work.impl().chains, {}, units);
  };
  const WholeSystem with = system({1, 1, 1, 1}), without = system({1, 1, 1, 0});
  return {with.gradient - without.gradient, with.A - without.A};
}

double weight_energy_of(const Model& model, const Configuration& c) {
  double energy = 0;
  for (std::size_t i = 0; i < c.chains.size(); ++i)
    energy += weight_energy(model.mechanism.chains[i], c.chains[i], {}, model.mechanism.gravity);
  return energy / Units{model.mechanism.length}.energy();
}

// The configuration with a step `h`, without unit, of one variable of the whole system.
Configuration stepped_variable(const Model& model, Configuration c, int variable, double h,
                               StaticsWork& work) {
  const Units units{model.mechanism.length};
  const WholeSystem system = assemble_whole(model.mechanism, work.impl().chains, {}, units);
  WholeStep step;
  step.variables.setZero(system.C.cols());
  step.wrenches.setZero(system.C.rows());
  step.variables[variable] =
      h * units.of_column(system.variables[static_cast<std::size_t>(variable)].angular);
  apply(model.mechanism, step, units, c);
  return c;
}

// Every machine with masses everywhere, far from equilibrium; so heavy that the springs do not drown them in
// rounding.
template <class Check>
void for_heavy_states(unsigned seed, const Check& check) {
  for (const Trial& trial : controlled_machines())
    for (unsigned n = 0; n < 3; ++n) {
      CAPTURE(trial.name);
      CAPTURE(n);
      const Model model = heavy_model_of(trial.name, 3000, seed + n);
      StaticsWork work(model.mechanism);
      Random random(seed + n);
      const Configuration c = shaken(model.mechanism, model.home, random, 1, 1);
      evaluate_all(model, c, {}, work.impl());
      check(model, c, work);
    }
}

}  // namespace

TEST_CASE(
    "the weights' forces are the gradient of their energy, in branches of groups and of groups in them too") {
  for_heavy_states(201, [](const Model& model, const Configuration& c, StaticsWork& work) {
    const Eigen::VectorXd gradient = weight_terms(model, c, work).gradient;
    const double size = gradient.cwiseAbs().maxCoeff();
    REQUIRE(size > 0);
    for (int k = 0; k < gradient.size(); ++k) {
      CAPTURE(k);
      const double expected = central_difference(
          [&](double h) { return weight_energy_of(model, stepped_variable(model, c, k, h, work)); }, 1e-3);
      CHECK(std::abs(gradient[k] - expected) < 1e-9 * size);
    }
  });
}

TEST_CASE(
    "the weights' tangent is the derivative of their forces by every coordinate, across the ends of groups" *
    doctest::test_suite("long")) {
  for_heavy_states(202, [](const Model& model, const Configuration& c, StaticsWork& work) {
    const Eigen::MatrixXd A = weight_terms(model, c, work).A;
    const double size = A.cwiseAbs().maxCoeff();
    for (int k = 0; k < A.cols(); ++k) {
      CAPTURE(k);
      const Eigen::VectorXd expected = central_difference(
          [&](double h) -> Eigen::VectorXd {
            return weight_terms(model, stepped_variable(model, c, k, h, work), work).gradient;
          },
          1e-3);
      CHECK((A.col(k) - expected).cwiseAbs().maxCoeff() < 1e-8 * size);
    }
  });
}

TEST_CASE("weights in branches whose start frame turns couple them to what turns it") {
  const Model model = heavy_model_of("laws_mixed");
  const Series& leg = model.mechanism.chains[0];
  CHECK_FALSE(leg.leans);
  CHECK(leg.groups[0].branches[0].leans);
  const Series& sliding = model.mechanism.chains[2].groups[0].branches[1];
  CHECK(sliding.leans);
  CHECK(sliding.groups[0].branches[0].leans);
  const Model light = model_of("laws_mixed");
  CHECK_FALSE(light.mechanism.chains[0].groups[0].branches[0].leans);
}

TEST_CASE("Newton's steps with weights converge quadratically: half the distance, a quarter of the miss") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = heavy_model_of(trial.name, 5);
    const Units units{model.mechanism.length};
    StaticsWork work(model.mechanism);
    Random random(203);
    const Problem problem{random.load(trial), {}, nullptr};
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Equilibrium e = solve_forward(model, nominal, problem.load, {}, work);
    REQUIRE(e.status == Status::converged);
    const auto miss = [&](double size) {
      Random same(204);
      Configuration c = shaken(model.mechanism, e.configuration, same, 0, 0);  // wrenches zero
      for (std::size_t i = 0; i < c.chains.size(); ++i) c.chains[i] = e.configuration.chains[i];
      c.X_MP = moved(e.configuration.X_MP, same.six(size * units.length, size));
      for (SeriesState& chain : c.chains) chain.x += size * Eigen::VectorXd::Constant(chain.x.size(), 0.3);
      set_actuator_values(model.mechanism, actuator_values(model.mechanism, e.configuration), c);
      evaluate_all(model, c, {}, work.impl());
      const Configuration next = condensed_step(model, c, problem, units, work.impl());
      return difference(next.X_MP, e.configuration.X_MP).norm();
    };
    const double whole = miss(1e-3), half = miss(5e-4);
    CAPTURE(whole);
    CHECK(whole / half == doctest::Approx(4).epsilon(0.1));
  }
}

TEST_CASE("a machine whose gravity does not act is the machine without masses") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model with = heavy_model_of(trial.name), without = model_of(trial.name);
    StaticsWork work_with(with.mechanism), work_without(without.mechanism);
    Random random(205);
    const Configuration nominal = somewhere(without, trial, random).configuration;
    const Load load = random.load(trial);
    const Equilibrium a = solve_forward(with, nominal, load, {1, 1, 1, 0}, work_with);
    const Equilibrium b = solve_forward(without, nominal, load, {}, work_without);
    REQUIRE(a.status == Status::converged);
    // Masses part the kernel's springs by nodes: other roundings.
    CHECK((a.configuration.X_MP.p - b.configuration.X_MP.p).cwiseAbs().maxCoeff() < 1e-14);
    CHECK((a.configuration.X_MP.R - b.configuration.X_MP.R).cwiseAbs().maxCoeff() < 1e-14);
  }
}
