#pragma once
/// How a constant shift moves commands.
#include "counterflex/compensation/constant_shift.hpp"

namespace counterflex {

/// The motion of the command of a segment of the path by the radius of the cutter: away from the contour.
/// From zero where a contour is approached, and to zero where it is left. Unit, axes of M.
Vector3 away_from_contour(const Job& job, std::size_t segment, double u);

/// The change of a length or radius of a tool (m): 0 where it has none.
double length_of(const std::map<long, double>& lengths, long tool);

/// The tool's axis where the program does not turn the tool: from tip to spindle, unit, axes of M.
Vector3 tool_axis_at_home(const Model& model);

/// What `pieces` of the original program command with `shift` in effect.
void shift_pieces(const Job& job, const ConstantShift& shift, std::vector<Piece>& pieces);

}  // namespace counterflex
