#pragma once
/// What a program with numbered subprograms and jumps shows only when looked at as a whole.
#include <cstddef>
#include <string_view>
#include <vector>

#include "program/dialect.hpp"

namespace counterflex {

struct Outline {
  bool jumps = false;                    ///< GOTO stands in it
  std::vector<std::size_t> subprograms;  ///< where the O of each program stands that M99 ends
};

/// Looks through `text` once; nothing for dialects without numbered programs.
Outline outline_of(std::string_view text, const Dialect& dialect);

}  // namespace counterflex
