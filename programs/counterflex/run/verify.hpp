#pragma once
/// Judges a corrected program.
#include <optional>

#include "run/run.hpp"
#include "run/run_end.hpp"

namespace counterflex::cli {

/// Solves `corrected` forward against the original of a prepared run; the report goes to `paths`.
/// `options.verify.corrected` names it. Returns what `report_end` returns. Throws `InputError`.
std::optional<ErrorKind> verify_run(const Options& options, Run& run, ProgramFile corrected,
                                    const OutputPaths& paths, Console& console, const ReportEnd& report_end);

}  // namespace counterflex::cli
