#pragma once
/// Conditions, loops and subprograms: what stands in them is not followed.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// A line of flow ("o100 sub", "WHILE [#1 LT 5] DO1").
void read_flow(const Block& block, Reading& reading);

/// The O-number of a program: the first, or a subprogram behind another.
void read_program_number(const Block& block, Reading& reading);

/// M99: ends a subprogram, or runs the program over and over.
void come_back(Reading& reading);

/// What in `now` differs from `before` may be either from now on.
void doubt_differences(const ModalState& before, ModalState& now);

}  // namespace counterflex
