/// Machines with weights in batches.
#include "statics/model/home.hpp"
#include "statics/support/batch_support.hpp"
#include "statics/support/laws_weights.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

std::vector<BatchRequest> around(const BatchBench& bench, const Trial& trial, Random& random) {
  return cluster(bench, trial, random, 5, 0.004, 0.5);
}

// How many of the waypoints around a place are solved, forward and target; each is checked.
int solved_around(BatchBench& bench, const std::vector<BatchRequest>& requests, const Stage& stage) {
  int solved = 0;
  for (const BatchQuestion question : {BatchQuestion::forward, BatchQuestion::target}) {
    const auto answers = bench.solve(question, stage, requests);
    for (std::size_t k = 0; k < answers.size(); ++k) {
      if (!answers[k].solved) continue;
      ++solved;
      check_answer(bench, question, stage, requests[k], answers[k], 1e-10);
    }
  }
  return solved;
}

}  // namespace

TEST_CASE("batches: machines with masses everywhere, in branches too, are solved as single waypoints are") {
  for (const BatchTrial& batch_trial : batch_trials()) {
    if (batch_trial.machine.chains.empty() || batch_trial.at_platform) continue;
    CAPTURE(batch_trial.trial.name);
    BatchBench bench(heavy(batch_trial.machine, 0.5), batch_trial.at_platform);
    REQUIRE(has_weight(bench.model.mechanism));
    Random random(4);
    const auto requests = around(bench, batch_trial.trial, random);
    // Tangents leave out how masses in branches turn: where orientations are controlled, too, some waypoints
    // of a heavy machine are left to the solver of single waypoints.
    const int asked = 2 * static_cast<int>(requests.size());
    const int least = batch_trial.trial.name == "laws_mixed" ? asked / 2 : asked;
    for (const Stage& stage : {whole, without_errors, without_weights})
      CHECK(solved_around(bench, requests, stage) >= least);
  }
}

TEST_CASE("batches: a zero that was set under the machine's weight is that of single waypoints") {
  for (const std::string name : {"orthoglide_case_b", "serial6r_link6", "hexapod_joint_springs"}) {
    CAPTURE(name);
    Machine machine = heavy(machine_of(name), 0.5);
    machine.gravity.true_at_home = true;
    BatchBench bench(machine);
    REQUIRE(!zero_offsets(bench.model.mechanism).isZero(0));
    const auto answers =
        bench.solve(BatchQuestion::forward, without_errors, {{bench.home().p, Vector6::Zero()}});
    REQUIRE(answers[0].solved);
    CHECK((answers[0].X_MT.p - bench.home().p).norm() < 1e-10);
    Random random(6);
    const auto requests = around(bench, {name, 0.03, 0, 50, 3}, random);
    CHECK(solved_around(bench, requests, whole) == 2 * static_cast<int>(requests.size()));
  }
}

TEST_CASE("batches: nothing is solved where a part of errors, weights or preloads acts") {
  BatchBench bench(heavy(machine_of("orthoglide_case_b"), 0.5));
  const BatchRequest at_home{bench.home().p, Vector6::Zero()};
  CHECK(bench.solve(BatchQuestion::forward, whole, {at_home})[0].solved);
  for (const Stage& stage : {Stage{.errors = 0.5}, Stage{.preload = 0}, Stage{.gravity = 0.5}})
    CHECK(!bench.solve(BatchQuestion::forward, stage, {at_home})[0].solved);
}
