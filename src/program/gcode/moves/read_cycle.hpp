#pragma once
/// Holes under G73, G74, G76 and G81 to G89.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Adds the hole of a block, and stores its sticky words.
void read_cycle(const Block& block, Reading& reading);

}  // namespace counterflex
