#pragma once
/// Pairs the moves of a corrected program, as its text is read, with those of the original: what `verify`
/// and the verification inside `compensate` solve. Nothing of how the text was written is known here.
#include <array>
#include <optional>
#include <span>
#include <string>
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

// Which moves of a corrected program belong to one of the original, what is compared with it, and the pieces
// that they command.

/// A move of the original, the segment that it gives, and the moves of the corrected program that command it.
struct MatchedMoves {
  const Move& original;
  std::optional<std::size_t> segment;
  std::span<const CorrectedMove> found;  ///< the last one holds the block of the original, or its last piece
  std::string words;                     ///< of the original, as CorrectedMove::words
  double start_rounding = 0;             ///< of the move before, as read (m); 0 for the first of a window

  const Move& first() const { return *found.front().move; }
  const Move& last() const { return *found.back().move; }

  /// Of the last move, or of another line of the corrected program.
  Failure failure(std::string what) const { return failure_at(last().line, std::move(what)); }
  Failure failure_at(int corrected_line, std::string what) const {
    return {ErrorKind::not_compensated, original.line, std::move(what), corrected_line};
  }
};

/// Whether fractions of a segment are found by its turn: it has no way, or one of which rounding and what
/// remains of the tolerance are too large a part.
bool is_found_by_turn(const Segment& segment);

/// Knots of the plan before the end of a segment, in order. `first`: the first corrected move along it.
std::vector<Knot> inner_knots(const Job& job, const Plan& plan, std::size_t s, const Move& first);

/// Finds them, move by move. Inserted blocks come before the block that they split, follow its path, and hold
/// motion, axes and F.
class MoveFinder {
 public:
  MoveFinder(const Job& job, const Plan& plan, CorrectedMoves& found)
      : job_(job), plan_(plan), found_(found) {}

  /// Those of move `m`, which is at `place`; `found` is empty if no move matches. They begin at the first
  /// move that was not dropped, and are valid until more is read or dropped.
  MatchedMoves find(std::size_t m, std::optional<std::size_t> segment, const PlaceAmongLines& place);

 private:
  std::size_t count(const MatchedMoves& matched, std::size_t most, std::size_t others);
  std::size_t count_behind(const MatchedMoves& matched, std::size_t first, std::size_t others,
                           const Vector3& end_mm, double near_mm);
  Vector3 expected_end_mm(const Move& original, const std::optional<Vector3>& planned_mm) const;
  std::optional<OrientationNumbers> expected_turn(const MatchedMoves& matched) const;
  std::optional<Vector3> planned_shift_mm(const Move& original, std::optional<std::size_t> segment) const;

  const Job& job_;
  const Plan& plan_;
  CorrectedMoves& found_;
  std::optional<Vector3> shift_mm_;          // of the move before
  double rounding_mm_ = 0;                   // of that shift, as it was read
  std::optional<Vector3> planned_shift_mm_;  // the same, as it was planned
  std::size_t frame_ = 0;                    // of the move before
  std::optional<long> next_number_;          // N of the next original
};

/// Whether matched moves go as the original, rapid, line or arc, in its plane, sense and number of turns: the
/// failure of the first that does not. Chords of an arc are right where they follow it within the tolerance.
/// Also the failure of moves that no piece judges and that are shifted by more than a correction may.
std::optional<Failure> kind_failure(const Job& job, const Plan& plan, const MatchedMoves& matched);

/// What an inserted block, or a piece of the original's block, must not hold; nothing where all is right.
std::optional<Failure> words_failure(const Job& job, const MatchedMoves& matched);

/// What the moves of a window inherit from those before them (program coordinates, mm).
struct CarriedShifts {
  std::array<std::optional<double>, 3> axes_mm{};  ///< by axis, of the last word in these coordinates
  double height_mm = 0;                            ///< of the last height that is known
};

/// Both programs must set the coordinates of their moves alike, and keep external axes at the same values.
std::optional<Failure> frame_failure(const Job& job, const MatchedMoves& matched);

/// The first failure of move `m`: the heights of a cycle, axes, contours and corners must be shifted alike.
/// Updates `carried`.
std::optional<Failure> shift_failure(const Job& job, std::size_t m, const MatchedMoves& matched,
                                     CarriedShifts& carried);

/// The last move before those that are matched.
struct ZoneBefore {
  double length_mm = 0;  ///< 0: it has no zone that corrections change
  Vector3 end_mm = Vector3::Zero();
  int line = 0;
  /// Its zone became smaller though no point was inserted before it: then the next move must have one.
  std::optional<Failure> smaller{};
};

/// The failure of a zone that is not the original's, or that reaches over the middle between its target and
/// one that was inserted beside it. Updates `before`: at the end of a window its `smaller` is a failure.
std::optional<Failure> zone_failure(const Job& job, const MatchedMoves& matched, ZoneBefore& before);

/// A piece, and whether the fraction at its end is known: it is the segment's, or that of a knot of the plan.
struct DraftPiece {
  Piece piece;
  bool settled = true;
};

/// Appends the pieces of matched moves that have a segment. A point inside a segment that rounds to a
/// knot of the plan has the knot's fraction. Any other gets the fraction to which it projects:
/// on a line along it, on an arc by its angle about the centre, over all turns, in a segment that
/// `is_found_by_turn` by its turn; no error of a fraction reaches the next one.
void add_pieces(const Job& job, const Plan& plan, const MatchedMoves& matched,
                std::vector<DraftPiece>& pieces);

/// The fraction of an inserted point is that of the place, or of the turn, of the tip along the segment,
/// found from the projected one by Newton's method. A jump of the correction, and what goes backwards, gives
/// no piece: what follows begins where it ends, and is judged from there on. Of several in a row those behind
/// the first are judged, too, where they do not begin at a knot of the plan.
std::vector<Piece> refined(const Job& job, std::vector<DraftPiece> drafts);

}  // namespace counterflex
