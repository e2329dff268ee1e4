/// One chain of the Orthoglide, brought from its nominal configuration to the pose of the loaded platform.
#include <benchmark/benchmark.h>

#include "bench_cases.hpp"
#include "counterflex/statics/chain.hpp"

namespace counterflex::bench {
namespace {

void solve_first_chain(benchmark::State& state, ChainMethod method) {
  const Case& c = orthoglide();
  StaticsWork work(c.model.mechanism);
  std::vector<Pose> ends;
  for (const Configuration& nominal : c.nominal)
    ends.push_back(solve_forward(c.model, nominal, milling_load(), all, work).configuration.X_MP);
  std::size_t i = 0;
  double iterations = 0;
  SeriesState chain = c.nominal[0].chains[0];
  for (auto _ : state) {
    chain = c.nominal[i].chains[0];
    const ChainEquilibrium solved = solve_chain(c.model, 0, ends[i], all, method, chain, work);
    if (solved.status != Status::converged) state.SkipWithError("the chain did not converge");
    iterations += solved.iterations;
    benchmark::DoNotOptimize(chain.F);
    i = (i + 1) % ends.size();
  }
  state.counters["steps"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}

void chain_newton(benchmark::State& state) {
  solve_first_chain(state, ChainMethod::newton);
}
void chain_paper(benchmark::State& state) {
  solve_first_chain(state, ChainMethod::paper);
}

BENCHMARK(chain_newton)->Name("chain/newton")->Unit(benchmark::kMicrosecond);
BENCHMARK(chain_paper)->Name("chain/paper")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace counterflex::bench
