#include "run/run_end.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/machine_along.hpp"
#include "process/exit_status.hpp"
#include "process/standard_output.hpp"
#include "run/failed_line.hpp"
#include "run/sanity.hpp"
#include "run/significance.hpp"
#include "run/uncertainty.hpp"

namespace counterflex::cli {

namespace {

void add_uncertainty(const Options& options, const Run& run, RunReport& report,
                     const std::vector<LoadPlace>& places) {
  const Machine& machine = run.machine.machine;
  const LoadPlace* worst = run.load_places.worst_before();
  report.uncertainty = uncertainty_report(
      machine, worst,
      worst != nullptr ? solve_covariance(*worst, run.uncertainties, &*run.starts) : std::nullopt);
  if (options.samples > 0)
    report.uncertainty->sampled = sample_bands(machine, run.program.tools, run.work.frames, places,
                                               options.samples, run.options.threads);
}

/// A run without a program has no setup sheet.
void add_hashes(const Options& options, RunReport& report, RunFiles& files) {
  std::optional<ProofFacts>& proof = report.facts.proof;
  if (report.error_kind) proof.reset();
  if (!proof || options.command == Command::verify) return;
  for (const FileHash& file : files.complete_program())
    proof->written.push_back({"written", file.path, file.sha256});
}

}  // namespace

RunEnd finish_run(const Options& options, Run& run, RunReport report, const RunTally& tally,
                  RunFiles& files) {
  const MachineInput& on = run.machine;
  const std::vector<LoadPlace> places = run.load_places.places();
  LoadsAlong loads;
  if (wants_loads(run)) loads = solve_loads(on.model, places, run.options.threads, &*run.starts);
  const auto under = [&](double factor) {
    return solve_other_force(places, factor, run.options.threads, &*run.starts);
  };
  const LoadPlace* worst = run.load_places.worst_before();
  if (worst != nullptr && report.before && !report.at_worst)
    if (const auto causes = solve_causes(*worst, &*run.starts))
      report.at_worst = sources_at(worst->at, *causes);
  if (report.facts.attribution && report.without_causes.places == 0)
    add_sensitivity(report, places, under(1 + force_change), under(1 - force_change));
  else if (report.sensitivity)
    add_sensitivity(report, places, under(1 + force_change), under(1 - force_change), under(0));
  if (report.failure && options.command != Command::verify && (options.report || options.json))
    report.failure_place = solve_failed_line(run, report.failure->line);
  if (!run.uncertainties.empty()) add_uncertainty(options, run, report, places);
  std::string machine = "null";
  if (files.with_page()) {
    MachineAlong along = machine_along(on.machine, on.model, places, run.options.threads, &*run.starts);
    along.ranges = tally.travel().axes();
    machine = machine_json(along);
  }
  run.starts.reset();  // the solvers are done; frees memory for the report
  report.sanity = run_sanity(run, report, tally);
  add_loads(report, loads, on.machine);
  if (options.report || options.json) add_texts(report, run.file.by_line());
  report.exit_status = exit_number(report.error_kind);
  add_hashes(options, report, files);
  std::string json = to_json(report);
  if (tally.curves()) files.add_report(report, json, *tally.curves(), machine, run.file.by_line());
  run.file.bytes.refuse_change();  // the file was read more than once
  files.publish(!report.error_kind);
  return {std::move(report), std::move(json)};
}

namespace {

/// The reader has the corrected program open.
std::string located_in_corrected(const Run& run, Failure failure) {
  if (failure.corrected_line == 0) return located(run.program.file, failure);
  if (failure.line > 0) failure.what += fmt::format(" (line {} of the original)", failure.line);
  failure.line = failure.corrected_line;
  return located(run.corrected_name, failure);
}

/// A terminal that shows both streams shows each warning once.
RunReport without_warnings(RunReport report) {
  report.warnings.rows.clear();
  report.warnings.count = 0;
  return report;
}

/// The result on a stream that `colour` and `marks` describe.
std::string result_text(const Options& options, const RunReport& report, const RunFiles& files, bool colour,
                        bool marks) {
  if (options.verbose) return details_text(report, colour, marks);
  std::vector<std::string> names;
  for (const FileHash& file : files.published()) names.push_back(file.path);
  return summary_text(report, names, colour);
}

void warn_of_older(const std::vector<std::string>& paths, Console& console) {
  std::error_code ignored;
  for (const std::string& path : paths)
    if (path != "-" && std::filesystem::is_regular_file(path, ignored))
      console.warning(path, 0, "not updated: the run failed");
  console.finish_warnings();
}

}  // namespace

std::optional<ErrorKind> replacing(const OutputPaths& paths, Console& console,
                                   const std::function<std::optional<ErrorKind>()>& run) {
  try {
    const std::optional<ErrorKind> error = run();
    if (error) warn_of_older({paths.program}, console);
    return error;
  } catch (const InputError& error) {
    if (error.kind() == ErrorKind::program_text || error.kind() == ErrorKind::machine_or_force)
      warn_of_older({paths.program, paths.report_json, paths.report_csv, paths.report_page, paths.plot},
                    console);
    throw;
  }
}

void print_warnings(const Run& run, const RunReport& report, Console& console) {
  for (const Remark& warning : report.warnings.rows)
    console.warning(run.program.file, warning.line, warning.what);
}

std::optional<ErrorKind> tell_result(const Options& options, const Run& run, const RunEnd& end,
                                     const RunFiles& files, Console& console) {
  print_warnings(run, end.report, console);
  console.finish_warnings();
  if (options.json)
    write_result(end.json);
  else if (files.program_to_stdout())
    console.note(result_text(options, end.report, files, console.colour_error(), console.marks_error()));
  else if (!options.quiet)
    write_painted_result(result_text(options,
                                     console.is_one_terminal() ? without_warnings(end.report) : end.report,
                                     files, console.colour_out(), console.marks_out()));
  return print_failure(run, end.report, console);
}

std::optional<ErrorKind> print_failure(const Run& run, const RunReport& report, Console& console) {
  return print_failure(run, report.failure ? report.failure : refusal_of(report), console);
}

std::optional<ErrorKind> print_failure(const Run& run, const std::optional<Failure>& failure,
                                       Console& console) {
  if (!failure) return std::nullopt;
  console.error(run.corrected_name.empty() ? located(run.program.file, *failure)
                                           : located_in_corrected(run, *failure));
  return failure->kind;
}

}  // namespace counterflex::cli
