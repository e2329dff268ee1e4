#pragma once
/// What tells a program of a Sinumerik, and its jumps, before any line of it is read.
#include <string_view>

namespace counterflex {

/// Whether `text` shows words that only a Sinumerik reads, looked for at its beginning.
bool is_siemens(std::string_view text);

/// Whether the program jumps or repeats parts of itself.
bool siemens_jumps(std::string_view text);

}  // namespace counterflex
