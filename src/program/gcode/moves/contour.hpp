#pragma once
/// Contours under G41 and G42: runs of moves that are shifted together.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Largest number of moves along Z before a contour that belong to it. If there are more, none of them
/// belongs to it, so that a window can end inside a long run of them.
inline constexpr std::ptrdiff_t most_moves_before_contour = 16;

/// Whether the compensation begins or ends on the next move in the plane: pieces of it would have the
/// compensation in one of them alone.
bool changes_compensation(const ModalState& state);

/// Whether a move is along Z only.
bool is_along_z(const Move& move);

/// Whether `window`, together with the windows before it, ends with more moves along Z than a contour
/// includes.
bool ends_along_z(const Program& window);

/// Index of the first move before a contour that belongs to it: the moves along Z from `run_begin` on, and
/// the move before them. The number of moves if there is no such move.
std::size_t first_before_contour(const Program& program, std::size_t run_begin);

/// Begins or ends a contour for G40, G41 and G42 of the block, before its move is read.
void apply_cutter(Reading& reading);

/// Adds the last move to its contour.
void join_contour(Reading& reading);

/// Ends the contour.
void end_contour(Reading& reading);

}  // namespace counterflex
