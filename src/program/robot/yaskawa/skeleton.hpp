#pragma once
/// What of a step of a Yaskawa job correction never changes.
#include <string>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// As `skeleton`, of a job of Yaskawa.
std::string jbi_skeleton(const Program& program, const Move& move);

}  // namespace counterflex
