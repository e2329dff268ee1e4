#pragma once
/// Blocks that are not followed and count as feed moves.
#include "counterflex/program/program.hpp"

namespace counterflex {

/// Whether the motion of a block that is not computed may cut: a call, or in Klartext a cycle that moves Z.
/// Rapids to three variables look the same and count, too, so that no cut is missed.
inline bool may_cut(const Move& move, const Program& program) {
  if (program.dialect == "heidenhain" && move.fixed[2]) return true;
  return move.fixed[0] && move.fixed[1] && move.fixed[2];
}

}  // namespace counterflex
