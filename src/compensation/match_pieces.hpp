#pragma once
/// The pieces that corrected moves command along the segment of the move that they belong to.
#include "counterflex/compensation/waypoint.hpp"
#include "path_solver.hpp"

namespace counterflex {

/// Where compensation would have put the tip: what tells pieces and jumps from each other. Solved when asked
/// for.
class ExpectedTargets {
 public:
  explicit ExpectedTargets(const Job& job) : job_(job), solvers_(job) {}

  /// The target (M, m) at fraction `u` of a segment, with the force on that side of a step; nothing where
  /// there is none.
  std::optional<Vector3> at(std::size_t segment, double u, Side side);

 private:
  const Job& job_;
  ToolSolver solvers_;
};

/// The moves of the corrected program that belong to one of the original.
struct MatchedMoves {
  std::size_t segment;      ///< of the original
  std::size_t first, last;  ///< indices into the corrected program's moves
};

/// Appends the pieces that `found` commands. Points on the way get fractions by the length of the way to
/// them: `refine_fractions` finds the true ones. A jump of the correction gives no piece: what it passes
/// through is judged by nobody, what follows begins where it ends.
void add_pieces(const Job& job, const Program& corrected, const MatchedMoves& found,
                ExpectedTargets& expected, std::vector<Piece>& pieces);

/// An inserted point stands where it puts the tip: its fraction is that of the tip's place along the segment.
void refine_fractions(const Job& job, std::vector<Piece>& pieces);

/// Takes out pieces that are too short for a fraction of their own.
void drop_jumps(const Job& job, std::vector<Piece>& pieces);

/// The way of a move of the corrected program as targets in M (m); one whose start is unknown begins at
/// `from`.
Curve commanded_by(const Job& job, const Program& corrected, std::size_t move, const Vector3& from);

}  // namespace counterflex
