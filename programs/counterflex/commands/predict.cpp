#include "commands/commands.hpp"
#include "run/run.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {
namespace {

/// Runs window by window, to the first failure.
std::optional<Failure> predict_all(Run& run, RunTally& tally, RunFiles& files, Console& console) {
  Windows windows(run, console);
  return predict_windows(windows.jobs(), run.options.threads, windows.events(tally, files));
}

}  // namespace

std::optional<ErrorKind> run_predict(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths, options);
  const auto run = prepare_run(options, console);
  RunFiles files(paths, {.corrected = false, .bands = !run->uncertainties.empty()});
  RunTally tally = tally_for(options, *run);
  const std::optional<Failure> failure = predict_all(*run, tally, files, console);
  return deliver(options, *run, report_prediction(run->context(), tally, failure), tally, files, console);
}

}  // namespace counterflex::cli
