#pragma once
/// Angles about the axis of an arc.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "counterflex/geometry/curve.hpp"

namespace counterflex {

/// The angle from point `a` to point `b` about `axis`, in (-pi, pi] (rad).
inline double angle_between(const Arc& axis, const Vector3& a, const Vector3& b) {
  const Vector3 &n = axis.normal, from = a - axis.centre, to = b - axis.centre;
  return std::atan2(n.dot(from.cross(to)), from.dot(to) - from.dot(n) * to.dot(n));
}

/// How far `way` turns about `axis` (rad): the angle between its ends, with the full turns that its own sweep
/// makes. The errors of a way's own radius and centre do not add up along many ways.
inline double angle_about(const Arc& axis, const Curve& way) {
  constexpr double turn = 2 * std::numbers::pi;
  const double between = angle_between(axis, way.start, way.end);
  if (!way.arc) return between;
  const double own = way.arc->normal.dot(axis.normal) < 0 ? -way.arc->sweep : way.arc->sweep;
  return own + std::remainder(between - own, turn);
}

}  // namespace counterflex
