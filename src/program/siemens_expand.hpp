#pragma once
/// Loops, conditions and jumps of a Sinumerik's program, run as its constants say.
#include "program/expand.hpp"

namespace counterflex {

/// Puts the lines that the control executes, in their order, in the place of `text`: FOR, WHILE, LOOP,
/// REPEAT, IF and jumps to labels. Nothing changes where a condition is not known from the text, or where
/// more than 150 000 lines would run: then `calls_left` says why.
Expansion expand_siemens(std::string& text, const std::string& file, const Dialect& dialect);

}  // namespace counterflex
