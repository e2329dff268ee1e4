/// Three questions in one go against each by itself.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lanes_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double same_answer = 1e-11;  // m, rad

// A target in words of 1e-4 mm.
Vector3 in_words(const Vector3& command) {
  constexpr double digit = 1e-7;  // m
  return (command / digit).array().round() * digit;
}

struct ThroughBench : LaneBench {
  std::vector<LaneRequest> requests;
  std::vector<Vector3> originals;

  // Originals are beside the wanted positions, as a datum shift has them. Loads are borne on either side of a
  // zone's border.
  ThroughBench(const LaneTrial& lane_trial, unsigned seed)
      : LaneBench(lane_trial.machine, lane_trial.at_platform) {
    Random random(seed);
    requests = cluster(*this, lane_trial.trial, random, 11, 0.004, 0.5);
    for (const LaneRequest& request : requests) originals.push_back(request.p + random.vector(1e-4));
  }

  std::vector<LaneThrough> solve_through(const LaneWritten& written) {
    std::vector<LaneThrough> answers(requests.size());
    lanes.solve_through(requests, originals, written, answers);
    return answers;
  }

  std::vector<LaneThrough> solve_through() {
    return solve_through([](std::size_t, const Vector3& command) { return in_words(command); });
  }

  std::vector<LaneRequest> at(const std::vector<Vector3>& positions) const {
    std::vector<LaneRequest> moved = requests;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i].p = positions[i];
    return moved;
  }
};

void check_same(const LaneAnswer& through, const LaneAnswer& single) {
  CHECK(through.solved == single.solved);
  if (!through.solved || !single.solved) return;
  CHECK((through.command - single.command).cwiseAbs().maxCoeff() <= same_answer);
  CHECK(deviation(through.X_MT, single.X_MT).cwiseAbs().maxCoeff() <= same_answer);
}

// The same three questions, each from the beginning; the last about what was written in one go.
std::vector<LaneThrough> solve_apart(ThroughBench& bench, const std::vector<LaneThrough>& through) {
  const auto before = bench.solve(LaneQuestion::forward, whole, bench.at(bench.originals));
  const auto targets = bench.solve(LaneQuestion::target, whole, bench.requests);
  std::vector<Vector3> commands;
  for (const LaneThrough& answer : through) commands.push_back(in_words(answer.target.command));
  const auto after = bench.solve(LaneQuestion::forward, whole, bench.at(commands));
  std::vector<LaneThrough> apart;
  for (std::size_t i = 0; i < through.size(); ++i) apart.push_back({before[i], targets[i], after[i]});
  return apart;
}

}  // namespace

TEST_CASE("three questions in one go are answered as each by itself, for every machine that lanes can do" * doctest::test_suite("long")) {
  for (const LaneTrial& lane_trial : lane_trials()) {
    CAPTURE(lane_trial.trial.name);
    ThroughBench bench(lane_trial, 11);
    const auto through = bench.solve_through();
    const auto apart = solve_apart(bench, through);
    for (std::size_t i = 0; i < through.size(); ++i) {
      CAPTURE(i);
      CHECK(through[i].after.solved);
      check_same(through[i].before, apart[i].before);
      check_same(through[i].target, apart[i].target);
      check_same(through[i].after, apart[i].after);
      CHECK(through[i].before.command == bench.originals[i]);
      CHECK(through[i].after.command == in_words(through[i].target.command));
    }
  }
}

TEST_CASE("three questions in one go take fewer steps than each by itself") {
  ThroughBench bench(lane_trials()[1], 17);
  const auto through = bench.solve_through();
  const auto apart = solve_apart(bench, through);
  const auto steps = [](const std::vector<LaneThrough>& answers) {
    int sum = 0;
    for (const LaneThrough& a : answers)
      sum += a.before.iterations + a.target.iterations + a.after.iterations;
    return sum;
  };
  CHECK(steps(through) < steps(apart));
}

TEST_CASE("what is answered in one go is where the machine stands when it is solved alone") {
  ThroughBench bench(lane_trials()[1], 17);
  const auto through = bench.solve_through();
  for (std::size_t i = 0; i < through.size(); ++i) {
    const Vector6& F = bench.requests[i].F;
    REQUIRE(through[i].after.solved);
    check_lane(bench, LaneQuestion::forward, whole, {bench.originals[i], F}, through[i].before, 1e-10);
    check_lane(bench, LaneQuestion::target, whole, bench.requests[i], through[i].target, 1e-10);
    check_lane(bench, LaneQuestion::forward, whole, {in_words(through[i].target.command), F}, through[i].after,
               1e-10);
  }
}

TEST_CASE("where nobody knows what is written the other two questions are answered alone") {
  ThroughBench bench(lane_trials()[1], 17);
  const auto all = bench.solve_through();
  const auto some = bench.solve_through([](std::size_t i, const Vector3& command) {
    return i % 3 == 0 ? Vector3(Vector3::Constant(std::numeric_limits<double>::quiet_NaN())) : command;
  });
  for (std::size_t i = 0; i < some.size(); ++i) {
    CHECK(some[i].after.solved == (i % 3 != 0));
    CHECK(some[i].target.solved);
    check_same(some[i].before, all[i].before);
    check_same(some[i].target, all[i].target);
  }
}

TEST_CASE("a question that has no answer keeps no other waypoint from its own") {
  ThroughBench bench(lane_trials()[1], 19);
  const auto all = bench.solve_through();
  bench.originals[2] = Vector3(0.9, 0, 0);        // out of reach
  bench.requests[4].F = Vector6::Constant(1e12);  // not borne
  bench.originals[6].x() = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::size_t> told;
  const auto some = bench.solve_through([&](std::size_t i, const Vector3& command) {
    told.push_back(i);
    return in_words(command);
  });
  CHECK(std::is_sorted(told.begin(), told.end()));
  for (const std::size_t i : {2u, 6u}) {
    CAPTURE(i);
    CHECK(!some[i].before.solved);
    CHECK(some[i].target.solved);
    CHECK(some[i].after.solved);
  }
  CHECK(!some[4].before.solved);
  CHECK(!some[4].target.solved);
  CHECK(!some[4].after.solved);
  for (const std::size_t i : {0u, 1u, 3u, 5u, 7u, 8u, 9u, 10u}) {
    CAPTURE(i);
    CHECK(some[i].after.solved);
    check_same(some[i].before, all[i].before);
    check_same(some[i].target, all[i].target);
    check_same(some[i].after, all[i].after);
  }
}

TEST_CASE("a machine that lanes cannot do is asked nothing in one go either") {
  LaneBench bench(machine_of("two_chains_coupled"));
  const std::vector<LaneRequest> requests{{bench.home().p, Vector6::Zero()}};
  const std::vector<Vector3> originals{bench.home().p};
  std::vector<LaneThrough> answers(1);
  answers[0].after.solved = true;
  bench.lanes.solve_through(
      requests, originals, [](std::size_t, const Vector3& c) { return c; }, answers);
  CHECK(!answers[0].before.solved);
  CHECK(!answers[0].target.solved);
  CHECK(!answers[0].after.solved);
}
