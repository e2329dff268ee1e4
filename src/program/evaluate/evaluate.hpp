#pragma once
/// Evaluates variables and expressions whose values are known from the text, with ReadOptions::evaluate.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Makes words of `block` literal if their values are known: `#5`, `[#1+2]`, `R1*2`. Their spans do not
/// change, so that a new number replaces the expression.
void evaluate_words(Block& block, Reading& reading);

/// Stores the values that the block assigns. Call it after the block was interpreted. A variable becomes
/// unknown if it is set in a condition, in a loop or in a block that may be skipped. A call makes all
/// variables unknown.
void take_assignments(const Block& block, Reading& reading);

/// Counts a word that was a variable or an expression and was evaluated. Adds a remark for the first one.
void count_evaluated(Program& program, int line);

/// Whether a difference has more digits than words can have. The position in the text after it would be
/// unknown.
bool has_too_many_digits(double value);

}  // namespace counterflex
