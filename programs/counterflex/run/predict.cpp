#include "run/predict.hpp"

#include <utility>

#include "run/offsets.hpp"
#include "run/run_end.hpp"
#include "run/spin.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {
namespace {

/// Runs window by window, to the first failure.
std::optional<Failure> predict_all(Run& run, RunTally& tally, RunFiles& files, OffsetSearch* offsets,
                                   Console& console) {
  Windows windows(run, console);
  WindowEvents events = windows.events(tally, files);
  if (offsets != nullptr)
    events.solved = [offsets, solved = events.solved](const Job& window,
                                                      const std::vector<Waypoint>& waypoints) {
      solved(window, waypoints);
      offsets->add(window, waypoints);
    };
  return predict_windows(windows.jobs(), run.options.threads, events);
}

}  // namespace

std::optional<ErrorKind> predict_run(const Options& options, Run& run, const OutputPaths& paths,
                                     Console& console, const ReportEnd& report_end) {
  if (options.free_spin) choose_spin(run, console);
  std::optional<OffsetSearch> offsets;
  if (options.predict.offsets) offsets.emplace(run);
  refuse_replaced(paths, run.uncertainty_files);
  RunFiles files(paths, columns_of(options, run));
  RunTally tally = tally_for(options, run);
  const std::optional<Failure> failure =
      predict_all(run, tally, files, offsets ? &*offsets : nullptr, console);
  RunReport report = report_prediction(run.context(), tally, failure);
  if (offsets && !report.error_kind) report.best_offsets = offsets->find(options, report, tally, console);
  return report_end(run, finish_run(options, run, std::move(report), tally, files), files);
}

}  // namespace counterflex::cli
