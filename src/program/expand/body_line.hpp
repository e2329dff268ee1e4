#pragma once
/// Lines of the body of an O-word, whose variables are its own.
#include <string>
#include <string_view>

#include "program/evaluate/variables.hpp"

namespace counterflex {

struct BodyLine {
  std::string text{};     ///< with its line end; empty where nothing is left to write
  std::string why_not{};  ///< a value is not known
};

/// The line of `block` with values in the place of expressions. Assignments to local variables are left out; those to
/// global variables hold the value.
BodyLine line_of_body(std::string_view text, const Dialect& dialect, const Block& block, const Variables& variables);

}  // namespace counterflex
