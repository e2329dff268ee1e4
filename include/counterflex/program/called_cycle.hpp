#pragma once
/// Modal drilling cycles of a Sinumerik.
#include <optional>
#include <string_view>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// The cycle of "MCALL CYCLE81(50, 0, 2, -20)", from MCALL to the end of the statement without its comment.
/// Empty if the cycle is not CYCLE81 to CYCLE89 or CYCLE840, or if a height is not a plain number.
std::optional<CalledCycle> modal_drilling_cycle(std::string_view statement);

}  // namespace counterflex
