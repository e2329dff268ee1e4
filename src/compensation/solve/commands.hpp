#pragma once
/// Positions in the words of a program, what they command, and where they are lost.
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// A target (M, m) in the program coordinates of a move (mm): what words should express.
Vector3 in_words_mm(const Job& job, const Move& move, const Vector3& target);

/// The position (M, m) that words of a move command (program coordinates, mm).
Vector3 position_of_words(const Job& job, const Move& move, const Vector3& words_mm);

/// What the original program commands (M, m) where the tip is wanted at `p_MT`; `frame`: index into
/// Toolpath::frames.
Vector3 original_command(const Job& job, std::size_t frame, const Vector3& p_MT);

/// The end of a move as a target in M (m).
Vector3 target_of(const Job& job, const Move& move);

/// The way of a move whose start is known, as targets in M (m).
Curve command_of(const Job& job, const Move& move);

/// The orientation in M that the program gives at the end of a move, if it gives one.
std::optional<Matrix3> orientation_of(const Job& job, const Move& move);

/// How a move turns the tool, in M, if the program gives orientations.
std::optional<Turn> turn_of(const Job& job, const Move& move);

/// The numbers of the move's words that turn the tool at fraction `u` by the rotation vector `turn` (rad,
/// axes of M) against the original; none where the move gives no orientation.
std::optional<OrientationNumbers> turned_words(const Job& job, const Move& move, double u,
                                               const Vector3& turn);

/// The end of a move of the original as a wanted position in M (m).
Vector3 wanted_of(const Job& job, const Move& move);

/// The place of the hole that a move drills, in program coordinates (mm): its bottom, or where it is called.
/// Of several holes the last one.
Vector3 hole_of(const Move& move);

/// Whether R decides at which height the tool goes to a hole: LinuxCNC goes at the height where the series
/// began if R is not below the tool, else at that of the tool. This matters under G98 behind a hole under
/// G99.
bool chooses_height_by_retract(const Program& program, const Move& hole);

/// Whether R is not below the tool, and must not be in the text: it decides that height, or LinuxCNC leaves
/// the tool at R under G98 as under G99. The program may have left the choice of these to the control.
bool keeps_retract_above_tool(const Program& program, const Move& hole);

/// Whether R is not below the height where the series began: under G98, too, the tool is left at R.
bool leaves_at_high_retract(const Move& hole);

/// The piece of the hole of a cycle at fraction `u` of its move (`fractions_of_holes`). `found` commands it:
/// the same move, or the one that was written for it.
Piece piece_of_hole(const Job& job, const Move& original, const Move& found, double u);

/// The piece of a position that is reached from one that is not known. `found` commands it, as above.
Piece piece_of_end(const Job& job, const Move& original, const Move& found);

/// The wanted place at fraction `u` of the segment of a piece, or of one without a segment: of a hole at
/// fraction `u` of its move.
TipPosition wanted_at(const Job& job, const Piece& piece, double u, const Model& model);

}  // namespace counterflex
