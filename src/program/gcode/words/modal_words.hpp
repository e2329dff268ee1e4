#pragma once
/// Words that change modal states and do not move the tool.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// The unit in which a control reads F now. G70 and G71 of a Sinumerik set the unit of lengths; F stays in
/// the basic system of the control, which `ReadOptions::unit` states. Without it F is in mm under G71, and
/// its unit is unknown under G70.
std::optional<LengthUnit> unit_of_feed(const Reading& reading);

/// Takes the number of an F. It is unknown if its unit is.
void set_feed(Reading& reading, double value, std::optional<LengthUnit> unit);

/// Unit, feed mode, F, S and T; the tool change.
void apply_feed_and_tool(Reading& reading);

/// Plane, G90, G91, centre mode, levels of cycles, stops, and the motion.
void apply_modes(const Block& block, Reading& reading);

/// The motion only.
void apply_motion(Reading& reading);

}  // namespace counterflex
