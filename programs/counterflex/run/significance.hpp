#pragma once
/// The option --only-significant.
#include "process/console.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Solves the program without a correction, and sets `Run::as_programmed`. Throws `InputError`
/// (ErrorKind::machine_or_force) for a machine without an uncertainty.
void find_insignificant(Run& run, Console& console);

}  // namespace counterflex::cli
