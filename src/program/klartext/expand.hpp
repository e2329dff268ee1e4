#pragma once
/// Puts the bodies of Klartext subprograms, and the parts of a program that are repeated, in the place of
/// CALL LBL.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// Replaces every CALL LBL in `text` by copies of the blocks that it calls, REP as often as it repeats, and
/// the calls in these copies likewise. Copies have no LBL. Where one call cannot be replaced all stay, with
/// the reason: a jump, a label by a Q parameter, one that is missing or calls itself. Numbered blocks are
/// renumbered. Throws `InputError` (Exit::program_text) where more than `largest_expansion` bytes would
/// come out.
Expansion expand_klartext(std::string& text, const std::string& file);

}  // namespace counterflex
