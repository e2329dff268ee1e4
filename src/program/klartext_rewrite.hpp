#pragma once
/// Writes corrected Klartext.
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// As `rewrite`, for a program in Klartext. Where its blocks are numbered and blocks are added, all are
/// numbered anew without gaps.
Rewritten rewrite_klartext(const Program& program, const std::vector<MoveEdit>& edits,
                           const WriteOptions& options);

}  // namespace counterflex
