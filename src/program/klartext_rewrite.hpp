#pragma once
/// Writes corrected Klartext.
#include "counterflex/program/rewrite.hpp"
#include "program/klartext_block.hpp"

namespace counterflex {

/// As `Rewriter::write`, for a window of a program in Klartext; the `first` one has the header. Where its blocks are
/// numbered and one is inserted, those from the window's begin on are numbered without gaps.
Rewritten rewrite_klartext(const Program& window, const std::vector<MoveEdit>& edits, const KlartextStyle& style,
                           bool first, const WriteOptions& options, TextState& state);

}  // namespace counterflex
