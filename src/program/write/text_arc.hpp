#pragma once
/// The written words of an arc, and the curve that a control reads from them.
#include "program/write/text_position.hpp"

namespace counterflex {

struct ArcWords {
  /// I J K of the plane's axes, or X Y Z of the auxiliary point; not set if the block has a radius.
  std::array<WordNumber, 3> centre;
  WordNumber radius;  ///< R of the block
  Curve curve;        ///< as read back, program coordinates, mm
};

/// Whether `axis` lies in the arc's plane.
inline bool in_plane(const ArcMove& arc, std::size_t axis) {
  return axis != static_cast<std::size_t>(arc.normal);
}

/// The curve that a control reads from the polar words of the arc `move` from `start` about a pole at
/// `centre_mm`.
Curve polar_arc(const Move& move, const Vector3& start, const Vector3& centre_mm);

/// The words of a piece of the arc `move` from `start` to `end` in the text, towards `via`, which has a
/// centre. Empty if rounding leaves no arc: start and end coincide or are swapped, and a control would read a
/// full turn.
std::optional<ArcWords> round_arc(const Move& move, const Vector3& start, const Vector3& end, const Via& via,
                                  Place place, const WriteOptions& options);

}  // namespace counterflex
