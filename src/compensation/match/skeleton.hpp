#pragma once
/// What of a block correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// The block without blanks and without the words of a move that are rewritten: N (of a split block the first
/// piece has it), axes, centre, radius, heights of a cycle, the turns of an arc, G0 to G3 (which motion acts,
/// the move says), and the F of a G93 move.
std::string skeleton(const Program& program, const Move& move);

/// Whether a skeleton holds no more than an inserted piece may: F. Comments are no words.
bool is_plain(const std::string& skeleton);

}  // namespace counterflex
