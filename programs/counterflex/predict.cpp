#include "commands.hpp"
#include "run.hpp"

namespace counterflex::cli {
namespace {

/// Window by window, to the first failure.
std::optional<Failure> predict_all(Run& run, RunTally& tally, RunFiles& files, Console& console) {
  Windows windows(run, console);
  ForwardState state;
  while (windows.next()) {
    const Job job = windows.job();
    const ForwardRun forward = solve_forward_along(
        job, original_pieces(job), {.before = true, .attribution = true, .inside = false}, state);
    tally.add_window(job);
    run.load_places.add(job, forward.waypoints);
    tally.add_waypoints(forward.waypoints, job);
    files.add_waypoints(forward.waypoints);
    if (forward.failure) return forward.failure;
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
