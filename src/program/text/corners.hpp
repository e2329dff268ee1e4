#pragma once
/// Corners that a control rounds or chamfers: RND and CHF of Klartext, ",R" and ",C" of shop controls, RND=,
/// CHR= and CHF= of Sinumerik.
#include "counterflex/program/program.hpp"

namespace counterflex {

/// Marks a corner behind or before the move. Its length is unknown yet.
void expect_corner_behind(Move& move);
void expect_corner_before(Move& move);

/// Sets the length that the corner between two consecutive moves removes from each of them, if both are lines
/// in a plane across Z and the size is a number; keeps the size.
void place_corner(const CornerSize& size, Move& before, Move& after);

}  // namespace counterflex
