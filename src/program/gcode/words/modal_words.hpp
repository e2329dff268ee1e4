#pragma once
/// Words that change modal states and do not move the tool.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Unit, feed mode, F, S and T; the tool change.
void apply_feed_and_tool(Reading& reading);

/// Plane, G90, G91, centre mode, levels of cycles, stops, and the motion.
void apply_modes(const Block& block, Reading& reading);

/// The motion only.
void apply_motion(Reading& reading);

}  // namespace counterflex
