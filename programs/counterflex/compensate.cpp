#include "commands.hpp"
#include "run.hpp"

namespace counterflex::cli {
namespace {

bool is_reported(const std::optional<Failure>& failure) {
  return !failure || failure->exit == Exit::not_compensated || failure->exit == Exit::limit;
}

RunTally tally_of(const Run& run, Compensation& result) {
  RunTally tally(run.facts.min_block_ms);
  tally.add_forces(*run.forces);
  tally.add_compensation(result);
  tally.add_waypoints(result.waypoints);
  if (result.text.empty()) return tally;
  ignore_axes(result.corrected, run.ignored);
  tally.add_corrected(result.corrected);
  return tally;
}

}  // namespace

Exit run_compensate(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  run->options.write.header = header_of(*run);
  const Job job = run->job();
  console.progress("solving");
  Compensation result = compensate(job, run->facts.attribution);
  for (const LeftAlone& block : result.left_alone)
    console.warning(job.program.file, block.line, "not corrected: " + block.why);
  if (!result.failure) run->facts.output = paths.program;
  if (is_reported(result.failure)) {
    const RunReport report = report_compensation(run->context(), tally_of(*run, result), result.failure);
    deliver(options, paths, report, result.waypoints, result.failure ? nullptr : &result.text, console);
  }
  if (!result.failure) return Exit::done;
  console.error(located(job.program.file, *result.failure));
  return result.failure->exit;
}

}  // namespace counterflex::cli
