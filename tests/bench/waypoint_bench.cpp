/// One waypoint of each machine by each way of solving it, under the same load.
#include <benchmark/benchmark.h>

#include "bench_cases.hpp"
#include "counterflex/statics/theory.hpp"

namespace counterflex::bench {
namespace {

/// Solves waypoint after waypoint, round and round, and counts the Newton steps of a mean waypoint. `solve`
/// takes the case, a waypoint's number and the workspace.
template <class Solve>
void each_waypoint(benchmark::State& state, CaseOf case_of, Solve solve) {
  const Case& c = case_of();
  if (!c.failure.empty()) return state.SkipWithError(("no nominal configuration: " + c.failure).c_str());
  StaticsWork work(c.model.mechanism);
  std::size_t i = 0;
  double iterations = 0;
  for (auto _ : state) {
    const Equilibrium solved = solve(c, i, work);
    if (solved.status != Status::converged) {
      const std::string what =
          "waypoint " + std::to_string(i) + " is " + std::string(to_string(solved.status));
      state.SkipWithError(what.c_str());
    }
    iterations += solved.iterations;
    benchmark::DoNotOptimize(solved.configuration.X_MP);
    i = (i + 1) % c.wanted.size();
  }
  state.counters["steps"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}

void kinematics(benchmark::State& state, CaseOf case_of) {
  const Case& c = case_of();
  if (!c.failure.empty()) return state.SkipWithError(("no nominal configuration: " + c.failure).c_str());
  NominalPath path(c.model, c.nominal.front());
  std::size_t i = 0;
  for (auto _ : state) {
    // There and back, so that every step is one to a neighbour.
    const std::size_t last = c.wanted.size() - 1;
    const std::size_t k = i % (2 * last);
    if (path.go_to(c.wanted[k <= last ? k : 2 * last - k]) != Status::converged)
      state.SkipWithError("a waypoint was not reached");
    ++i;
  }
}

void forward(benchmark::State& state, CaseOf case_of) {
  each_waypoint(state, case_of, [](const Case& c, std::size_t i, StaticsWork& work) {
    return solve_forward(c.model, c.nominal[i], milling_load(), all, work);
  });
}

void direct(benchmark::State& state, CaseOf case_of) {
  each_waypoint(state, case_of, [](const Case& c, std::size_t i, StaticsWork& work) {
    return solve_target(c.model, c.nominal[i], c.wanted[i], milling_load(), all, work);
  });
}

/// From the solution of the waypoint before, as points on a path are first tried.
void direct_warm(benchmark::State& state, CaseOf case_of) {
  const Case& shared = case_of();
  std::vector<Configuration> solved;
  StaticsWork work(shared.model.mechanism);
  for (std::size_t i = 0; i < shared.wanted.size() && shared.failure.empty(); ++i)
    solved.push_back(
        solve_target(shared.model, shared.nominal[i], shared.wanted[i], milling_load(), all, work)
            .configuration);
  each_waypoint(state, case_of, [&](const Case& c, std::size_t i, StaticsWork& own) {
    return refine_target(c.model, solved[i == 0 ? 1 : i - 1], c.wanted[i], milling_load(), all, own);
  });
}

void nested(benchmark::State& state, CaseOf case_of) {
  each_waypoint(state, case_of, [](const Case& c, std::size_t i, StaticsWork& work) {
    return solve_target_nested(c.model, c.nominal[i], c.wanted[i], milling_load(), all, work);
  });
}

void linear(benchmark::State& state, CaseOf case_of) {
  each_waypoint(state, case_of, [](const Case& c, std::size_t i, StaticsWork& work) {
    const LinearResult result = linear_deviation(c.model, c.nominal[i], milling_load(), all, work);
    Equilibrium as_equilibrium;
    as_equilibrium.status = result.status;
    as_equilibrium.configuration.X_MP = linear_target(c.model, c.wanted[i], result);
    return as_equilibrium;
  });
}

int register_machine(const std::string& name, CaseOf case_of) {
  const auto add = [&](const std::string& kernel, void (*run)(benchmark::State&, CaseOf)) {
    benchmark::RegisterBenchmark((name + "/" + kernel).c_str(), run, case_of)->Unit(benchmark::kMicrosecond);
  };
  add("kinematics", kinematics);
  add("linear", linear);
  add("forward", forward);
  add("direct", direct);
  add("direct_warm", direct_warm);
  add("nested", nested);
  return 0;
}

const int registered_waypoints = register_machine("orthoglide", orthoglide) +
                                 register_machine("hexapod", hexapod) +
                                 register_machine("robot_6r", robot_6r) + register_machine("mill", mill);

}  // namespace
}  // namespace counterflex::bench
