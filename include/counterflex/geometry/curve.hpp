#pragma once
/// Straight lines and arcs by fraction of their length or angle. Lengths in any one unit, angles in rad.
#include <optional>

#include "counterflex/geometry/pose.hpp"

namespace counterflex {

/// A way around an axis on which radius and height change linearly with the angle: an arc, a helix, or the
/// spiral of an arc whose ends are not equally far from its centre.
struct Arc {
  Vector3 centre = Vector3::Zero();   ///< a point of the axis
  Vector3 normal = Vector3::UnitZ();  ///< unit vector of the axis; the way is counter-clockwise about it
  double sweep = 0;                   ///< angle from start to end, positive (rad)
};

/// A line or an arc between two points.
struct Curve {
  Vector3 start = Vector3::Zero();
  Vector3 end = Vector3::Zero();
  std::optional<Arc> arc{};
};

/// `point_at` of an arc, inside of it.
Vector3 point_on_arc(const Curve& curve, double u);

/// The point at fraction `u` of the line's length or the arc's angle; its start and end exactly at 0 and 1.
inline Vector3 point_at(const Curve& curve, double u) {
  if (u == 0) return curve.start;
  if (u == 1) return curve.end;
  if (curve.arc) return point_on_arc(curve, u);
  return curve.start + u * (curve.end - curve.start);
}

/// Unit vector along the curve at `u`; zero where the curve has no length.
Vector3 direction_at(const Curve& curve, double u);

/// The distance of a point from the axis of an arc.
double radius_at(const Arc& arc, const Vector3& p);

/// `length` of an arc.
double length_of_arc(const Curve& curve);

/// Of a spiral with its mean radius. It is too short by less than a millionth of the change of its radius
/// where the radius changes by 1 % in a radian, and by less than 1 % of the change where it doubles.
inline double length(const Curve& curve) {
  return curve.arc ? length_of_arc(curve) : (curve.end - curve.start).norm();
}

/// The same curve between fractions `u0` < `u1`.
Curve stretch(const Curve& curve, double u0, double u1);

/// The curve in frame A of one given in frame B.
Curve operator*(const Pose& X_AB, const Curve& curve);

/// The angle in (0, 2 pi] from `start` to `end` about an axis, counter-clockwise about `normal`: 2 pi where
/// both have the same direction to within 1e-12 rad. With `turns` full turns more.
double sweep_between(const Vector3& start, const Vector3& end, const Vector3& centre, const Vector3& normal,
                     int turns = 0);

/// The angle from point `a` to point `b` about `axis`, in (-pi, pi] (rad).
double angle_between(const Arc& axis, const Vector3& a, const Vector3& b);

/// How far `way` turns about `axis` (rad): the angle between its ends, with the full turns that its own sweep
/// makes. The errors of a way's own radius and centre do not add up along many ways.
double angle_about(const Arc& axis, const Curve& way);

}  // namespace counterflex
