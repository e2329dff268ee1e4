#pragma once
/// Compensates a program, for the command, a batch or a watch.
#include <optional>

#include "run/run.hpp"
#include "run/run_end.hpp"

namespace counterflex::cli {

/// Runs `compensate` and calls `report_end` to report the result. A run that fails before it has a result
/// reports the failure through `console` and does not call `report_end`. Throws `InputError`.
std::optional<ErrorKind> compensate_program(const Options& options, Console& console,
                                            const ReportEnd& report_end);

/// The same for a run that is prepared; its outputs go to `paths`.
std::optional<ErrorKind> compensate_run(const Options& options, Run& run, const OutputPaths& paths,
                                        Console& console, const ReportEnd& report_end);

}  // namespace counterflex::cli
