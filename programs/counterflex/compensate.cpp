#include "commands.hpp"
#include "run.hpp"

namespace counterflex::cli {
namespace {

bool is_reported(const Failure& failure) {
  return failure.exit == Exit::not_compensated || failure.exit == Exit::limit;
}

void add(const Compensation& window, const PathForces& forces, const Run& run, RunTally& tally,
         RunFiles& files) {
  tally.add_forces(forces);
  tally.add_compensation(window);
  tally.add_waypoints(window.waypoints);
  files.add_waypoints(window.waypoints);
  files.add_program(window.text);
  if (window.text.empty()) return;
  Program corrected = window.corrected;
  ignore_axes(corrected, run.ignored);
  tally.add_corrected(corrected);
}

/// Window by window, to the first failure.
std::optional<Failure> compensate_all(Run& run, RunTally& tally, RunFiles& files, Console& console) {
  Windows windows(run, console);
  Compensator compensator(run.options.write, TextReader(windows.reader()), run.facts.attribution);
  while (windows.next()) {
    const Job job = windows.job();
    const Compensation window = compensator.next(job);
    for (const LeftAlone& block : window.left_alone)
      console.warning(run.program.file, block.line, "not corrected: " + block.why);
    add(window, job.forces, run, tally, files);
    if (window.failure) return window.failure;
  }
  return std::nullopt;
}

}  // namespace

Exit run_compensate(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  run->options.write.header = header_of(options, *run);
  RunFiles files(paths, {.attribution = run->facts.attribution});
  RunTally tally(run->facts.min_block_ms);
  const std::optional<Failure> failure = compensate_all(*run, tally, files, console);
  if (!failure) run->facts.output = paths.program;
  if (!failure || is_reported(*failure))
    return deliver(options, *run, report_compensation(run->context(), tally, failure), files, console);
  console.error(located(run->program.file, *failure));
  return failure->exit;
}

}  // namespace counterflex::cli
