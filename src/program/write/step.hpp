#pragma once
/// A point of the written text: its words, and the position of the tool after it.
#include "program/write/text_arc.hpp"

namespace counterflex {

struct Step {
  Step() = default;
  /// `axis_coordinate(axis)` is the coordinate of each axis.
  template <typename RoundAxis>
  Step(Place at, int under, const TextPosition& from, const RoundAxis& axis_coordinate)
      : place(at), motion(under), axes{axis_coordinate(0), axis_coordinate(1), axis_coordinate(2)} {
    assign(before, from);
  }

  Place place = Place::end;
  int motion = 1;  ///< G0, G1, G2 or G3
  std::array<Coordinate, 3> axes;
  std::array<WordNumber, 4> angles{};  ///< of a move that turns the tool, by number
  TextPosition before, after;
  std::optional<ArcWords> arc;
};

/// G0, G1, G2 or G3 of `move`.
int motion_of(const Move& move);

/// The step from `before` to `via` under `motion`. An arc without a centre, or without a sweep after
/// rounding, becomes G1.
Step round_step(const Move& move, const TextPosition& before, const Via& via, int motion, Place place,
                const WriteOptions& options);

/// Whether the point equals the position in the text, so that no block is inserted for it.
bool equals_text_position(const Step& step);

/// Whether a word of the block must be changed or inserted for `step`.
bool writes_words(const Step& step);

/// The path of `step`; an unknown axis counts as zero.
Curve curve_of_step(const Step& step);

}  // namespace counterflex
