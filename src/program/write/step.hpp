#pragma once
/// One point that the written text comes to: its words, and where the tool then is.
#include "program/write/held_arc.hpp"

namespace counterflex {

struct Step {
  Step() = default;
  /// `settled(axis)` is the coordinate of each axis.
  template <typename SettleAxis>
  Step(Place at, int under, const HeldPosition& from, const SettleAxis& settled)
      : place(at), motion(under), axes{settled(0), settled(1), settled(2)} {
    assign(before, from);
  }

  Place place = Place::end;
  int motion = 1;  ///< G0, G1, G2 or G3
  std::array<Coordinate, 3> axes;
  HeldPosition before, after;
  std::optional<ArcWords> arc;
};

/// G0, G1, G2 or G3 of `move`.
int motion_of(const Move& move);

/// The step from `before` to `via` under `motion`, which is G1 where an arc has no centre or the digits leave
/// nothing of it.
Step settle_step(const Move& move, const HeldPosition& before, const Via& via, int motion, Place place,
                 const WriteOptions& options);

/// Whether the text holds the point already: no block needs to be inserted for it.
bool is_there(const Step& step);

/// Whether a word of the block must be changed or inserted for `step`.
bool says_anew(const Step& step);

/// The way of `step`; an axis that is unknown counts as zero.
Curve curve_of_step(const Step& step);

}  // namespace counterflex
