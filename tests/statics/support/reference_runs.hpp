#pragma once
/// Running a case of the reference, and comparing. Reference numbers of length and angle are given to 1e-10
/// mm and degrees or better, and the statuses promise 1e-11 m; the comparison is at 2e-9 mm and degrees.
#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/equilibrium.hpp"
#include "support/reference_data.hpp"

namespace counterflex::test {

inline constexpr double length_tolerance = 2e-9 * mm, angle_tolerance = 2e-9 * deg;
inline constexpr Stage no_load{1, 0, 1, 1}, all{1, 1, 1, 1};

/// A machine ready to be solved.
struct Bench {
  Model model;
  StaticsWork work;

  explicit Bench(const Machine& machine) : model(prepare(machine)), work(model.mechanism) {}

  Configuration at(const Pose& X_MT) const {
    const NominalResult nominal = follow(model, model.home, X_MT);
    REQUIRE(nominal.status == Status::converged);
    return nominal.configuration;
  }
  Pose tip(const Configuration& configuration) const {
    return counterflex::tip(model.mechanism, configuration);
  }
  Vector6 deviation(const Configuration& configuration, const Pose& X_MT) const {
    return counterflex::deviation(tip(configuration), X_MT);
  }
};

inline Machine reference_machine(const std::string& name) {
  return load_machine(reference_machine_file(name));
}

/// The machine of a case, with its tool.
inline Machine machine_of(const ReferenceCase& reference) {
  Machine machine = reference_machine(reference.machine);
  if (reference.tool) machine.X_PT.p = *reference.tool;
  return machine;
}

inline void check_near(const char* what, const Eigen::VectorXd& actual, const Eigen::VectorXd& expected,
                       double tolerance) {
  INFO(what);
  REQUIRE(actual.size() == expected.size());
  for (Eigen::Index i = 0; i < actual.size(); ++i) {
    CAPTURE(i);
    CAPTURE(actual[i]);
    CAPTURE(expected[i]);
    CHECK(std::abs(actual[i] - expected[i]) <= tolerance);
  }
}

/// Wrenches are compared at the last digit of the file and at the tolerance of the solver.
inline double wrench_tolerance(const Eigen::VectorXd& expected) {
  return 2e-7 + 1e-8 * expected.lpNorm<Eigen::Infinity>();
}

inline Eigen::VectorXd loads_of_compliances(const Model& model, const Configuration& configuration) {
  std::vector<double> loads;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i)
    for (const Part& part : model.mechanism.chains[i].parts)
      if (part.kind == PartKind::compliance) loads.push_back(part.k * configuration.chains[i].x[part.column]);
  return Eigen::VectorXd::Map(loads.data(), static_cast<Eigen::Index>(loads.size()));
}

/// theta of every spring of every chain, outside groups.
inline std::vector<Vector6> spring_deflections(const Model& model, const Configuration& configuration) {
  std::vector<Vector6> list;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i)
    for (const Part& part : model.mechanism.chains[i].parts)
      if (part.kind == PartKind::spring) list.push_back(configuration.chains[i].x.segment<6>(part.column));
  return list;
}

inline void check_state(const Bench& bench, const Equilibrium& solved, const Pose& X_MT,
                        const ExpectedState& expected) {
  REQUIRE(solved.status == Status::converged);
  const Vector6 deviation = bench.deviation(solved.configuration, X_MT);
  if (expected.dp) check_near("position", deviation.head<3>(), *expected.dp, length_tolerance);
  if (expected.drot) check_near("rotation", deviation.tail<3>(), *expected.drot, angle_tolerance);
  for (std::size_t i = 0; i < expected.chain_wrenches.size(); ++i)
    check_near("chain wrench", solved.configuration.chains.at(i).F, expected.chain_wrenches[i],
               wrench_tolerance(expected.chain_wrenches[i]));
  if (expected.compliance_loads)
    check_near("loads of compliances", loads_of_compliances(bench.model, solved.configuration),
               *expected.compliance_loads, wrench_tolerance(*expected.compliance_loads));
  if (expected.springs.empty()) return;
  const auto springs = spring_deflections(bench.model, solved.configuration);
  REQUIRE(springs.size() == expected.springs.size());
  for (std::size_t i = 0; i < springs.size(); ++i) {
    check_near("spring translation", springs[i].head<3>(), expected.springs[i].head<3>(), length_tolerance);
    check_near("spring rotation", springs[i].tail<3>(), expected.springs[i].tail<3>(), angle_tolerance);
  }
}

inline void check_compensation(Bench& bench, const Configuration& nominal, const ReferenceCase& reference,
                               const ExpectedCompensation& expected, const Stage& stage) {
  const Load load{reference.wrench};
  const Equilibrium solved = solve_target(bench.model, nominal, reference.X_MT, load, stage, bench.work);
  REQUIRE(solved.status == Status::converged);
  const Eigen::VectorXd rho = actuator_values(bench.model.mechanism, solved.configuration);
  check_near("compensated actuators", rho, expected.rho, length_tolerance);
  if (expected.drot)
    check_near("remaining rotation", bench.deviation(solved.configuration, reference.X_MT).tail<3>(),
               *expected.drot, angle_tolerance);
  const NominalResult corrected = nominal_forward(bench.model, nominal, rho);
  REQUIRE(corrected.status == Status::converged);
  const Vector6 correction = bench.deviation(corrected.configuration, reference.X_MT);
  if (expected.correction)
    check_near("correction", correction.head<3>(), *expected.correction, length_tolerance);
  if (expected.correction_rotation)
    check_near("correction", correction.tail<3>(), *expected.correction_rotation, angle_tolerance);
  const Equilibrium again = solve_forward(bench.model, corrected.configuration, load, stage, bench.work);
  REQUIRE(again.status == Status::converged);
  check_near("forward again", bench.deviation(again.configuration, bench.tip(solved.configuration)),
             Vector6::Zero(), length_tolerance);
}

/// Everything that the case knows of one machine, perfect or not.
inline void check_machine(const Machine& machine, const ReferenceCase& reference,
                          const std::optional<ExpectedState>& unloaded,
                          const std::optional<ExpectedState>& loaded,
                          const std::optional<ExpectedCompensation>& compensated) {
  if (!unloaded && !loaded && !compensated) return;
  Bench bench(machine);
  REQUIRE(bench.model.home_status == Status::converged);
  const Stage stage{reference.error_scale, 1, 1, 1};
  const Configuration nominal = bench.at(reference.X_MT);
  if (reference.rho)
    check_near("nominal actuators", actuator_values(bench.model.mechanism, nominal), *reference.rho,
               length_tolerance);
  if (unloaded)
    check_state(bench, solve_forward(bench.model, nominal, {}, stage, bench.work), reference.X_MT, *unloaded);
  if (loaded)
    check_state(bench, solve_forward(bench.model, nominal, {reference.wrench}, stage, bench.work),
                reference.X_MT, *loaded);
  if (compensated) check_compensation(bench, nominal, reference, *compensated, stage);
}

inline void check_case(const ReferenceCase& reference) {
  CAPTURE(reference.id);
  const Machine machine = machine_of(reference);
  check_machine(machine, reference, reference.unloaded, reference.loaded, reference.compensated);
  check_machine(perfect(machine), reference, {}, reference.loaded_perfect, reference.compensated_perfect);
}

/// All cases of one file; a file that lost its cases fails.
inline void check_cases(const std::string& name, std::size_t count) {
  const auto cases = reference_cases(name);
  CHECK(cases.size() == count);
  for (const ReferenceCase& reference : cases) check_case(reference);
}

}  // namespace counterflex::test
