#pragma once
/// What becomes of one coordinate when a point is written: kept, or written and then read back.
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// The number of one length word as it stands in the written text.
struct WordNumber {
  bool write = false;  ///< changed, or to be inserted
  double value = 0;    ///< as a control reads it, in the move's unit
  int decimals = 0;    ///< digits to write it with
};

/// A coordinate of a point, and the word that says it.
struct Coordinate {
  WordNumber number;
  std::optional<double> held_mm;  ///< where the text holds the axis afterwards
};

/// Whose words come to a point.
enum class Place {
  end,         ///< the block's own, or an inserted block's that ends the move
  own_inside,  ///< the block's own on the way: the rest follows in inserted blocks
  inside       ///< an inserted block's on the way
};

/// The number of `word`, which shows `original`, when `wanted` is to be said (both in the move's unit): kept
/// where it is within half its last digit. Without a word: that of one to be inserted.
WordNumber settle_number(const Move& move, const PackedAxisWord& word, double original, double wanted,
                         Place place, const WriteOptions& options);

/// The number that `word` shows, in the move's unit, from the length that was read from it.
double shown_number(const Move& move, const AxisWord& word, double length_mm);

/// Coordinate `axis` of a point of `move`, wanted at `wanted_mm`, with the tool at `before`.
Coordinate settle_axis(const Move& move, std::size_t axis, const HeldPosition& before, double wanted_mm,
                       Place place, const WriteOptions& options);

/// `before` without the axes that the program does not know at the start of `move`.
HeldPosition held_at_start(const Move& move, const HeldPosition& before);

/// What the text holds after `move` where it is not edited.
HeldPosition held_after_original(const Move& move, const HeldPosition& before);

/// Whether a skippable block or a piece of it has moved an axis, the text does not tell: forgets it.
void doubt_skippable(const Move& move, const HeldPosition& before, HeldPosition& held);

/// `to = from`, the number and whether there is one each on its own: copied as a whole, they would be waited
/// for where both have just been set.
inline void assign(std::optional<double>& to, const std::optional<double>& from) {
  if (from)
    to = *from;
  else
    to.reset();
}
inline void assign(HeldPosition& to, const HeldPosition& from) {
  for (std::size_t axis = 0; axis < 3; ++axis) assign(to[axis], from[axis]);
  assign(to.cycle_initial_mm, from.cycle_initial_mm);
}

/// Component `axis` of `p`.
inline double component(const Vector3& p, std::size_t axis) {
  return p[static_cast<Eigen::Index>(axis)];
}

}  // namespace counterflex
