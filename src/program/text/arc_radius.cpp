#include "program/text/arc_radius.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace counterflex {

Vector3 centre_from_radius(const Vector3& start, const Vector3& end, double radius, const Vector3& normal) {
  Vector3 chord = end - start;
  chord -= chord.dot(normal) * normal;
  const double half = chord.norm() / 2;
  const double distance = std::sqrt(std::fmax(0, radius * radius - half * half));
  const Vector3 left = normal.cross(chord).normalized();
  return start + chord / 2 + std::copysign(distance, radius) * left;
}

// The centre c = start + (|v|^2 (u x v) x u + |u|^2 v x (u x v)) / (2 |u x v|^2) of the circle through start,
// start + u and start + v.
std::optional<Arc> arc_through(const Vector3& start, const Vector3& point, const Vector3& end) {
  constexpr double least_bend = 1e-9;  // sine of the angle between the chords
  const Vector3 u = point - start, v = end - start, w = u.cross(v);
  if (w.norm() <= least_bend * u.norm() * v.norm()) return std::nullopt;
  Arc arc;
  arc.normal = w.normalized();
  arc.centre = start + (v.squaredNorm() * w.cross(u) + u.squaredNorm() * v.cross(w)) / (2 * w.squaredNorm());
  arc.sweep = sweep_between(start, end, arc.centre, arc.normal);
  return arc;
}

}  // namespace counterflex
