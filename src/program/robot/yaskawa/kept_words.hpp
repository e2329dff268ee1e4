#pragma once
/// What of a step of a Yaskawa job correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `kept_words`, of a job of Yaskawa.
std::string jbi_kept_words(const Program& program, const Move& move);

/// Whether a line is "///NPOS 5,0,0,1,0,0".
bool is_jbi_counts(std::string_view line);

/// Such a line with the surplus of each of its first numbers over the positions C, BC and EC of `text` in the
/// place of the number: insertion counts both on.
std::string jbi_surplus(std::string_view text, std::string_view line);

}  // namespace counterflex
