#include "commands.hpp"
#include "run.hpp"

namespace counterflex::cli {

Exit run_verify(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths, options);
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  ProgramInput corrected =
      read_program_input("corrected", options.corrected, options, &run->machine.machine, run->read);
  ignore_axes(corrected.program, run->ignored);
  run->facts.inputs.push_back(corrected.file);
  // Both programs are compared as wholes.
  Windows windows(*run, console, whole_program);
  windows.next();
  const Job job = windows.job();
  const std::vector<Piece> pieces = match_programs(job, corrected.program);
  RunFiles files(paths, {});
  RunTally tally = tally_for(options, *run);
  tally.add_window(job);
  tally.add_corrected(corrected.program);
  std::optional<Failure> missed;
  const auto unsolved =
      solve_forward_in_portions(job, pieces, {.before = true, .attribution = true, .inside = true},
                                [&](const std::vector<Waypoint>& waypoints) {
                                  run->load_places.add(job, waypoints);
                                  tally.add_waypoints(waypoints, job);
                                  files.add_waypoints(waypoints);
                                  if (!missed) missed = tolerance_failure(job, waypoints);
                                });
  const std::optional<Failure> failure = unsolved ? unsolved : missed;
  return deliver(options, *run,
                 report_verification(run->context(), tally, overview_of(corrected.program), failure), tally,
                 files, console);
}

}  // namespace counterflex::cli
