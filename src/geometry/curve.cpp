#include "counterflex/geometry/curve.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace counterflex {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// A point in cylindrical coordinates about an axis: radius, height, and the directions of increasing radius
// and angle.
struct Cylinder {
  double radius, height;
  Vector3 outward, onward;
};

Cylinder about(const Arc& arc, const Vector3& p) {
  const Vector3 arm = p - arc.centre;
  const double height = arm.dot(arc.normal);
  const Vector3 flat = arm - height * arc.normal;
  const double radius = flat.norm();
  const Vector3 outward = radius > 0 ? Vector3(flat / radius) : Vector3(arc.normal.unitOrthogonal());
  return {radius, height, outward, arc.normal.cross(outward)};
}

Vector3 at_angle(const Cylinder& from, double angle) {
  return std::cos(angle) * from.outward + std::sin(angle) * from.onward;
}

}  // namespace

Vector3 point_on_arc(const Curve& curve, double u) {
  const Cylinder a = about(*curve.arc, curve.start), b = about(*curve.arc, curve.end);
  const double radius = a.radius + u * (b.radius - a.radius), height = a.height + u * (b.height - a.height);
  return curve.arc->centre + radius * at_angle(a, u * curve.arc->sweep) + height * curve.arc->normal;
}

Vector3 direction_at(const Curve& curve, double u) {
  Vector3 rate = curve.end - curve.start;
  if (curve.arc) {
    const Cylinder a = about(*curve.arc, curve.start), b = about(*curve.arc, curve.end);
    const Vector3 outward = at_angle(a, u * curve.arc->sweep);
    const double radius = a.radius + u * (b.radius - a.radius);
    rate = (b.radius - a.radius) * outward + radius * curve.arc->sweep * curve.arc->normal.cross(outward) +
           (b.height - a.height) * curve.arc->normal;
  }
  const double size = rate.norm();
  return size > 0 ? Vector3(rate / size) : Vector3(Vector3::Zero());
}

double radius_at(const Arc& arc, const Vector3& p) {
  return about(arc, p).radius;
}

double length_of_arc(const Curve& curve) {
  const Cylinder a = about(*curve.arc, curve.start), b = about(*curve.arc, curve.end);
  const double around = 0.5 * (a.radius + b.radius) * curve.arc->sweep;
  return std::hypot(around, b.radius - a.radius, b.height - a.height);
}

Curve stretch(const Curve& curve, double u0, double u1) {
  Curve result{point_at(curve, u0), point_at(curve, u1), curve.arc};
  if (result.arc) result.arc->sweep *= u1 - u0;
  return result;
}

Curve operator*(const Pose& X_AB, const Curve& curve) {
  Curve result{X_AB * curve.start, X_AB * curve.end, curve.arc};
  if (result.arc) {
    result.arc->centre = X_AB * curve.arc->centre;
    result.arc->normal = X_AB.R * curve.arc->normal;
  }
  return result;
}

double sweep_between(const Vector3& start, const Vector3& end, const Vector3& centre, const Vector3& normal,
                     int turns) {
  const Cylinder a = about({centre, normal, 0}, start);
  const Vector3 arm = end - centre;
  double angle = std::atan2(arm.dot(a.onward), arm.dot(a.outward));
  if (angle < 1e-12) angle += two_pi;
  return angle + turns * two_pi;
}

double angle_between(const Arc& axis, const Vector3& a, const Vector3& b) {
  const Vector3 &n = axis.normal, from = a - axis.centre, to = b - axis.centre;
  return std::atan2(n.dot(from.cross(to)), from.dot(to) - from.dot(n) * to.dot(n));
}

double angle_about(const Arc& axis, const Curve& way) {
  const double between = angle_between(axis, way.start, way.end);
  if (!way.arc) return between;
  const double own = way.arc->normal.dot(axis.normal) < 0 ? -way.arc->sweep : way.arc->sweep;
  return own + std::remainder(between - own, two_pi);
}

}  // namespace counterflex
