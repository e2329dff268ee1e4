#pragma once
/// Replaces CALL LBL by the bodies of Klartext subprograms and by repeated parts of the program.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// Replaces every CALL LBL in `text` by copies of the blocks that it calls, repeated as REP gives. Calls in
/// these copies are replaced, too. Copies have no LBL. If one call cannot be replaced, all calls stay, with
/// the reason: a jump, a Q parameter as label, a missing label, or a label that calls itself. Numbered blocks
/// are renumbered. Throws `InputError` (ErrorKind::program_text) if the result would exceed the limits
/// of expand.hpp.
Expansion expand_klartext(std::string& text, const std::string& file);

}  // namespace counterflex
