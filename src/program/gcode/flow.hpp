#pragma once
/// Conditions, loops and subprograms. Moves inside of them are not followed.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Reads a line of flow ("o100 sub", "WHILE [#1 LT 5] DO1").
void read_flow(const Block& block, Reading& reading);

/// Reads the O-number of a program: the first one, or that of a subprogram behind it.
void read_program_number(const Block& block, Reading& reading);

/// Notes the states that the block sets if it is before the first move. The codes of the block have acted.
void note_begin_of_program(const Block& block, Reading& reading);

/// M99: ends a subprogram, or repeats the program. Throws `InputError` if a repetition has another state.
void return_from_call(const Block& block, Reading& reading);

/// Makes the states unknown that differ between `before` and `now`.
void mark_differences_unknown(const Dialect& dialect, const ModalState& before, ModalState& now);

}  // namespace counterflex
