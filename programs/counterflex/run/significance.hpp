#pragma once
/// The option --only-significant, and what else needs an uncertainty.
#include "process/console.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Throws `InputError` (ErrorKind::machine_or_force) for a machine without an uncertainty, which `option`
/// needs.
void refuse_without_uncertainty(const Run& run, const std::string& option);

/// Solves the program without a correction, and sets `Run::as_programmed`. Throws as above.
void find_insignificant(Run& run, Console& console);

}  // namespace counterflex::cli
