#pragma once
/// Signs of a Sinumerik program, and of jumps in it, found before the program is read.
#include <string_view>

namespace counterflex {

/// Whether the beginning of `text` has words that only a Sinumerik reads.
bool is_siemens(std::string_view text);

/// Whether the program jumps or repeats parts of itself.
bool siemens_jumps(std::string_view text);

}  // namespace counterflex
