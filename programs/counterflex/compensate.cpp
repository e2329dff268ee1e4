#include <fmt/format.h>

#include "commands.hpp"
#include "counterflex/geometry/units.hpp"
#include "run.hpp"

namespace counterflex::cli {
namespace {

constexpr int most_decimals = 9;

/// The fewest digits after the point whose rounding every move can bear; `most_decimals` where none can.
int decimals_needed(const Job& job) {
  const auto fits = [&](int decimals) {
    WriteOptions write = job.options.write;
    write.decimals = decimals;
    for (const Segment& segment : job.path.segments)
      if (rounding_allowance(job.program.moves[segment.move], write) >= job.options.tolerance) return false;
    return true;
  };
  int decimals = 0;
  while (decimals < most_decimals && !fits(decimals)) ++decimals;
  return decimals;
}

/// Words that are written too coarsely for the tolerance cannot meet it.
void refuse_few_decimals(const Job& job) {
  for (const Segment& segment : job.path.segments) {
    const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
    if (rounding < job.options.tolerance) continue;
    throw InputError(
        Exit::usage, {job.program.file, segment.line, 1},
        fmt::format("words are rounded by up to {:.3g} mm here, and the tolerance is {:.3g} mm; it needs "
                    "--decimals {}, or more",
                    rounding / mm, job.options.tolerance / mm, decimals_needed(job)));
  }
}

bool is_reported(const std::optional<Failure>& failure) {
  return !failure || failure->exit == Exit::not_compensated || failure->exit == Exit::limit;
}

}  // namespace

Exit run_compensate(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  run->options.write.header = header_of(*run);
  const Job job = run->job();
  refuse_few_decimals(job);
  console.progress("solving");
  const Compensation result = compensate(job, run->facts.attribution);
  for (const LeftAlone& block : result.left_alone)
    console.warning(job.program.file, block.line, "not corrected: " + block.why);
  if (!result.failure) run->facts.output = paths.program;
  if (is_reported(result.failure)) {
    const RunReport report = report_compensation(run->machine.machine, job, run->facts, result);
    deliver(options, paths, report, result.waypoints, result.failure ? nullptr : &result.text, console);
  }
  if (!result.failure) return Exit::done;
  console.error(located(job.program.file, *result.failure));
  return result.failure->exit;
}

}  // namespace counterflex::cli
