#pragma once
/// What of a step of a Yaskawa job correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `kept_words`, of a job of Yaskawa.
std::string jbi_kept_words(const Program& program, const Move& move);

}  // namespace counterflex
