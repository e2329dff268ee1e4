#pragma once
/// Conditions and loops around the blocks of a program.
#include <string>
#include <string_view>
#include <vector>

#include "program/text/lex.hpp"

namespace counterflex {

struct Structures {
  std::vector<std::string> open;  ///< names; of a DO with " do" behind
};

/// Opens or closes what `block` says.
void follow_structures(std::string_view text, const Dialect& dialect, const Block& block,
                       Structures& structures);

}  // namespace counterflex
