#pragma once
/// The commands. Each returns the exit status. Throws `InputError` for errors of its inputs, before any file
/// is written.
#include "counterflex/files/input_error.hpp"
#include "process/console.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

Exit run_compensate(const Options& options, Console& console);
Exit run_predict(const Options& options, Console& console);
Exit run_verify(const Options& options, Console& console);
Exit run_compare(const Options& options, Console& console);
Exit run_analyze(const Options& options, Console& console);
Exit run_forces(const Options& options, Console& console);
Exit run_check(const Options& options, Console& console);
Exit run_batch(const Options& options, Console& console);

/// Compensates the programs that appear in a folder, until it is interrupted.
Exit run_watch(const Options& options, Console& console);

}  // namespace counterflex::cli
