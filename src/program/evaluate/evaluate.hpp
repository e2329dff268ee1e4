#pragma once
/// Works out variables and expressions whose values the text shows, where that was asked for.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Makes words of `block` literal whose values are known: `#5`, `[#1+2]`, `R1*2`. Their spans stay, so that a new number
/// takes the place of the expression.
void evaluate_words(Block& block, Reading& reading);

/// Stores the values that the block assigns. Call it after the block has been interpreted. A variable that is set in a
/// condition, in a loop or in a block that may be skipped becomes unknown. A call makes all variables unknown.
void take_assignments(const Block& block, Reading& reading);

/// Counts a word that was a variable or an expression and is its value; the first one is remarked.
void note_worked_out(Program& program, int line);

/// Whether a difference has more digits than words have: what the text holds after it would not be known.
bool has_too_many_digits(double value);

}  // namespace counterflex
