#pragma once
/// Shifts and rotations of coordinates by plain numbers: G10, G52, G92, G68 about Z.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// The index of `frame` in Program::frames; appends a new frame.
std::size_t index_of_frame(Program& program, const ProgramFrame& frame);

/// Converts the point `p_mm` from `before` to `now`, frames of the same work offset (mm).
Vector3 position_in(const ProgramFrame& now, const ProgramFrame& before, const Vector3& p_mm);

/// Selects the coordinates of a work offset under the active shifts. If the offset does not change, a known
/// position is converted. A rotation makes X and Y unknown until they are programmed.
void enter_frame(Reading& reading, const std::string& work_offset);

/// Reads G52, G92, G92.1, G92.2, G68 and G69 with plain numbers. False if the block has none of these codes
/// or cannot be followed.
bool apply_frame_code(const Block& block, Reading& reading, const GCode& code);

/// Ends G52, and on controls that store both in one place G92, where the state before is not known.
void end_local_shift(Reading& reading);

/// Whether G52 shifts the coordinates.
bool has_local_shift(const Reading& reading);

/// Reads G10 L2 and L20 with plain numbers. False if the block cannot be followed.
bool set_work_offset(const Block& block, Reading& reading);

/// Reads TRANS, ATRANS, ROT and AROT of a Sinumerik about Z with plain numbers, and the end of all frames by
/// TRANS, ROT, SCALE or MIRROR alone. False if the block cannot be followed.
bool apply_frame_statement(const Block& block, Reading& reading);

}  // namespace counterflex
