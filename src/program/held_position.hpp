#pragma once
/// What becomes of one coordinate when a point is written: kept, or written and then read back.
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

struct Coordinate {
  bool write = false;             ///< a word is changed or inserted
  double value = 0;               ///< to be written, in the move's unit
  std::optional<double> held_mm;  ///< where the text holds the axis afterwards
};

/// Coordinate `axis` of the end of `move`, wanted at `wanted_mm`, with `held_mm` before the move.
Coordinate settle_end(const Move& move, std::size_t axis, std::optional<double> held_mm, double wanted_mm,
                      int decimals);

/// Coordinate `axis` of a point in an inserted block.
Coordinate settle_inserted(const Move& move, std::size_t axis, std::optional<double> held_mm,
                           double wanted_mm, int decimals);

/// `before` without the axes that the program does not know at the start of `move`.
HeldPosition held_at_start(const Move& move, HeldPosition before);

/// What the text holds after `move` where it is not edited.
HeldPosition held_after_original(const Move& move, const HeldPosition& before);

}  // namespace counterflex
