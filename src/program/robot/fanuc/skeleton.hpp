#pragma once
/// What of a motion of a FANUC TP program correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `skeleton`, of a TP program: the statement, and what its positions have besides the numbers that a
/// correction changes.
std::string tp_skeleton(const Program& program, const Move& move);

}  // namespace counterflex
