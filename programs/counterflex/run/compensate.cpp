#include "run/compensate.hpp"

#include <fmt/format.h>

#include <mutex>

#include "counterflex/compensation/windows.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex::cli {
namespace {

void add(const Compensation& window, RunTally& tally, RunFiles& files) {
  tally.add_compensation(window);
  files.add_program(window.text);
  if (window.text.empty()) return;
  tally.add_corrected(window.corrected);
}

/// Pieces that --number-pieces could not number.
struct Unnumbered {
  std::size_t pieces = 0;
  int first_line = 0;

  void add(const Rewritten& counts) {
    if (pieces == 0) first_line = counts.first_unnumbered_line;
    pieces += counts.unnumbered_pieces;
  }
  void warn(const std::string& file, Console& console) const {
    if (pieces > 0)
      console.warning(
          file, first_line,
          fmt::format("{} pieces of split blocks have no N: after the N of their block too few numbers "
                      "are free (first here)",
                      pieces));
  }
};

/// Runs window by window, to the first failure. Reads windows while others are solved.
std::optional<Failure> compensate_all(Run& run, RunTally& tally, RunFiles& files, Console& console) {
  Windows windows(run, console);
  std::mutex speaking;
  Unnumbered unnumbered;
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
  const auto done = [&](const Job&, const Compensation& window) {
    std::unique_lock alone(speaking);
    for (const LeftAlone& block : window.left_alone)
      console.warning(run.program.file, block.line, "not corrected: " + block.why);
    unnumbered.add(window.counts);
    alone.unlock();
    add(window, tally, files);
  };
  const std::optional<Failure> failure =
      compensate_windows(windows.jobs(), run.options, TextReader(windows.reader()), run.facts.attribution,
                         {read, begun, solved, done});
  unnumbered.warn(run.program.file, console);
  return failure;
}

}  // namespace

std::optional<ErrorKind> compensate_program(const Options& options, Console& console,
                                            const ReportEnd& report_end) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths, options);
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  prepare_writing(options, *run);
  RunFiles files(paths, {.attribution = run->facts.attribution}, options.hash_outputs);
  RunTally tally = tally_for(options, *run);
  const std::optional<Failure> failure = compensate_all(*run, tally, files, console);
  run->facts.output = without_controls(paths.program);  // the report omits it if no program is written
  if (failure && failure->kind == ErrorKind::usage)
    return print_failure(*run, failure, console);  // no result: an option is wrong
  return report_end(
      *run, finish_run(options, *run, report_compensation(run->context(), tally, failure), tally, files),
      files);
}

}  // namespace counterflex::cli
