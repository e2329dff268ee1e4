#pragma once
/// Conditions and loops around the blocks of a program.
#include <string>
#include <string_view>
#include <vector>

#include "program/text/lex.hpp"

namespace counterflex {

struct Structures {
  std::vector<std::string> open;  ///< names of open structures; a DO has " do" behind its name
};

/// Opens or closes the structure of `block`.
void follow_structures(std::string_view text, const Dialect& dialect, const Block& block,
                       Structures& structures);

}  // namespace counterflex
