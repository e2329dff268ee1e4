#pragma once
/// The style of Klartext that is inserted into a program: that of the program.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

struct KlartextStyle {
  bool comma = false;     ///< decimal comma
  bool plus = false;      ///< "X+1"
  bool numbered = false;  ///< blocks begin with numbers
  bool n_words = false;   ///< "N5" instead of "5"
  std::string line_end = "\n";
};

/// The style of `program`. Its first number with a decimal sign decides on the sign.
KlartextStyle klartext_style(const Program& program);

/// `value` in `style`.
std::string klartext_number(const KlartextStyle& style, double value, int decimals);

}  // namespace counterflex
