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

/// Updates `word`, the G2 or G3 that acts (else empty), by a line without a move. The rules are those of the
/// writer, which states the motion again where inserted text has changed it.
void follow_arc_word(const Program& program, Span line, std::string& word);

/// The same by a move. Returns the G2 or G3 of an arc that is not followed; of others the path is judged.
std::string take_arc_word(const Program& program, const Move& move, std::string& word);

}  // namespace counterflex
