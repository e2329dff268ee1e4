#pragma once
/// Compensates a program: plans the correction of every move, writes the text, reads it back and solves it
/// forward.
#include "counterflex/compensation/waypoint.hpp"

namespace counterflex {

struct Compensation {
  std::optional<Failure> failure;   ///< then `text` must not be written
  std::string text;                 ///< the corrected program
  Program corrected;                ///< `text`, read anew
  std::vector<Waypoint> waypoints;  ///< of the emitted, rounded text, read anew
  std::vector<LeftAlone>
      left_alone;    ///< what the plan could not correct or split, besides the program's own list
  Rewritten counts;  ///< its text is moved to `text`
  std::size_t corrected_moves = 0;
  double largest_correction = 0;  ///< m
  int largest_correction_line = 0;
};

/// The whole of `counterflex compensate` between reading and writing. A failure says exit status, line and
/// what happened: not solved or not within tolerance 5, travel or correction limit 6, too few decimals 2.
/// With `attribution` each waypoint's deviation is split into its sources.
Compensation compensate(const Job& job, bool attribution);

/// Pairs the moves of a corrected program with the segments of the original path: the pieces that `verify`
/// solves. Throws `InputError` (Exit::not_compensated) where a move has no counterpart.
std::vector<Piece> match_programs(const Job& job, const Program& corrected);

/// The first waypoint whose `after` misses the tolerance, said in words.
std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints);

/// A line of the report: what is left of a tolerance when words are rounded to their digits, half the last
/// one times sqrt 3 (m).
double rounding_allowance(const Move& move, const WriteOptions& options);

}  // namespace counterflex
