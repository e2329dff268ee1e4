#pragma once
/// What of a block of Klartext correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `kept_words`, of a program in Klartext.
std::string klartext_kept_words(const Program& program, const Move& move);

}  // namespace counterflex
