#pragma once
/// The pieces that corrected moves command along the segment of the move that they belong to.
#include "compensation/match/match_moves.hpp"

namespace counterflex {

/// A piece, and whether the fraction at its end is known: it is the segment's, or that of a knot of the plan.
struct DraftPiece {
  Piece piece;
  bool settled = true;
};

/// Appends the pieces of matched moves that have a segment. A point inside a segment that is within the
/// tolerance of a knot of the plan has the knot's fraction. Any other gets the fraction to which it projects:
/// on a line along it, on an arc by its angle about the centre, over all turns; no error of a fraction
/// reaches the next one.
void add_pieces(const Job& job, const PlannedWays& ways, const MatchedMoves& matched,
                std::vector<DraftPiece>& pieces);

/// The fraction of an inserted point is that of the place of the tip along the segment,
/// found from the projected one by Newton's method. A jump of the correction at the start of a segment, and
/// what goes backwards, gives no piece: what follows begins where it ends, and is judged from there on.
std::vector<Piece> refined(const Job& job, std::vector<DraftPiece> drafts);

}  // namespace counterflex
