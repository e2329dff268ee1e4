#pragma once
/// Arcs programmed by a radius or by a point.
#include <optional>

#include "counterflex/geometry/curve.hpp"

namespace counterflex {

/// The centre, at the height of `start`, of the arc from `start` to `end`, counter-clockwise around the unit
/// vector `normal`. A positive `radius` selects the shorter arc, a negative one the longer. If the radius is
/// too short, the centre is the middle between the ends, as controls take it within their tolerance. `start`
/// and `end` must differ across `normal`. All lengths have the same unit.
Vector3 centre_from_radius(const Vector3& start, const Vector3& end, double radius, const Vector3& normal);

/// The arc from `start` through `point` to `end`. Empty if the three points lie on a line.
std::optional<Arc> arc_through(const Vector3& start, const Vector3& point, const Vector3& end);

}  // namespace counterflex
