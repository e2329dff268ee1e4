/// Waypoints as in a run: in batches, half a millimetre apart, with another force at each.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>

#include "bench_cases.hpp"
#include "counterflex/statics/batch_solver.hpp"
#include "statics/kernel/batch.hpp"

namespace counterflex::bench {
namespace {

/// The vector instructions that the kernel uses on this computer.
const char* kernel_instructions() {
  const int lanes = kernel::all_instances().back().lanes;
  return lanes == 8 ? "AVX-512" : lanes == 4 ? "AVX2" : "scalar";
}

constexpr std::size_t batch = 256;
constexpr double spacing = 0.5e-3;  // m

Load little_by_little(std::size_t i) {
  const double t = static_cast<double>(i);
  Load load = milling_load();
  load.F[0] += 5 * std::sin(1.7 * t);
  load.F[1] += 4 * std::cos(2.3 * t);
  return load;
}

/// There and back along the line of the case, so that every batch begins beside the end of the last. `turn`
/// (rad): by how much the orientation varies.
std::array<std::vector<BatchRequest>, 2> there_and_back(const Case& c, double turn) {
  const Vector3 begin = c.wanted.front().p, along = (c.wanted.back().p - begin).normalized();
  std::array<std::vector<BatchRequest>, 2> ways;
  const auto turn_at = [turn](double s) -> Vector3 {
    return turn * Vector3(std::sin(60 * s), std::cos(40 * s), std::sin(50 * s));
  };
  for (std::size_t i = 0; i < batch; ++i) {
    const double s = spacing * static_cast<double>(i);
    ways[0].push_back({{begin + s * along, turn_at(s)}, little_by_little(i).F});
    const double back = spacing * batch - s;
    ways[1].push_back({{begin + back * along, turn_at(back)}, little_by_little(batch + i).F});
  }
  return ways;
}

/// `together`: waypoints of a batch. One at a time is solved by the scalar instance of the kernel.
void shipped(benchmark::State& state, CaseOf case_of, std::size_t together, double turn) {
  const Case& c = case_of();
  if (!c.failure.empty()) return state.SkipWithError(("no nominal configuration: " + c.failure).c_str());
  const StartTable table(c.model, false);
  BatchSolver solver(table);
  const auto ways = there_and_back(c, turn);
  std::size_t way = 0;
  std::vector<BatchAnswer> solved(batch);
  const auto solve = [&](std::size_t begin, std::size_t count) {
    solver.solve(BatchQuestion::target, {}, std::span(ways[way]).subspan(begin, count),
                 std::span(solved).subspan(begin, count));
  };
  double iterations = 0;
  for (way = 0; way < 2; ++way) solve(0, batch);  // cells are made once and not timed
  way = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < batch; i += together) solve(i, together);
    way = 1 - way;
    for (const BatchAnswer& solution : solved) {
      iterations += solution.iterations;
      if (solution.solved) continue;
      state.SkipWithError("a waypoint is not solved");
      return;
    }
  }
  state.SetLabel(together == 1 ? "scalar" : kernel_instructions());
  state.counters["items"] = batch;
  state.counters["steps"] = benchmark::Counter(iterations / batch, benchmark::Counter::kAvgIterations);
}

[[maybe_unused]] const int registered_shipped = [] {
  const auto add = [](const char* name, CaseOf case_of, double turn = 0) {
    const std::string machine = name;
    benchmark::RegisterBenchmark((machine + "/shipped").c_str(), shipped, case_of, batch, turn)
        ->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark((machine + "/alone").c_str(), shipped, case_of, std::size_t{1}, turn)
        ->Unit(benchmark::kMicrosecond);
  };
  add("orthoglide", orthoglide);
  add("hexapod", hexapod);
  add("robot_6r", robot_6r);
  add("robot_turning", robot_6r, 0.1);
  add("robot_masses", robot_masses);
  add("mill", mill);
  return 0;
}();

}  // namespace
}  // namespace counterflex::bench
