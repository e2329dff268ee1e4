#pragma once
/// Compensates a program that is one window, or verifies one: plans the correction of every move, writes the
/// text, reads it back and solves it forward.
#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/program/program_reader.hpp"

namespace counterflex {

/// Moves that are not corrected each on its own.
struct OtherMoves {
  std::size_t grouped = 0;  ///< with their contour, by one motion in its plane
  std::size_t held = 0;     ///< they keep the correction with which they are entered
  std::size_t in_part = 0;  ///< in some axes, or without their force
  std::size_t left = 0;     ///< they are not changed
};

/// What comes of a window. A failure has exit status, line and what happened: not solved or not within
/// tolerance 5, travel or correction limit 6, too few decimals 2.
struct Compensation {
  std::optional<Failure> failure;   ///< then `text` must not be written
  std::string text;                 ///< the corrected program
  Program corrected;                ///< `text`, read again
  std::vector<Waypoint> waypoints;  ///< of the emitted, rounded text; of windows that are not given out
  std::vector<LeftAlone>
      left_alone;    ///< what the plan could not correct or split, besides the program's own list
  Rewritten counts;  ///< its text is moved to `text`
  std::size_t corrected_moves = 0;  ///< each on its own
  OtherMoves other_moves;
  double largest_correction = 0;  ///< m
  int largest_correction_line = 0;
};

/// With `attribution` each waypoint's deviation is split into its causes.
Compensation compensate(const Job& job, bool attribution);

/// Judges `corrected` by its text alone: matches it with the original and solves it forward. Only failure and
/// waypoints are set.
Compensation verify(const Job& job, const Program& corrected, bool attribution);

/// The failure of words that are written too coarsely for the tolerance (Exit::usage), if there are any.
std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options);

/// The controlled part of a waypoint's `after`: what the tolerance applies to (m).
double position_miss(const Job& job, const Waypoint& w);

/// The failure of the first waypoint that misses the tolerance in a move that the plan corrects (not
/// `exempt`).
std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints);

/// What is left of a tolerance when words are rounded to their digits: half of the last one times sqrt 3 (m).
double rounding_allowance(const Move& move, const WriteOptions& options);

}  // namespace counterflex
