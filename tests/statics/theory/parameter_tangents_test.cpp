#include "counterflex/statics/parameter_tangents.hpp"

#include <doctest/doctest.h>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "statics/support/laws_knees.hpp"
#include "statics/support/laws_tables.hpp"

using namespace counterflex;

namespace {

Pose loaded_tip(const Machine& machine, const Eigen::VectorXd& drho, const Load& load) {
  const Model model = prepare(machine);
  StaticsWork work(model.mechanism);
  const NominalResult nominal =
      nominal_forward(model, model.home, actuator_values(model.mechanism, model.home) + drho);
  REQUIRE(nominal.status == Status::converged);
  const Equilibrium found = solve_forward(model, nominal.configuration, load, Stage{}, work);
  REQUIRE(found.status == Status::converged);
  return tip(model.mechanism, found.configuration);
}

/// Compares the tangents of all parameters with central differences of whole solves.
void check_tangents(const Machine& machine) {
  const std::vector<Parameter> all = parameters(machine);
  std::vector<std::size_t> varied;
  std::vector<double> values;
  for (std::size_t i = 0; i < all.size(); ++i) {
    varied.push_back(i);
    values.push_back(all[i].value);
  }
  const Model model = prepare(machine);
  const ParameterTangents by_parameters(machine, model, varied);
  StaticsWork work(model.mechanism), tangent_work = by_parameters.work();
  const auto count = static_cast<Eigen::Index>(model.mechanism.travel.size());
  Eigen::VectorXd drho(count);
  for (Eigen::Index a = 0; a < count; ++a)
    drho[a] = (a % 2 == 0 ? 0.02 : -0.015) * static_cast<double>(a + 1) / static_cast<double>(count);
  Load load;
  load.F << 80, -50, 120, 1, -2, 0.5;
  const NominalResult nominal =
      nominal_forward(model, model.home, actuator_values(model.mechanism, model.home) + drho);
  REQUIRE(nominal.status == Status::converged);
  const Equilibrium found = solve_forward(model, nominal.configuration, load, Stage{}, work);
  REQUIRE(found.status == Status::converged);
  const auto tangents = by_parameters.of_tip(found.configuration, load, tangent_work);
  REQUIRE(tangents.cols() == static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(all[i].name);
    const bool is_scale = all[i].kind == ParameterKind::compliance || all[i].kind == ParameterKind::mass;
    const double step = is_scale ? 1e-3 * all[i].value : 1e-5;
    std::vector<double> moved = values;
    moved[i] = values[i] + step;
    const Pose up = loaded_tip(with_parameters(machine, moved), drho, load);
    moved[i] = values[i] - step;
    const Pose down = loaded_tip(with_parameters(machine, moved), drho, load);
    const Vector6 expected = difference(up, down) / (2 * step);
    const double error = (tangents.col(static_cast<Eigen::Index>(i)) - expected).norm();
    CHECK(error < 1e-5 * expected.norm() + 1e-12 / step);
  }
}

Machine made(MachineKind kind) {
  MachineFacts facts;
  facts.kind = kind;
  return read_machine(machine_file(facts), "made.toml");
}

Machine sample(const std::string& name) {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/samples/" + name + "/machine.toml");
}

Machine with_positioning_errors(Machine machine) {
  for (Element& element : machine.chains[0].elements)
    if (auto* actuator = std::get_if<Actuator>(&element)) {
      actuator->errors = ErrorTable{"t", {-0.3, -0.1, 0.01, 0.1, 0.4}, {}, 1e-5};
      for (const double error : {-1e-5, 2e-5, 3e-5, 7e-5, 4e-5}) {
        actuator->errors->errors.push_back(Vector6::Zero());
        actuator->errors->errors.back().head<3>() = error * actuator->joint.axis;
      }
    }
  return machine;
}

Machine with_harmonics(Machine machine) {
  double size = 1e-4;
  for (Element& element : machine.chains[0].elements)
    if (auto* actuator = std::get_if<Actuator>(&element)) {
      actuator->harmonics = {size, -2 * size, 0.5 * size, size};
      actuator->shown = {-1, 0.3, {}};
      size += 3e-5;
    }
  return machine;
}

}  // namespace

TEST_CASE("tangents of the tip by parameters are central differences of solved machines") {
  SUBCASE("a robot whose zero was set under its weight") {
    check_tangents(sample("robot-ur10"));
  }
  SUBCASE("the same with an unloaded zero") {
    Machine machine = sample("robot-ur10");
    machine.gravity.true_at_home = false;
    check_tangents(machine);
  }
  SUBCASE("a robot whose joints are stiffer above a load, some of them below it") {
    check_tangents(laws::with_knees(sample("robot-ur10"), 25, 3));
  }
  SUBCASE("a parallel machine with parallelograms") {
    check_tangents(sample("orthoglide-groove"));
  }
  SUBCASE("a hexapod") {
    check_tangents(sample("hexapod"));
  }
  SUBCASE("a hexapod with tables of errors") {
    check_tangents(laws::with_tables(sample("hexapod"), 0.3));
  }
  SUBCASE("a made Orthoglide, whose parallelograms have elastic bars") {
    check_tangents(made(MachineKind::orthoglide));
  }
  SUBCASE("a made delta") {
    check_tangents(made(MachineKind::delta));
  }
  SUBCASE("a milling machine") {
    check_tangents(sample("mill3"));
  }
  SUBCASE("a milling machine with positioning errors that are parameters") {
    check_tangents(with_positioning_errors(sample("mill3")));
  }
  SUBCASE("a robot whose joints have harmonics") {
    check_tangents(with_harmonics(sample("robot-ur10")));
  }
}

TEST_CASE("the tangent by a reversal is that of half a step of the actuator backwards") {
  Machine machine = sample("mill3");
  std::get<Actuator>(machine.chains[0].elements[0]).reversal = 2e-5;
  const std::vector<Parameter> all = parameters(machine);
  std::size_t index = 0;
  while (all[index].kind != ParameterKind::reversal) ++index;
  const Model model = prepare(machine);
  const ParameterTangents by_parameters(machine, model, {index});
  StaticsWork work(model.mechanism), tangent_work = by_parameters.work();
  const Load load{(Vector6() << 80, -50, 120, 1, -2, 0.5).finished(), false};
  const Equilibrium found = solve_forward(model, model.home, load, Stage{}, work);
  REQUIRE(found.status == Status::converged);
  const Vector6 tangent = by_parameters.of_tip(found.configuration, load, tangent_work).col(0);
  const double h = 1e-4;
  const Vector6 expected =
      -0.5 *
      difference(loaded_tip(machine, Vector3(h, 0, 0), load), loaded_tip(machine, Vector3(-h, 0, 0), load)) /
      (2 * h);
  CHECK((tangent - expected).norm() < 1e-7);
}
