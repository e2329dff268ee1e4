#pragma once
/// The common lines of a program, read at once: G0 or G1, X, Y, Z, F and N with plain numbers, where they are
/// moves that are followed.
#include <cstddef>

#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Whether in this state such lines say all that there is to their moves. It holds until a line that is read
/// otherwise.
bool takes_plain_lines(const Reading& reading);

/// Reads the lines behind `block` as `lex` and `interpret` would, up to the first that holds anything else,
/// or that is not known to be right, or until the program has `most_moves`; how many. Needs
/// `takes_plain_lines`. `block` is moved on, without words. Does not throw.
std::size_t read_plain_lines(Reading& reading, Block& block, std::size_t most_moves);

}  // namespace counterflex
