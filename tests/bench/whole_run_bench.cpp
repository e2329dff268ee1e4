/// `counterflex compensate` between reading the files and writing them: planning, rewriting, reading back,
/// solving forward. Waypoints are those of the report: ends of the emitted moves and the samples between
/// them.
#include <benchmark/benchmark.h>

#include "bench_cases.hpp"
#include "counterflex/compensation/compensate.hpp"
#include "made_program.hpp"

namespace counterflex::bench {
namespace {

void compensate_face(benchmark::State& state) {
  const Model& model = orthoglide().model;
  const Program program = read_program(face_program(1000), "face.ngc", {});
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  const PathForces forces({}, program, path, {tip(model.mechanism, model.home).R});
  CompensationOptions options;
  options.max_correction = 5e-3;
  options.threads = static_cast<int>(state.range(0));
  const Job job{model, program, path, forces, options, {}};
  std::size_t waypoints = 0;
  for (auto _ : state) {
    const Compensation result = compensate(job, false);
    if (result.failure) state.SkipWithError(result.failure->what.c_str());
    waypoints += result.waypoints.size();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(waypoints));
  state.SetLabel(fmt::format("{} waypoints", waypoints / static_cast<std::size_t>(state.iterations())));
}

BENCHMARK(compensate_face)
    ->Name("whole_run/1000_blocks")
    ->Arg(1)
    ->Arg(2)
    ->ArgName("threads")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace counterflex::bench
