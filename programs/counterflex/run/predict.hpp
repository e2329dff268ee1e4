#pragma once
/// Predicts the deviation of a program.
#include <optional>

#include "run/run.hpp"
#include "run/run_end.hpp"

namespace counterflex::cli {

/// Solves the original program of a prepared run forward; the report goes to `paths`. Returns what
/// `report_end` returns. Throws `InputError`.
std::optional<ErrorKind> predict_run(const Options& options, Run& run, const OutputPaths& paths,
                                     Console& console, const ReportEnd& report_end);

}  // namespace counterflex::cli
