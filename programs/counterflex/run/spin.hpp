#pragma once
/// The option --free spin.
#include "process/console.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Chooses the turn about the spindle axis along the program, and solves the program with it and without it.
/// Sets `Run::spins`, which stay empty where nothing is gained or where the program fails as it is, and the
/// facts of the report. Throws `InputError` for a machine (ErrorKind::machine_or_force) or a program
/// (ErrorKind::program_text) whose tool cannot be turned.
void choose_spin(Run& run, Console& console);

}  // namespace counterflex::cli
