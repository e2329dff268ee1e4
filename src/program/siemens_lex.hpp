#pragma once
/// The words of a Sinumerik beyond those of G-code: "X=IC(5)", "CR=4.", "R1=5", "MSG(...)", "TRANS X10",
/// "CYCLE81(...)", labels.
#include "program/scanner.hpp"

namespace counterflex {

/// Whether `text` shows words that only a Sinumerik reads, looked for at its beginning.
bool is_siemens(std::string_view text);

/// Whether the program jumps or repeats parts of itself.
bool siemens_jumps(std::string_view text);

/// Takes the line apart: see `lex`.
void lex_siemens(Scanner& scanner);

}  // namespace counterflex
