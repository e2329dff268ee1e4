#pragma once
/// What of a block of G-code or Klartext correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// The block without blanks and without the words whose numbers are rewritten. `klartext`: an 'I' before such
/// a word belongs to it.
std::string without_rewritten_words(const Program& program, const Move& move, bool klartext);

/// As `kept_words`, of a program in G-code.
std::string gcode_kept_words(const Program& program, const Move& move);

}  // namespace counterflex
