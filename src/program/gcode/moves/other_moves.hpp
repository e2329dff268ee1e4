#pragma once
/// Moves of which only the states afterwards are followed.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// G53, G28, G30: the program does not know the position of the axes afterwards.
void add_machine_move(const Block& block, Reading& reading, const FoundG& found);

/// M25, at the end of its block. An inserted word of Z in a later block would move back down.
void apply_retract(const Block& block, Reading& reading);

/// Probing, splines, threads: shifted as a whole. Behind a spline the position is known (`end_known`), behind
/// the others it is not.
void read_held(const Block& block, Reading& reading, std::string_view what, bool end_known);

/// A motion defined by the control, which starts from the block's words. Not corrected.
void read_own_way(const Block& block, Reading& reading, const FoundG& found);

/// G47: engraved text. It begins at X and Y. Its depth Z and its plane R are shifted like those of a hole.
void read_engraving(const Block& block, Reading& reading, const FoundG& found);

/// G12, G13: a round pocket about the position of the tool.
void read_pocket(const Block& block, Reading& reading);

/// The call of a subprogram or macro: it may move all axes and set all states.
void read_call(const Block& block, Reading& reading, std::string_view program);

/// An assignment of a Sinumerik to a name that is not known: it may be a word that moves an axis.
void read_unknown_word(const Block& block, Reading& reading, std::string_view name);

/// A block with an unknown effect: all states and the position are unknown afterwards.
void read_anything(const Block& block, Reading& reading, std::string_view why);

}  // namespace counterflex
