#pragma once
/// Moves under G2 and G3.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Adds the arc of a block that holds axis or centre words. An arc whose start is not known in its plane, or
/// whose centre is an expression, is held or fixed.
void read_arc(const Block& block, Reading& reading);

}  // namespace counterflex
