#pragma once
/// Blocks that move the tool in ways that are followed only for what they leave behind.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// G53, G28, G30: where the axes are afterwards, the machine knows and the program does not.
void leave_machine_move(const Block& block, Reading& reading, const FoundG& found);

/// M25, at the end of its block: after it a word of Z that is put into a block would go back down.
void leave_retract(const Block& block, Reading& reading);

/// Probing, splines, threads: shifted as a whole, their ends unknown where probing ends them.
void read_held(const Block& block, Reading& reading, std::string_view what, bool end_known);

/// A way of the control's own, from the block's words: it stays as it is.
void read_own_way(const Block& block, Reading& reading, const FoundG& found);

/// G47: text that begins at X and Y, its depth Z and its plane R go along with a shift as a hole's do.
void read_engraving(const Block& block, Reading& reading, const FoundG& found);

/// G12, G13: a round pocket about the place where the tool is.
void read_pocket(const Block& block, Reading& reading);

/// The call of a subprogram or macro: it may move anywhere and set any state.
void read_call(const Block& block, Reading& reading);

/// A block that may do anything: every state and the position are in doubt afterwards.
void read_anything(const Block& block, Reading& reading, std::string_view why);

}  // namespace counterflex
