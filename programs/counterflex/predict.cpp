#include "commands.hpp"
#include "run.hpp"

namespace counterflex::cli {
namespace {

void add_waypoints(const Job& job, const std::vector<Waypoint>& waypoints, Run& run, RunTally& tally,
                   RunFiles& files) {
  run.load_places.add(job, waypoints);
  tally.add_waypoints(waypoints, job);
  files.add_waypoints(waypoints);
}

/// Window by window, to the first failure.
std::optional<Failure> predict_all(Run& run, RunTally& tally, RunFiles& files, Console& console) {
  Windows windows(run, console);
  ForwardState state;
  while (windows.next()) {
    const Job job = windows.job();
    tally.add_window(job);
    const auto failure = solve_original(
        job, {.before = true, .attribution = true, .inside = false}, state,
        [&](const std::vector<Waypoint>& waypoints) { add_waypoints(job, waypoints, run, tally, files); });
    if (failure) return failure;
  }
  return std::nullopt;
}

}  // namespace

Exit run_predict(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths, options);
  const auto run = prepare_run(options, console);
  RunFiles files(paths, {.corrected = false});
  RunTally tally = tally_for(options, *run);
  const std::optional<Failure> failure = predict_all(*run, tally, files, console);
  return deliver(options, *run, report_prediction(run->context(), tally, failure), tally, files, console);
}

}  // namespace counterflex::cli
