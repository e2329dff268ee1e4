#include "commands.hpp"
#include "run.hpp"

namespace counterflex::cli {

Exit run_verify(const Options& options, Console& console) {
  const OutputPaths paths = output_paths(options);
  const auto run = prepare_run(options, console);
  refuse_what_cannot_be_compensated(*run);
  ProgramInput corrected =
      read_program_input("corrected", options.corrected, options, &run->machine.machine, run->read);
  ignore_axes(corrected.program, run->ignored);
  run->facts.inputs.push_back(corrected.file);
  const Job job = run->job();
  const std::vector<Piece> pieces = match_programs(job, corrected.program);
  console.progress("solving");
  const ForwardRun forward =
      solve_forward_along(job, pieces, {.before = true, .attribution = true, .inside = true});
  const auto failure = forward.failure ? forward.failure : tolerance_failure(job, forward.waypoints);
  RunTally tally(run->facts.min_block_ms);
  tally.add_forces(*run->forces);
  tally.add_waypoints(forward.waypoints);
  tally.add_corrected(corrected.program);
  const RunReport report =
      report_verification(run->context(), tally, overview_of(corrected.program), failure);
  deliver(options, paths, report, forward.waypoints, nullptr, console);
  if (!failure) return Exit::done;
  console.error(located(job.program.file, *failure));
  return failure->exit;
}

}  // namespace counterflex::cli
