#pragma once
/// What becomes of an arc when it is written: its centre words, and the curve that a control reads.
#include "program/write/held_position.hpp"

namespace counterflex {

struct ArcWords {
  std::array<WordNumber, 3> centre;  ///< I J K, of the plane's axes; none where the block gives the radius
  WordNumber radius;                 ///< R where the block has it
  Curve curve;                       ///< as it is read back, program coordinates, mm
};

/// Whether `axis` lies in the arc's plane.
inline bool in_plane(const ArcMove& arc, std::size_t axis) {
  return axis != static_cast<std::size_t>(arc.normal);
}

/// What a control reads of the polar words of the arc `move` from `start` about a pole at `centre_mm`.
Curve polar_arc(const Move& move, const Vector3& start, const Vector3& centre_mm);

/// The words of a piece of the arc `move` from `start` to `end`, as the text holds them, towards `via`, which
/// has a centre. Nothing where the digits leave no arc: start and end have become one point, or changed
/// places, and a control would read a full turn.
std::optional<ArcWords> settle_arc(const Move& move, const Vector3& start, const Vector3& end, const Via& via,
                                   Place place, const WriteOptions& options);

}  // namespace counterflex
