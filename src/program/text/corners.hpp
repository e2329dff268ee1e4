#pragma once
/// Corners that a control rounds or breaks: RND and CHF of Klartext, ",R" and ",C" of shop controls, RND=,
/// CHR= and CHF= of Sinumerik.
#include "counterflex/program/program.hpp"

namespace counterflex {

enum class CornerKind {
  round,    ///< by its radius
  side,     ///< a chamfer by what it takes off both sides
  chamfer,  ///< a chamfer by its own length
};

struct CornerSize {
  double mm = 0;  ///< NaN: not a plain number
  CornerKind kind = CornerKind::round;
};

/// A corner follows the move, one precedes it. How much they take off is not known yet.
void expect_corner_behind(Move& move);
void expect_corner_before(Move& move);

/// Says to two moves, one right after the other, what the corner between them takes off, where both are lines
/// in a plane across Z and the size is a number.
void place_corner(const CornerSize& size, Move& before, Move& after);

}  // namespace counterflex
