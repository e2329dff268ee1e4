#pragma once
/// Pairs the moves of a corrected program, as its text is read, with those of the original: what `verify`
/// and the verification inside `compensate` solve. Nothing of how the text was written is known here.
#include <optional>
#include <vector>

#include "compensation/match/corrected_moves.hpp"
#include "compensation/plan/plan.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// What is paired with what is still to be written down.
struct Matching {
  std::vector<Piece> pieces;
  std::optional<Failure> failure;  ///< names the lines of both programs
  /// Moves of the original that are corrected on their own, have no piece since they end at a place that is
  /// not known in all axes or do not move, and end elsewhere in the corrected program.
  std::size_t changed_without_piece = 0;
};

/// The pieces that the next moves of `found` command along the moves of a window; these are dropped from
/// `found`. `plan` has a segment for each of the path: it distinguishes the end of a move from points that
/// were inserted before it, and has where along the segment such a point belongs. `lines`: of the original,
/// up to this window. A failure is a move that has no counterpart, one of another kind, sense or number of
/// turns, another line that differs, or a guard in `found` that is not `WriteOptions::guard` of the job with
/// one of `window_steps_mm`.
Matching match_window(const Job& job, const Plan& plan, OtherLines& lines, CorrectedMoves& found);

/// Behind the last window: the failure of what is left over in either program.
std::optional<Failure> match_end(OtherLines& lines, CorrectedMoves& found);

}  // namespace counterflex
