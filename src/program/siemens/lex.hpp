#pragma once
/// Words of a Sinumerik in addition to those of G-code: "X=IC(5)", "CR=4.", "R1=5", "MSG(...)", "TRANS X10",
/// "CYCLE81(...)", labels.
#include "program/text/scanner.hpp"

namespace counterflex {

/// Lexes the line, see `lex`.
void lex_siemens(Scanner& scanner);

}  // namespace counterflex
