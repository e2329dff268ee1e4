#pragma once
/// Moves under G2 and G3.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Adds the arc of a block with axis or centre words. An arc is held or fixed if its start is unknown in its
/// plane, or if its centre is an expression.
void read_arc(const Block& block, Reading& reading);

}  // namespace counterflex
