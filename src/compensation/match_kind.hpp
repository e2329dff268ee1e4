#pragma once
/// Whether matched moves go as the original: rapid, line or arc, in its plane, sense and number of turns.
#include "match_moves.hpp"

namespace counterflex {

/// The first that does not. Chords of an arc are right where they follow it within the tolerance. Also the
/// failure of moves that no piece judges and that are shifted by more than a correction may.
std::optional<Failure> kind_failure(const Job& job, const MatchedMoves& matched);

}  // namespace counterflex
