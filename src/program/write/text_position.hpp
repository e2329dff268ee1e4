#pragma once
/// A coordinate of a written point: kept, or rounded to the digits of its word.
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// Digits of the numbers of a quaternion: half of the last one turns the tool by 1e-5 deg or
/// less.
inline constexpr int quaternion_decimals = 7;

/// The number of a length word in the written text.
struct WordNumber {
  bool write = false;  ///< changed or inserted
  double value = 0;    ///< as a control reads it, in the move's unit
  int decimals = 0;    ///< digits to write
};

/// A coordinate of a point, and its word.
struct Coordinate {
  WordNumber number;
  std::optional<double> position_mm;  ///< position of the axis in the text afterwards
};

/// The block of a point.
enum class Place {
  end,         ///< the block itself, or an inserted block, at the end of the move
  own_inside,  ///< the block itself, on the path: inserted blocks follow
  inside       ///< an inserted block on the path
};

/// The number of `word`, which has the value `original`, for the value `wanted` (both in the move's unit). It
/// is kept if it is within half its last digit. Without a word: the number of a word to insert.
WordNumber round_number(const Move& move, const PackedAxisWord& word, double original, double wanted,
                        Place place, const WriteOptions& options);

/// The number in `word`, in the move's unit, computed from its length.
double shown_number(const Move& move, const AxisWord& word, double length_mm);

/// Coordinate `axis` of a point of `move` for `wanted_mm`, with the tool at `before`.
Coordinate round_axis(const Move& move, std::size_t axis, const TextPosition& before, double wanted_mm,
                      Place place, const WriteOptions& options);

/// The number `i` of the orientation at a point of a move that turns the tool, for `wanted`.
WordNumber round_angle(const Move& move, std::size_t i, const TextPosition& before, double wanted,
                       Place place);

/// `before` without the axes that are unknown at the start of `move`.
TextPosition known_text_position(const Move& move, const TextPosition& before);

/// The position in the text after `move`, which is not edited.
TextPosition text_position_after_original(const Move& move, const TextPosition& before);

/// Makes the axes of a skippable block unknown: the text does not show whether it has moved them.
void forget_skippable(const Move& move, const TextPosition& before, TextPosition& position);

/// `to = from`, value and flag separately: a copy of both at once would wait for the stores before it.
inline void assign(std::optional<double>& to, const std::optional<double>& from) {
  if (from)
    to = *from;
  else
    to.reset();
}
inline void assign(TextPosition& to, const TextPosition& from) {
  for (std::size_t axis = 0; axis < 3; ++axis) assign(to[axis], from[axis]);
  assign(to.cycle_initial_mm, from.cycle_initial_mm);
  if (to.orientation || from.orientation) to.orientation = from.orientation;
}

/// Component `axis` of `p`.
inline double component(const Vector3& p, std::size_t axis) {
  return p[static_cast<Eigen::Index>(axis)];
}

}  // namespace counterflex
