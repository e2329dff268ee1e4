#pragma once
/// Pairs the moves of a corrected program, as its text is read, with those of the original: what `verify`
/// and the verification inside `compensate` solve. Nothing of how the text was written is known here.
#include <optional>
#include <vector>

#include "compensation/match/corrected_moves.hpp"
#include "compensation/plan/plan.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// How a plan leads a segment. It distinguishes the end of a move from points that were inserted before it,
/// and where along the segment such a point belongs.
struct PlannedWay {
  std::optional<Vector3> end;  ///< M (m); nothing where the plan does not correct the segment by itself
  std::vector<Knot> inner;     ///< before the end, in order; a step is two knots at one fraction
  double bend = 0;  ///< of an arc: how far its correction leaves the straight line between its ends (m)
};
using PlannedWays = std::vector<PlannedWay>;
PlannedWays planned_ways(const Job& job, const Plan& plan);

/// What is paired with what is still to be written down.
struct Matching {
  std::vector<Piece> pieces;
  std::optional<Failure> failure;  ///< names the lines of both programs
};

/// The pieces that the next moves of `found` command along the moves of a window; these are dropped from
/// `found`. `lines`: of the original, up to this window. A failure is a move that has no counterpart, one of
/// another kind, sense or number of turns, or another line that differs.
Matching match_window(const Job& job, const PlannedWays& ways, OtherLines& lines, CorrectedMoves& found);

/// Behind the last window: the failure of what is left over in either program.
std::optional<Failure> match_end(OtherLines& lines, CorrectedMoves& found);

}  // namespace counterflex
