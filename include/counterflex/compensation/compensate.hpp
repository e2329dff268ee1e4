#pragma once
/// Compensates a program: plans the correction of every move, writes the text, reads it back and solves it
/// forward.
#include <memory>

#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/program/program_reader.hpp"

namespace counterflex {

/// Moves that are not corrected each on its own.
struct OtherMoves {
  std::size_t grouped = 0;  ///< with their contour, by one motion in its plane
  std::size_t held = 0;     ///< they keep the correction with which they are entered
  std::size_t in_part = 0;  ///< in some axes, or without their force
  std::size_t left = 0;     ///< they stay as they are
};

struct Compensation {
  std::optional<Failure> failure;   ///< then `text` must not be written
  std::string text;                 ///< the corrected program
  Program corrected;                ///< `text`, read anew
  std::vector<Waypoint> waypoints;  ///< of the emitted, rounded text, read anew
  std::vector<LeftAlone>
      left_alone;    ///< what the plan could not correct or split, besides the program's own list
  Rewritten counts;  ///< its text is moved to `text`
  std::size_t corrected_moves = 0;  ///< each on its own
  OtherMoves other_moves;
  double largest_correction = 0;  ///< m
  int largest_correction_line = 0;
};

/// Compensates a program window by window: what `counterflex compensate` does between reading and writing.
class Compensator {
 public:
  /// `corrected` reads the text that is written. With `attribution` each waypoint's deviation is split into
  /// its sources.
  Compensator(const WriteOptions& write, TextReader corrected, bool attribution);
  ~Compensator();
  Compensator(Compensator&&) noexcept;

  /// The next window: `job` holds its program, path and forces. A failure says exit status, line and what
  /// happened: not solved or not within tolerance 5, travel or correction limit 6, too few decimals 2; the
  /// windows behind it cannot be compensated then.
  Compensation next(const Job& job);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Compensates a program that is one window.
Compensation compensate(const Job& job, bool attribution);

/// The failure of words that are written too coarsely for the tolerance (Exit::usage), if there are any.
std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options);

/// The controlled part of a waypoint's `after`: what the tolerance applies to (m).
double position_miss(const Job& job, const Waypoint& w);

/// The first waypoint that misses the tolerance in a move that the plan corrects (not `exempt`), in words.
std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints);

/// A line of the report: what is left of a tolerance when words are rounded to their digits, half the last
/// one times sqrt 3 (m).
double rounding_allowance(const Move& move, const WriteOptions& options);

}  // namespace counterflex
