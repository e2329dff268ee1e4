// Neighbouring segments are planned together; what is asked about them first is no start for the path.
#include "plan_chunk.hpp"

#include <fmt/format.h>

#include "shop.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("the first target of a path is found from its start, whatever was probed along the path before") {
  std::string text = "G21 G90\nG0 X0. Y0. Z0.\nF1200\n", rows;
  for (int k = 1; k <= 100; ++k) text += fmt::format("G1 X{:.3f} Y{}\n", 0.5 * k, 0.25 * (k % 2));
  for (int k = 0; k <= 50; ++k) rows += fmt::format("{}, {}, {}, -25\n", k, 150 + 60 * (k % 3), 40 * (k % 2));
  const Shop shop(
      {.machine = load_machine(orthoglide_b), .text = text + "M30\n", .force = step_profile(rows, 2e-3)});
  const Job job = shop.job();
  REQUIRE(job.starts == nullptr);
  WaypointSolver solver(job, shop.model, shop.model.home);
  Plan plan;
  plan.segments.resize(job.path.segments.size());
  REQUIRE(!ChunkPlanner(job, solver).plan(0, plan.segments.size(), plan));
  const TargetRequest first{job.path.segments[0].wanted.start,
                            {job.forces.at(0, 0), job.forces.at_platform()}};
  TargetSolution alone;
  WaypointSolver(job, shop.model, shop.model.home).targets({&first, 1}, {&alone, 1});
  REQUIRE(alone.status == Status::converged);
  CHECK(plan.segments[0].start_target == first.p_MT + (alone.target - first.p_MT));
}
