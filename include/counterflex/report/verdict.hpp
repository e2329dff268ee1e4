#pragma once
/// The verdict of a run: one word for all feed moves of a program, and what it is derived from.
#include <cstddef>
#include <string>
#include <string_view>

namespace counterflex {

enum class Verdict {
  ok,                 ///< every feed move that was read is within the tolerance (`predict`: was solved)
  partly,             ///< some feed moves miss the tolerance, or their deviation is unknown
  nothing_corrected,  ///< no feed move was corrected, or the program has no move
  failed,             ///< the run stopped: a target was not solved, a limit exceeded, a corrected move missed
};

/// "OK", "PARTLY", "NOTHING CORRECTED", "FAILED".
std::string_view to_string(Verdict verdict);

/// The feed moves of a program, by what a run knows of them: lines, arcs, holes of cycles (which
/// have no length) and blocks that are not followed and may cut, as calls that are not expanded. A move that
/// goes nowhere does not count.
struct FeedMoves {
  std::size_t count = 0;           ///< all that were read
  std::size_t within = 0;          ///< every place that was solved is within the tolerance
  std::size_t missed = 0;          ///< some place is not
  std::size_t unknown = 0;         ///< the deviation is not known
  std::size_t unknown_length = 0;  ///< of `unknown`: the length is not known either
  std::size_t known_ends = 0;      ///< of `unknown`: the end was corrected
  double length_mm = 0;            ///< of all moves whose length is known
  double within_mm = 0;            ///< of it, pieces that are within the tolerance everywhere
  double worst_mm = 0;             ///< largest deviation of the controlled position
  int worst_line = 0;              ///< 0: nothing was solved
  std::size_t rapid_ends = 0;      ///< ends of rapids that were solved
};

/// Of a run that did not fail.
Verdict verdict_of(const FeedMoves& moves);

/// "54 % of the cutting length, worst 0.0095 mm > 0.005, 12 feed moves of unknown length": why a run is
/// `partly`.
std::string partly_reason(const FeedMoves& moves, double tolerance_mm);

/// "OK", or "PARTLY (REASON)".
std::string verdict_text(Verdict verdict, std::string_view reason);

}  // namespace counterflex
