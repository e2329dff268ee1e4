#pragma once
/// The pieces that corrected moves command along the segment of the move that they belong to.
#include "match_moves.hpp"

namespace counterflex {

/// A piece, and whether the fraction at its end is known: it is the segment's, or that of a knot of the plan.
struct DraftPiece {
  Piece piece;
  bool settled = true;
};

/// Makes pieces of matched moves. A point inside a segment that is within the tolerance of a knot of the
/// plan has the knot's fraction. Any other gets the fraction to which it projects: on a line along it, on an
/// arc by its angle about the centre, over all turns; no error of a fraction reaches the next one.
class PieceMaker {
 public:
  PieceMaker(const Job& job, const PlannedWays& ways) : job_(job), ways_(ways) {}

  /// Appends the pieces of moves that have a segment.
  void add(const MatchedMoves& matched, std::vector<DraftPiece>& pieces);

 private:
  // A move of the corrected program, and the fraction at which it ends.
  struct Step {
    Curve way;
    int line = 0;
    double u = -1;  // not yet known
    bool settled = false;
    bool jump = false;
  };

  void read_ways(const MatchedMoves& matched);
  void find_knots(std::span<const Knot> knots);
  // Whether a step from `next` on ends there; `next` goes behind it.
  bool find_knot(const Knot& knot, std::size_t& next);
  bool find_jump(const Knot& knot, std::size_t& next);
  void project(const Curve& wanted);

  const Job& job_;
  const PlannedWays& ways_;
  std::vector<Step> steps_;  // of one move; the room is used again
};

/// The fraction of an inserted point is that of the place of the tip along the segment,
/// found from the projected one by Newton's method. A jump of the correction at the start of a segment, and
/// what goes backwards, gives no piece: what follows begins where it ends, and is judged from there on.
std::vector<Piece> refined(const Job& job, std::vector<DraftPiece> drafts);

}  // namespace counterflex
