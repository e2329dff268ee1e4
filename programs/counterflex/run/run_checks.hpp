#pragma once
/// Whether program and machine fit together: what refuses a run, and what a user should know.
#include "run/run.hpp"

namespace counterflex::cli {

/// Throws `InputError` (ErrorKind::machine_or_force) if the program turns the tool and the machine cannot.
void refuse_orientation(const Run& run);

/// Throws `InputError` (ErrorKind::machine_or_force) if the program states another tool axis than that at
/// home for points of X, Y and Z, which are computed with the orientation at home.
void refuse_tool_axis(const Run& run);

/// Throws for a machine that controls nothing (ErrorKind::machine_or_force) and for a program with the header
/// of a corrected one (ErrorKind::program_text).
void refuse_what_cannot_be_compensated(const Run& run);

/// Adds warnings to the facts of the run: a corrected program, work offsets without a datum, orientations
/// that the program does not state, tools without stiffness, cycles without forces, an assumed work offset.
void add_input_warnings(Run& run, Command command);

}  // namespace counterflex::cli
