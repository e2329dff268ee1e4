#pragma once
/// Cycles of a Sinumerik whose heights are plain numbers. CYCLE81 to CYCLE89 and CYCLE840 drill at the tool's
/// position. Pockets, slots, spigots and CYCLE71 mill around a centre in their argument list.
#include "counterflex/program/program.hpp"
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// The cycle called by the block or by MCALL. Its heights are absolute and shift with the hole. Empty if a
/// height is not a plain number, or for other cycles.
std::optional<CalledCycle> drilling_cycle(const Block& block, const Reading& reading);

/// Reads the call of a drilling cycle as a hole at the tool's position, and that of a milling cycle as a move
/// to its centre. False if the call is not followed.
bool read_called_cycle(const Block& block, Reading& reading);

/// MCALL with a drilling cycle: each block with a position is a hole. False if it is not followed.
bool begin_modal_cycle(const Block& block, Reading& reading);

/// Whether the block is a hole of the modal cycle. If the block moves in another way, the cycle is not
/// followed from here on.
bool takes_modal_hole(const Block& block, Reading& reading);

/// Makes the move, whose words were read, a hole of the modal cycle.
void place_modal_hole(Reading& reading, Move& move);

/// Sets the height at which the cycle leaves the tool, after the move of the hole.
void end_called_hole(Reading& reading);

}  // namespace counterflex
