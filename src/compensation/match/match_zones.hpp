#pragma once
/// Zones of robots: how far from a target the control may leave the path.
#include <optional>

#include "compensation/match/match_moves.hpp"

namespace counterflex {

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

}  // namespace counterflex
