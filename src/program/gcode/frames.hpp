#pragma once
/// Shifts and turns of coordinates by plain numbers: G10, G52, G92, G68 about Z.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// The index of `frame` in Program::frames, to which a new one is added.
std::size_t index_of_frame(Program& program, const ProgramFrame& frame);

/// The coordinates in `now` of the point that has `p_mm` in `before`, a frame of the same work offset (mm).
Vector3 position_in(const ProgramFrame& now, const ProgramFrame& before, const Vector3& p_mm);

/// Selects the coordinates of a work offset under the shifts that act. Where the offset stays, a position that is known
/// goes along; a turn leaves X and Y unknown until they are programmed.
void enter_frame(Reading& reading, const std::string& work_offset);

/// Follows G52, G92, G92.1, G92.2, G68 and G69 with plain numbers; false where the block's code is not one of these or
/// cannot be followed.
bool apply_frame_code(const Block& block, Reading& reading, const GCode& code);

/// Follows G10 L2 and L20 with plain numbers; false where that cannot be.
bool set_work_offset(const Block& block, Reading& reading);

/// Follows TRANS, ATRANS, ROT and AROT of a Sinumerik about Z with plain numbers; false where that cannot be.
bool apply_frame_statement(const Block& block, Reading& reading);

}  // namespace counterflex
