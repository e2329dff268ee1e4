#pragma once
/// The way that a control puts into a corner: the arc of a rounding, or the line of a chamfer.
#include <optional>

#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/move.hpp"

namespace counterflex {

/// From a point of `before` to one of `after`, which begins where `before` ends. `size` is in the unit of the
/// curves. Nothing where the curves do not form a corner, or where it does not fit on both.
std::optional<Curve> corner_way(const Curve& before, const Curve& after, CornerKind kind, double size);

/// A wanted way, and what is commanded for it: M (m).
struct WantedAndCommanded {
  Curve wanted, commanded;
};

/// What the control puts into a wanted corner, and into the one that is commanded for it. Where the size is
/// not known or does not fit, it is nearly the largest one that fits: beside a corner the correction changes
/// almost linearly, and what the corner misses then grows with its size.
std::optional<WantedAndCommanded> corner_ways(const WantedAndCommanded& before,
                                              const WantedAndCommanded& after, const CornerSize& size);

}  // namespace counterflex
