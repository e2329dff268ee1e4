#pragma once
/// The end of a run: its report, its files, and what is printed.
#include <functional>
#include <optional>
#include <string>

#include "process/console.hpp"
#include "run/run.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {

/// The result of a run whose files are published.
struct RunEnd {
  RunReport report;
  std::string json;  ///< of the report
};

/// Reports a finished run whose files are published. Returns the kind of its error, or none.
using ReportEnd = std::function<std::optional<ErrorKind>(const Run&, const RunEnd&, const RunFiles&)>;

/// Completes the report and publishes the run's files. Throws `InputError` (ErrorKind::transient_io).
RunEnd finish_run(const Options& options, Run& run, RunReport report, const RunTally& tally, RunFiles& files);

/// Does `run`, which writes `paths`. If it fails, warns of the files of an earlier run that stay: the
/// program, and the reports too if an input is refused.
std::optional<ErrorKind> replacing(const OutputPaths& paths, Console& console,
                                   const std::function<std::optional<ErrorKind>()>& run);

/// Prints the warnings of the report that the run has not printed.
void print_warnings(const Run& run, const RunReport& report, Console& console);

/// Prints the failure, if any. Returns its kind.
std::optional<ErrorKind> print_failure(const Run& run, const std::optional<Failure>& failure,
                                       Console& console);

/// The same for the failure of a report, or for its verdict.
std::optional<ErrorKind> print_failure(const Run& run, const RunReport& report, Console& console);

/// Prints the result: the summary or the JSON document on standard output, or the summary on standard error
/// if standard output has the corrected program. Then prints the failure, if any. Returns its kind.
std::optional<ErrorKind> tell_result(const Options& options, const Run& run, const RunEnd& end,
                                     const RunFiles& files, Console& console);

}  // namespace counterflex::cli
