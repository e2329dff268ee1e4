#pragma once
/// Lines of the body of an O-word, which has its own variables.
#include <string>
#include <string_view>

#include "program/evaluate/variables.hpp"

namespace counterflex {

struct BodyLine {
  std::string text{};     ///< with its line end; empty if no line is written
  std::string why_not{};  ///< set if a value is unknown
};

/// The line of `block` with values in place of expressions. Assignments to local variables are left out;
/// assignments to global variables get the value.
BodyLine line_of_body(std::string_view text, const Dialect& dialect, const Block& block,
                      const Variables& variables);

}  // namespace counterflex
