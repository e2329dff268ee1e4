#include "run/compensate.hpp"

#include <fmt/format.h>

#include <mutex>

#include "counterflex/compensation/windows.hpp"
#include "counterflex/program/size_limit.hpp"
#include "run/guard.hpp"
#include "run/proof.hpp"
#include "run/run_checks.hpp"
#include "run/run_end.hpp"
#include "run/significance.hpp"
#include "run/spin.hpp"
#include "run/windows.hpp"

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
std::optional<Failure> compensate_all(Run& run, RunTally& tally, RunFiles& files, PointCount& points,
                                      ProofNotes* proof, Console& console) {
  Windows windows(run, console);
  Unnumbered unnumbered;
  std::optional<Failure> contour_failure;
  WindowEvents events = windows.events(tally, files);
  if (proof != nullptr) proof->listen(events);
  events.done = [&](const Job&, const Compensation& window) {
    std::unique_lock alone(windows.speaking());
    for (const LeftAlone& block : window.left_alone)
      console.warning(run.program.file, block.line,
                      (block.why.starts_with("not split, ") ? "" : "not corrected: ") + block.why);
    unnumbered.add(window.counts);
    points = window.counts.points;
    alone.unlock();
    add(window, tally, files);
    if (!contour_failure) contour_failure = tally.contour_failure(window);
    if (proof != nullptr) proof->add_text(window.text);
  };
  const std::optional<Failure> failure = compensate_windows(
      windows.jobs(), run.options, TextReader(windows.reader()), run.facts.attribution, events);
  unnumbered.warn(run.program.file, console);
  return failure ? failure : contour_failure;
}

/// Reads all bytes of a file.
std::string text_of(FileReader& bytes) {
  constexpr std::size_t at_once = 1 << 20;
  std::string text;
  bytes.rewind();
  while (bytes.append(text, at_once) > 0) {
  }
  bytes.rewind();
  return text;
}

/// Writes the program as parts. What forbids it is searched in the original first, for its line.
void divide(const Options& options, Run& run, const OutputPaths& paths, RunFiles& files) {
  const std::size_t most = *options.max_points;
  const std::string &file = run.program.file, &dialect = run.program.dialect;
  if (!run.file.data_lists.empty())
    throw InputError(
        ErrorKind::program_text, {file},
        fmt::format("the corrected program has more than {} points, but it is not divided into parts: "
                    "they would not see its data list {}; write the targets into the program, or give "
                    "--max-points a larger number",
                    most, shown_name(run.file.data_lists.front().path)));
  divide_program(file, dialect, text_of(run.file.by_line()), most);
  const std::vector<ProgramPart> parts = divide_program(paths.program, dialect, files.held_program(), most);
  files.write_parts(parts, part_paths(paths, parts, options));
  const std::string &first = parts[1].name, &last = parts.back().name;
  const bool one = parts.size() == 2;
  run.facts.warnings.push_back(
      {0, fmt::format("the program calls {} part{} of at most {} points: {}; whether the robot stops between "
                      "two parts depends on the control",
                      parts.size() - 1, one ? "" : "s", most,
                      one ? first : fmt::format("{} to {}", first, last))});
}

/// The written program, in parts if it has too many points.
void finish_program(const Options& options, Run& run, const PointCount& points, const OutputPaths& paths,
                    RunFiles& files) {
  const bool held = options.max_points && can_be_divided(run.program.dialect);
  if (held && points.after > *options.max_points) return divide(options, run, paths, files);
  refuse_too_many_points(run.program.file, run.program.dialect, points, options.max_points);
  if (held) files.write_held();
}

}  // namespace

std::optional<ErrorKind> compensate_program(const Options& options, Console& console,
                                            const ReportEnd& report_end) {
  const OutputPaths paths = output_paths(options);
  refuse_foreign_outputs(paths);
  return compensate_run(options, *prepare_run(options, console), paths, console, report_end);
}

std::optional<ErrorKind> compensate_run(const Options& options, Run& run, const OutputPaths& paths,
                                        Console& console, const ReportEnd& report_end) {
  refuse_what_cannot_be_compensated(run);
  if (options.free_spin) choose_spin(run, console);
  if (options.only_significant) find_insignificant(run, console);
  prepare_writing(options, run);
  if (options.guard) prepare_guard(run, console);
  refuse_replaced(paths, run.uncertainty_files);
  RunFiles files(paths, columns_of(options, run), options.hash_outputs || wants_proof(options));
  if (options.max_points && can_be_divided(run.program.dialect)) files.hold_program();
  if (run.file.lines) files.count_loop();
  RunTally tally = tally_for(options, run);
  PointCount points;
  std::optional<ProofNotes> proof;
  if (wants_proof(options)) proof.emplace(run.program.dialect);
  const std::optional<Failure> failure =
      compensate_all(run, tally, files, points, proof ? &*proof : nullptr, console);
  run.facts.output = paths.program;  // the report omits it if no program is written
  if (!failure) finish_program(options, run, points, paths, files);
  if (!failure && proof) run.facts.proof = proof->facts(run);
  return report_end(
      run, finish_run(options, run, report_compensation(run.context(), tally, failure), tally, files), files);
}

}  // namespace counterflex::cli
