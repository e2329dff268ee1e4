#pragma once
/// The words of a Sinumerik beyond those of G-code: "X=IC(5)", "CR=4.", "R1=5", "MSG(...)", "TRANS X10",
/// "CYCLE81(...)", labels.
#include "program/text/scanner.hpp"

namespace counterflex {

/// Takes the line apart: see `lex`.
void lex_siemens(Scanner& scanner);

}  // namespace counterflex
