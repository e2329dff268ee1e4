#include "run/verify.hpp"

#include <optional>
#include <utility>

#include "counterflex/compensation/windows.hpp"
#include "run/guard.hpp"
#include "run/header/header_hashes.hpp"
#include "run/proof.hpp"
#include "run/run_checks.hpp"
#include "run/run_end.hpp"
#include "run/significance.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {
namespace {

/// Contents of a corrected program except its moves, which are matched later.
struct CorrectedScan {
  Overview program;
  std::string beginning;   ///< text of the first window, which has the header
  bool has_marks = false;  ///< such as the lines of a guard have
};

CorrectedScan scan_corrected(const Options& options, const Run& run, const ReadOptions& read,
                             ProgramFile& file, RunTally& tally, ProofNotes* proof) {
  const std::string name = shown_name(options.verify.corrected);
  CorrectedScan scan;
  file.bytes.hash_along();
  ProgramReader reader(file.bytes, name, read);
  bool begun = false;
  while (reader.next()) {
    Program& window = reader.window();
    if (!std::exchange(begun, true)) scan.beginning = window.text;
    scan.has_marks = scan.has_marks || window.text.find("CF ") != std::string::npos;
    if (proof != nullptr) proof->add_text(window.text);
    ignore_axes(window, run.ignored);
    add_window(scan.program, window);
    tally.add_corrected(window);
  }
  file.file.sha256 = sha256(file.bytes);
  return scan;
}

std::optional<Failure> verify_all(Run& run, ProgramReader& corrected, RunTally& tally, RunFiles& files,
                                  ProofNotes* proof, Console& console) {
  Windows windows(run, console);
  WindowEvents events = windows.events(tally, files);
  events.done = [&tally](const Job&, const Compensation& window) { tally.add_compensation(window); };
  if (proof != nullptr) proof->listen(events);
  return verify_windows(windows.jobs(), run.options.threads, corrected, run.facts.attribution, events);
}

}  // namespace

std::optional<ErrorKind> verify_run(const Options& options, Run& run, ProgramFile corrected,
                                    const OutputPaths& paths, Console& console, const ReportEnd& report_end) {
  refuse_what_cannot_be_compensated(run);
  if (options.only_significant) find_insignificant(run, console);
  RunTally tally = tally_for(options, run);
  ReadOptions read = run.read;
  read.dialect = run.program.dialect;  // that of the original, independent of the name of the corrected file
  std::optional<ProofNotes> proof;
  if (wants_proof(options)) proof.emplace(run.program.dialect);
  const CorrectedScan scan = scan_corrected(options, run, read, corrected, tally, proof ? &*proof : nullptr);
  if (scan.has_marks) expect_guard(run);
  run.facts.inputs.push_back(corrected.file);
  run.corrected_name = shown_name(options.verify.corrected);
  for (const std::string& warning : other_inputs_of_header(scan.beginning, options, run))
    console.warning(run.corrected_name, 0, warning);
  refuse_replaced(paths, run.uncertainty_files);
  RunFiles files(paths, columns_of(options, run));
  corrected.bytes.rewind();
  ProgramReader reader(corrected.bytes, run.corrected_name, read);
  const std::optional<Failure> failure =
      verify_all(run, reader, tally, files, proof ? &*proof : nullptr, console);
  corrected.bytes.refuse_change();
  if (!failure && proof) {
    run.facts.proof = proof->facts(run);
    run.facts.proof->written = {corrected.file};
    for (const InputFile& list : corrected.data_lists) run.facts.proof->written.push_back(list);
  }
  return report_end(run,
                    finish_run(options, run, report_verification(run.context(), tally, scan.program, failure),
                               tally, files),
                    files);
}

}  // namespace counterflex::cli
