#pragma once
/// Compensates a program, for the command, a batch or a watch.
#include <functional>

#include "run/run.hpp"

namespace counterflex::cli {

/// Reports a finished run whose files are published. Returns the kind of its error, or none.
using ReportEnd = std::function<std::optional<ErrorKind>(const Run&, const RunEnd&, const RunFiles&)>;

/// Runs `compensate` and calls `report_end` to report the result. A run that fails before it has a result
/// reports the failure through `console` and does not call `report_end`. Throws `InputError`.
std::optional<ErrorKind> compensate_program(const Options& options, Console& console,
                                            const ReportEnd& report_end);

}  // namespace counterflex::cli
