#pragma once
/// What of a block correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// The block without blanks and without the words of a move that are rewritten: N (of a split block the first
/// piece has it), axes, centre, radius, heights of a cycle, the turns of an arc, G0 to G3 (the move has
/// the motion), and the F of a G93 move.
std::string skeleton(const Program& program, const Move& move);

/// Whether a skeleton has only words that an inserted piece may have: F. Comments do not count.
bool is_plain(const std::string& skeleton);

}  // namespace counterflex
