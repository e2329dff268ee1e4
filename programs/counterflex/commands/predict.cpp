#include <mutex>

#include "commands/commands.hpp"
#include "run/run.hpp"

namespace counterflex::cli {
namespace {

/// Runs window by window, to the first failure.
std::optional<Failure> predict_all(Run& run, RunTally& tally, RunFiles& files, Console& console) {
  Windows windows(run, console);
  std::mutex speaking;
  const auto read = [&](const Job& job) {
    const std::lock_guard alone(speaking);
    windows.check(job);
  };
  const auto begun = [&](const Job& job) {
    const std::lock_guard alone(speaking);
    windows.warn(job);
    tally.add_window(job);
  };
  const auto solved = [&](const Job& job, const std::vector<Waypoint>& waypoints) {
    run.load_places.add(job, waypoints);
    tally.add_waypoints(waypoints, job);
    files.add_waypoints(waypoints);
    console.solved(waypoints.size());
  };
  const auto done = [](const Job&, const Compensation&) {};
  return predict_windows(windows.jobs(), run.options.threads, {read, begun, solved, done});
}

}  // namespace

std::optional<ErrorKind> run_predict(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths, options);
  const auto run = prepare_run(options, console);
  RunFiles files(paths, {.corrected = false});
  RunTally tally = tally_for(options, *run);
  const std::optional<Failure> failure = predict_all(*run, tally, files, console);
  return deliver(options, *run, report_prediction(run->context(), tally, failure), tally, files, console);
}

}  // namespace counterflex::cli
