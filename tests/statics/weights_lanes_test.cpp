/// Machines with weights in lanes.
#include "lanes_support.hpp"
#include "laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

std::vector<LaneRequest> around(const LaneBench& bench, const Trial& trial, Random& random) {
  return cluster(bench, trial, random, 5, 0.004, 0.5);
}

// How many of the waypoints around a place are solved, forward and target; each is checked.
int solved_around(LaneBench& bench, const std::vector<LaneRequest>& requests, const Stage& stage) {
  int solved = 0;
  for (const LaneQuestion question : {LaneQuestion::forward, LaneQuestion::target}) {
    const auto answers = bench.solve(question, stage, requests);
    for (std::size_t k = 0; k < answers.size(); ++k) {
      if (!answers[k].solved) continue;
      ++solved;
      check_lane(bench, question, stage, requests[k], answers[k], 1e-10);
    }
  }
  return solved;
}

}  // namespace

TEST_CASE(
    "in lanes a machine with masses everywhere, in branches of groups too, stands where it stands alone") {
  for (const LaneTrial& lane_trial : lane_trials()) {
    if (lane_trial.machine.chains.empty() || lane_trial.at_platform) continue;
    CAPTURE(lane_trial.trial.name);
    LaneBench bench(heavy(lane_trial.machine, 0.5), lane_trial.at_platform);
    REQUIRE(has_weight(bench.model.mechanism));
    Random random(4);
    const auto requests = around(bench, lane_trial.trial, random);
    for (const Stage& stage : {whole, without_errors, without_weights})
      CHECK(solved_around(bench, requests, stage) == 2 * static_cast<int>(requests.size()));
  }
}

TEST_CASE("in lanes the zero that was set under the machine's weight is the zero of single waypoints") {
  for (const std::string name : {"orthoglide_case_b", "serial6r_link6", "hexapod_joint_springs"}) {
    CAPTURE(name);
    Machine machine = heavy(machine_of(name), 0.5);
    machine.gravity.true_at_home = true;
    LaneBench bench(machine);
    REQUIRE(!zero_offsets(bench.model.mechanism).isZero(0));
    const auto answers =
        bench.solve(LaneQuestion::forward, without_errors, {{bench.home().p, Vector6::Zero()}});
    REQUIRE(answers[0].solved);
    CHECK((answers[0].X_MT.p - bench.home().p).norm() < 1e-10);
    Random random(6);
    const auto requests = around(bench, {name, 0.03, 0, 50, 3}, random);
    CHECK(solved_around(bench, requests, whole) == 2 * static_cast<int>(requests.size()));
  }
}

TEST_CASE("lanes solve nothing where a part of errors, weights or preloads acts") {
  LaneBench bench(heavy(machine_of("orthoglide_case_b"), 0.5));
  const LaneRequest at_home{bench.home().p, Vector6::Zero()};
  CHECK(bench.solve(LaneQuestion::forward, whole, {at_home})[0].solved);
  for (const Stage& stage : {Stage{.errors = 0.5}, Stage{.preload = 0}, Stage{.gravity = 0.5}})
    CHECK(!bench.solve(LaneQuestion::forward, stage, {at_home})[0].solved);
}
