#pragma once
/// What of a block correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// The block without blanks and without the words of a move that are rewritten: N (of a split block the first
/// piece has it), axes, centre, radius, heights of a cycle, the turns of an arc, G0 to G3 (the move has
/// the motion), and the F of a G93 move.
///
/// Of a robot program: the statement without blanks, without the numbers of its target and without a zone. Of
/// a target that is given by a name only the words before it, and '@': it may have been replaced by its
/// numbers.
std::string kept_words(const Program& program, const Move& move);

/// Whether the kept words of two moves are of one statement.
bool are_alike(const std::string& a, const std::string& b);

/// Whether kept words are only those that an inserted piece may have: F. Comments do not count.
bool is_plain(const std::string& words);

}  // namespace counterflex
