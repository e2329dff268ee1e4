#pragma once
/// What of a motion of a FANUC TP program correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `kept_words`, of a TP program: the statement, and what its positions have besides the numbers that a
/// correction changes.
std::string tp_kept_words(const Program& program, const Move& move);

}  // namespace counterflex
