#pragma once
/// Fast reader of the most common lines: G0 or G1, X, Y, Z, F and N with plain numbers, as moves that are
/// followed.
#include <cstddef>

#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Whether moves in this state are fully determined by such lines. Stays valid until another line is read.
bool takes_plain_lines(const Reading& reading);

/// Reads the lines behind `block` with the results of `lex` and `interpret`, up to the first line with other
/// words, the first line that may be invalid, or until the program has `most_moves`. Returns the number of
/// lines. Requires `takes_plain_lines`. Moves `block` to the last line, without words. Does not throw.
std::size_t read_plain_lines(Reading& reading, Block& block, std::size_t most_moves);

}  // namespace counterflex
