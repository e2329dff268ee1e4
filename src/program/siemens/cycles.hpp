#pragma once
/// Cycles of a Sinumerik whose heights are plain numbers: CYCLE81 to CYCLE89 and CYCLE840 drill where the tool
/// stands; pockets, slots, spigots and CYCLE71 mill about a centre that is in their list.
#include "counterflex/program/called_cycle.hpp"
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// The cycle that the block calls, or MCALL: its heights are absolute and go along with the hole. None where
/// one of them is no plain number, or the cycle is another one.
std::optional<CalledCycle> drilling_cycle(const Block& block, const Reading& reading);

/// Reads the call of a drilling cycle as a hole where the tool stands, that of a milling cycle as a move to its
/// centre. False where it is not followed.
bool read_called_cycle(const Block& block, Reading& reading);

/// MCALL with a drilling cycle: each block with a position is a hole. False where it is not followed.
bool begin_modal_cycle(const Block& block, Reading& reading);

/// Whether the block is a hole of the modal cycle. Where it moves otherwise, the cycle is not followed from
/// here on.
bool takes_modal_hole(const Block& block, Reading& reading);

/// Makes the move, whose words are placed, a hole of the modal cycle.
void place_modal_hole(Reading& reading, Move& move);

/// Where the cycle leaves the tool, behind the move that made the hole.
void leave_called_hole(Reading& reading);

}  // namespace counterflex
