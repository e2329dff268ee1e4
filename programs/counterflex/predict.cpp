#include "commands.hpp"
#include "counterflex/geometry/units.hpp"
#include "run.hpp"

namespace counterflex::cli {
namespace {

constexpr double spacing = 5 * mm;  // of the places on long moves

}  // namespace

Exit run_predict(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  const auto run = prepare_run(options, console);
  const Job job = run->job();
  console.progress("solving");
  const ForwardRun forward = solve_forward_along(job, original_pieces(job, spacing),
                                                 {.before = true, .attribution = true, .inside = false});
  RunTally tally(run->facts.min_block_ms);
  tally.add_forces(*run->forces);
  tally.add_waypoints(forward.waypoints);
  const RunReport report = report_prediction(run->context(), tally, forward.failure);
  deliver(options, paths, report, forward.waypoints, nullptr, console);
  if (!forward.failure) return Exit::done;
  console.error(located(job.program.file, *forward.failure));
  return forward.failure->exit;
}

}  // namespace counterflex::cli
