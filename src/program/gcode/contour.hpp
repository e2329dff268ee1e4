#pragma once
/// Contours under G41 and G42: runs of moves that are shifted together.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Largest number of moves along Z before a contour that belong to it. If there are more, none of them does. So a window
/// can end inside a long run of them.
inline constexpr std::ptrdiff_t most_moves_before_contour = 16;

/// Whether a move is one along Z alone.
bool goes_along_z(const Move& move);

/// Whether `window` ends with more moves along Z than a contour takes, with those of the windows before it.
bool ends_along_z(const Program& window);

/// Index of the first move before a contour that belongs to it: the moves along Z from `run_begin` on, and the one
/// before them. The number of moves if no move belongs to it.
std::size_t first_before_contour(const Program& program, std::size_t run_begin);

/// What G40, G41 and G42 of the block begin and end; before its move is read.
void apply_cutter(Reading& reading);

/// Puts the move just read into the contour that it belongs to.
void join_contour(Reading& reading);

/// No further move belongs to the contour.
void end_contour(Reading& reading);

}  // namespace counterflex
