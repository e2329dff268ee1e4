#pragma once
/// The commands. Each throws `InputError` for what is wrong with its inputs, before anything is written, and
/// returns the exit status otherwise.
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

/// Until it is interrupted: compensates the programs that appear in a folder.
Exit run_watch(const Options& options, Console& console);

}  // namespace counterflex::cli
