#pragma once
/// Arcs that are programmed by a radius.
#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// The centre, at the height of `start`, of the arc from `start` to `end` around `normal` (a unit vector; the
/// way is counter-clockwise about it): of the two, that of the shorter way where `radius` is positive, of the
/// longer where it is negative. A radius that does not reach gives the middle between the ends, as controls
/// take it within their tolerance. `start` and `end` must differ across `normal`. Lengths in any one unit.
Vector3 centre_from_radius(const Vector3& start, const Vector3& end, double radius, const Vector3& normal);

}  // namespace counterflex
