/// Lanes against the solver of single waypoints.
#include "lane_model.hpp"
#include "lanes_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double lane_tolerance = 1e-10;  // m, rad

// Solves clusters of neighbours and checks every answer; the share that was solved.
double check_clusters(const LaneTrial& lane_trial, const Stage& stage, int clusters, unsigned seed) {
  LaneBench bench(lane_trial.machine, lane_trial.at_platform);
  REQUIRE(LaneModel::can_do(bench.model.mechanism));
  Random random(seed);
  int asked = 0, solved = 0;
  for (int i = 0; i < clusters; ++i) {
    const auto requests = cluster(bench, lane_trial.trial, random, 5, 0.004);
    for (const LaneQuestion question : {LaneQuestion::forward, LaneQuestion::target}) {
      const auto answers = bench.solve(question, stage, requests);
      for (std::size_t k = 0; k < answers.size(); ++k, ++asked) {
        if (!answers[k].solved) continue;
        ++solved;
        check_lane(bench, question, stage, requests[k], answers[k], lane_tolerance);
      }
    }
  }
  return static_cast<double>(solved) / asked;
}

}  // namespace

TEST_CASE(
    "in lanes every machine stands where it stands when it is solved alone, and all waypoints are solved" *
    doctest::test_suite("long")) {
  for (const LaneTrial& lane_trial : lane_trials()) {
    CAPTURE(lane_trial.trial.name);
    CAPTURE(lane_trial.at_platform);
    CHECK(check_clusters(lane_trial, whole, 2, 3) == 1);
  }
}

TEST_CASE("in lanes a machine without its assembly errors stands where it does alone") {
  for (const std::string name : {"orthoglide_case_b", "hexapod_joint_springs", "serial6r_link6"}) {
    CAPTURE(name);
    for (const LaneTrial& lane_trial : lane_trials())
      if (lane_trial.trial.name == name) {
        CHECK(check_clusters(lane_trial, without_errors, 1, 5) == 1);
        break;
      }
  }
}

TEST_CASE("a position that lanes command is that of the actuators which bring the tip where it is wanted") {
  LaneBench bench(machine_of("orthoglide_case_b"));
  Random random(7);
  const auto requests = cluster(bench, lane_trials()[1].trial, random, 8, 0.005);
  const auto answers = bench.solve(LaneQuestion::target, whole, requests);
  for (std::size_t k = 0; k < requests.size(); ++k) {
    REQUIRE(answers[k].solved);
    const Pose wanted{bench.home().R, requests[k].p};
    const NominalResult nominal = follow(bench.model, bench.model.home, wanted);
    const Equilibrium alone =
        solve_target(bench.model, nominal.configuration, wanted, {requests[k].F}, {}, bench.work);
    REQUIRE(alone.status == Status::converged);
    const NominalResult commanded = nominal_forward(
        bench.model, nominal.configuration, actuator_values(bench.model.mechanism, alone.configuration));
    CHECK((tip(bench.model.mechanism, commanded.configuration).p - answers[k].command).norm() <=
          lane_tolerance);
  }
}

TEST_CASE("the nominal tip that lanes know is that of followed kinematics, orientation and all") {
  for (const LaneTrial& lane_trial : lane_trials()) {
    CAPTURE(lane_trial.trial.name);
    LaneBench bench(lane_trial.machine, lane_trial.at_platform);
    Random random(9);
    for (const LaneRequest& request : cluster(bench, lane_trial.trial, random, 3, 0.01)) {
      Pose X_MT;
      REQUIRE(bench.lanes.nominal_tip(request.p, X_MT));
      const NominalResult nominal = follow(bench.model, bench.model.home, {bench.home().R, request.p});
      REQUIRE(nominal.status == Status::converged);
      CHECK(deviation(X_MT, tip(bench.model.mechanism, nominal.configuration)).norm() <= lane_tolerance);
    }
  }
}

TEST_CASE("a machine whose tip is not controlled in x, y and z is left to the solver of single waypoints") {
  for (const Machine& machine : {machine_of("bar_buckling"), machine_of("two_chains_coupled"), machine_of("arm"),
                                 machine_of("laws_mixed")}) {
    CAPTURE(machine.name);
    LaneBench bench(machine);
    const LaneRequest at_home{bench.home().p, Vector6::Zero()};
    CHECK(!bench.solve(LaneQuestion::forward, whole, {at_home})[0].solved);
    CHECK(bench.lanes.nominal_near(at_home.p) == nullptr);
  }
}

TEST_CASE("a machine with more series than kernels have room for is left to the solver of single waypoints") {
  Machine machine = machine_of("orthoglide_case_b");
  CHECK(LaneModel::can_do(compile(machine)));
  for (Chain& chain : machine.chains)
    for (Element& element : chain.elements)
      if (Group* group = std::get_if<Group>(&element)) group->branches.resize(40, group->branches.front());
  CHECK(!LaneModel::can_do(compile(machine)));
}

TEST_CASE("in lanes a place outside of travel, or out of reach, is not solved") {
  LaneBench mill(sample_machine("mill3/machine"));
  const Vector3 inside(0.2, 0.12, mill.home().p.z() - 0.1);
  const auto at_x = [&](double x) { return LaneRequest{{x, inside.y(), inside.z()}, Vector6::Zero()}; };
  const auto answers =
      mill.solve(LaneQuestion::forward, whole, {at_x(0.3999), at_x(0.4001), at_x(-0.0001), at_x(0.0001)});
  CHECK(answers[0].solved);
  CHECK(!answers[1].solved);
  CHECK(!answers[2].solved);
  CHECK(answers[3].solved);
  LaneBench orthoglide(machine_of("orthoglide_case_b"));
  for (const double x : {0.9, -0.9, 1e3})
    CHECK(!orthoglide.solve(LaneQuestion::forward, whole, {{Vector3(x, 0, 0), Vector6::Zero()}})[0].solved);
}
