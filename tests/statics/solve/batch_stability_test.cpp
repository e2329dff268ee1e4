/// Waypoints that are unstable, singular or out of reach are not solved in batches.
#include <fmt/format.h>

#include "statics/support/batch_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// A strut along the space diagonal, guided, behind two axes that are far away. The spring between its
// parts, k = 500 N m/rad, keeps it straight up to P = k (1 / a_1 + 1 / a_2); a_1 (m at home) is an actuator
// and grows, so that P falls.
constexpr double kink_stiffness = 500, second_part = 0.3;

Machine telescope(double first_part) {
  return read_machine(
      fmt::format(R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[springs.middle]
stiffness_diag_si = [1e8, 1e8, 1e8, 4000, {0}, 4000]
[springs.guide]
stiffness_diag_si = [1e9, 1e9, 1e9, 1e7, 1e7, 1e7]
[branches.strut]
elements = [
  {{ passive = "revolute", axis = "y" }},
  {{ rigid = {{ xyz_mm = [{1}, 0, 0] }} }},
  {{ actuator = "prismatic", axis = "x" }},
  {{ spring = "middle" }},
  {{ rigid = {{ xyz_mm = [{2}, 0, 0] }} }},
  {{ passive = "revolute", axis = "y" }},
]
[branches.guide]
elements = [
  {{ rigid = {{ xyz_mm = [{3}, 0, 0] }} }},
  {{ passive = "prismatic", axis = "x" }},
  {{ spring = "guide" }},
]
[[chain]]
name = "all"
elements = [
  {{ rigid = {{ rpy_deg = [0, -35.26438968275466, 45] }} }},
  {{ actuator = "prismatic", axis = "z" }},
  {{ actuator = "prismatic", axis = "y" }},
  {{ rigid = {{ xyz_mm = [3000, 0, 0] }} }},
  {{ parallel = ["strut", "guide"] }},
]
)",
                  kink_stiffness, first_part / mm, second_part / mm, (first_part + second_part) / mm),
      "telescope.toml");
}

double critical_load(double first_part) {
  return kink_stiffness * (1 / first_part + 1 / second_part);
}

const Vector3 along_strut = Vector3::Ones().normalized();

// Asked for clusters about random places; every yes is checked alone. The number of yes, and of loads that
// the machine cannot carry.
struct Tally {
  int solved = 0, refused = 0;
};

void try_cluster(BatchBench& bench, const std::vector<BatchRequest>& requests, Tally& tally) {
  for (const BatchQuestion question : {BatchQuestion::forward, BatchQuestion::target}) {
    const auto answers = bench.solve(question, whole, requests);
    for (std::size_t k = 0; k < requests.size(); ++k) {
      if (answers[k].solved)
        check_answer(bench, question, whole, requests[k], answers[k], 1e-9);
      else if (question == BatchQuestion::forward)
        tally.refused += bench.alone(requests[k].at.p, requests[k].F, whole).status != Status::converged;
      tally.solved += answers[k].solved;
    }
  }
}

}  // namespace

TEST_CASE(
    "batches: what is solved converges alone, up to ten times the working loads and beyond the workspace" *
    doctest::test_suite("long")) {
  Random random(31);
  for (const BatchTrial& batch_trial : batch_trials()) {
    CAPTURE(batch_trial.trial.name);
    Tally tally;
    BatchBench bench(batch_trial.machine, batch_trial.at_platform);
    for (const double strength : {1.0, 10.0}) {
      Trial wide = batch_trial.trial;
      wide.reach *= 1.5;
      try_cluster(bench, cluster(bench, wide, random, 4, 0.01, strength), tally);
    }
    CHECK(tally.solved > 0);
  }
}

TEST_CASE("batches: what is solved converges alone, beside a singularity and out of reach" *
          doctest::test_suite("long")) {
  Random random(37);
  for (const BatchTrial& batch_trial : {batch_trials()[1], batch_trials()[2], batch_trials()[4]}) {
    CAPTURE(batch_trial.trial.name);
    Tally tally;
    BatchBench bench(batch_trial.machine);
    const Vector3 way = random.vector(1).normalized();
    for (double far = 0.2; far < 4; far *= 1.6) {
      std::vector<BatchRequest> requests;
      for (int i = 0; i < 3; ++i)
        requests.push_back({{bench.home().p + far * way + random.vector(0.005)}, random.six(100, 5)});
      try_cluster(bench, requests, tally);
    }
    CHECK(tally.refused > 0);
  }
}

TEST_CASE(
    "batches: a telescope is solved where its strut is short and the load small, and never above its "
    "critical load") {
  constexpr double at_home = 0.05;
  BatchBench bench(telescope(at_home));
  Tally tally;
  for (double rho = -0.03; rho <= 0.25; rho += 0.004)
    for (const double part : {0.3, 0.6, 0.95, 0.995, 1.005, 1.05, 1.3, 2.0}) {
      CAPTURE(rho);
      CAPTURE(part);
      Vector6 F = Vector6::Zero();
      F.head<3>() = -part * critical_load(at_home + rho) * along_strut;
      try_cluster(bench, {{{bench.home().p + rho * along_strut}, F}}, tally);
    }
  CHECK(tally.solved > 50);
  CHECK(tally.refused > 200);
}

TEST_CASE("batches: a telescope under loads from all sides is solved only where it is stable") {
  Random random(41);
  Tally tally;
  BatchBench bench(telescope(0.1)), at_platform(with_tip_at(telescope(0.1), {0.3, 0.1, 0}), true);
  for (BatchBench* one : {&bench, &at_platform})
    for (const double strength : {0.1, 0.3, 1.0, 3.0, 9.0})
      try_cluster(*one, cluster(*one, {"telescope", 0.05, 0, 1500, 75}, random, 8, 0.02, strength), tally);
  CHECK(tally.solved > 0);
  CHECK(tally.refused > 0);
}
