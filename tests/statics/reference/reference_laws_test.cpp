/// Laws that hold for every machine, on the machines of the reference.
#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// One target of each machine, from the reference.
std::vector<ReferenceCase> one_case_each() {
  std::vector<ReferenceCase> list;
  for (const char* file : {"orthoglide_line", "serial6r", "hexapod"})
    for (const ReferenceCase& reference : reference_cases(file))
      if (list.empty() || list.back().machine != reference.machine) list.push_back(reference);
  return list;
}

Machine moved_machine(Machine machine, const Pose& X_NM) {
  for (Chain& chain : machine.chains) chain.elements.insert(chain.elements.begin(), Rigid{X_NM});
  if (machine.home_X_MP) machine.home_X_MP = X_NM * *machine.home_X_MP;
  return machine;
}

Vector6 turned(const Matrix3& R, const Vector6& v) {
  return (Vector6() << R * v.head<3>(), R * v.tail<3>()).finished();
}

}  // namespace

TEST_CASE("a perfect machine without load has no deviation and needs no correction") {
  for (const ReferenceCase& reference : one_case_each()) {
    CAPTURE(reference.id);
    Machine machine = perfect(machine_of(reference));
    for (Chain& chain : machine.chains)  // springs that are relaxed at home load the machine everywhere else
      for (Element& element : chain.elements)
        if (auto* joint = std::get_if<Passive>(&element)) joint->stiffness = 0;
    Bench bench(machine);
    const Configuration nominal = bench.at(reference.X_MT);
    const Equilibrium forward = solve_forward(bench.model, nominal, {}, all, bench.work);
    REQUIRE(forward.status == Status::converged);
    CHECK(bench.deviation(forward.configuration, bench.tip(nominal)).norm() < 1e-12);
    const Equilibrium target = solve_target(bench.model, nominal, reference.X_MT, {}, all, bench.work);
    REQUIRE(target.status == Status::converged);
    CHECK((actuator_values(bench.model.mechanism, target.configuration) -
           actuator_values(bench.model.mechanism, nominal))
              .norm() < 1e-12);
  }
}

TEST_CASE("moving and turning the whole machine moves and turns the answer") {
  const Pose X_NM{exp_so3({0.4, -1.1, 0.7}), {0.3, -0.2, 0.5}};
  for (const ReferenceCase& reference : one_case_each()) {
    CAPTURE(reference.id);
    const Machine machine = machine_of(reference);
    Bench here(machine), there(moved_machine(machine, X_NM));
    const Configuration nominal = here.at(reference.X_MT);
    const Pose X_MT = here.tip(nominal), X_NT = X_NM * X_MT;
    const Configuration nominal_there = there.at(X_NT);
    const Load load{reference.wrench}, load_there{turned(X_NM.R, reference.wrench)};
    const auto at_home = solve_forward(here.model, nominal, load, all, here.work);
    const auto away = solve_forward(there.model, nominal_there, load_there, all, there.work);
    REQUIRE(at_home.status == Status::converged);
    REQUIRE(away.status == Status::converged);
    check_near("deviation", turned(X_NM.R, here.deviation(at_home.configuration, X_MT)),
               there.deviation(away.configuration, X_NT), 1e-11);
    for (std::size_t i = 0; i < machine.chains.size(); ++i)
      check_near("chain wrench", turned(X_NM.R, at_home.configuration.chains[i].F),
                 away.configuration.chains[i].F, wrench_tolerance(at_home.configuration.chains[i].F));
    const auto corrected = solve_target(here.model, nominal, X_MT, load, all, here.work);
    const auto corrected_away = solve_target(there.model, nominal_there, X_NT, load_there, all, there.work);
    REQUIRE(corrected.status == Status::converged);
    REQUIRE(corrected_away.status == Status::converged);
    check_near("actuators", actuator_values(here.model.mechanism, corrected.configuration),
               actuator_values(there.model.mechanism, corrected_away.configuration), 1e-11);
  }
}

TEST_CASE("errors switched off by the stage leave the perfect machine") {
  for (const ReferenceCase& reference : one_case_each()) {
    CAPTURE(reference.id);
    const Machine machine = machine_of(reference);
    Bench real(machine), ideal(perfect(machine));
    const Stage without_errors{0, 1, 1, 1};
    const Load load{reference.wrench};
    const auto a = solve_forward(real.model, real.at(reference.X_MT), load, without_errors, real.work);
    const auto b = solve_forward(ideal.model, ideal.at(reference.X_MT), load, all, ideal.work);
    REQUIRE(a.status == Status::converged);
    REQUIRE(b.status == Status::converged);
    check_near("tip", deviation(real.tip(a.configuration), ideal.tip(b.configuration)), Vector6::Zero(),
               1e-12);
  }
}

TEST_CASE("without a load the chains' wrenches sum to zero after assembly") {
  for (const ReferenceCase& reference : one_case_each()) {
    CAPTURE(reference.id);
    Bench bench(machine_of(reference));
    const auto solved = solve_forward(bench.model, bench.at(reference.X_MT), {}, all, bench.work);
    REQUIRE(solved.status == Status::converged);
    Vector6 sum = Vector6::Zero();
    for (const SeriesState& chain : solved.configuration.chains) sum += chain.F;
    CHECK(sum.norm() < 1e-6);
  }
}

TEST_CASE("a wrench at the reference point is that at the tip with the moment of its lever, deflected") {
  const ReferenceCase reference = reference_cases("serial6r").front();
  Bench bench(machine_of(reference));
  const Configuration nominal = bench.at(reference.X_MT);
  const auto at_tip = solve_forward(bench.model, nominal, {reference.wrench}, all, bench.work);
  REQUIRE(at_tip.status == Status::converged);
  const Vector3 lever = at_tip.configuration.X_MP.R * bench.model.mechanism.X_PT.p;
  const Load moved_load{wrench_at(reference.wrench, lever), true};
  const auto at_platform = solve_forward(bench.model, nominal, moved_load, all, bench.work);
  REQUIRE(at_platform.status == Status::converged);
  check_near("tip", bench.deviation(at_platform.configuration, bench.tip(at_tip.configuration)),
             Vector6::Zero(), 1e-11);
}
