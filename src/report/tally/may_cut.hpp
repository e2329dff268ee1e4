#pragma once
/// What is not judged and counts as feed moves.
#include "counterflex/program/program.hpp"

namespace counterflex {

/// Whether the motion of a block that is not computed may cut: a call, or in Klartext a cycle that moves Z.
/// Rapids to three variables look the same and count, too, so that no cut is missed.
inline bool may_cut(const Move& move, const Program& program) {
  if (program.dialect == "heidenhain" && move.fixed[2]) return true;
  return move.fixed[0] && move.fixed[1] && move.fixed[2];
}

/// Whether a window ends at a corner, whose rounding or chamfer is not judged then.
inline bool parts_corner(const Program& window) {
  return window.after && !window.moves.empty() && window.moves.back().corners &&
         window.moves.back().corners->end_mm > 0;
}

}  // namespace counterflex
