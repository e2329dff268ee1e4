#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/statistics.hpp"

namespace counterflex {
namespace {

/// The part of a rotation vector that tilts the tool axis.
Vector3 tilt_of(const Vector6& deviation, const Vector3& axis) {
  const Vector3 phi = deviation.tail<3>();
  return phi - phi.dot(axis) * axis;
}

void keep_larger(std::optional<double>& kept, const std::optional<double>& other) {
  if (other) kept = std::max(kept.value_or(0), *other);
}

}  // namespace

double largest_on_circle(const Vector6& deviation, const Vector3& axis, double radius, double height) {
  const Vector3 phi = tilt_of(deviation, axis);
  const Vector3 b = deviation.head<3>() + height * phi.cross(axis);
  const double axial = b.dot(axis);
  return std::hypot((b - axial * axis).norm(), std::abs(axial) + radius * phi.norm());
}

double ToolDeviation::largest_mm() const {
  return std::max({tip_mm, rim_mm.value_or(0), flank_mm.value_or(0)});
}

void ToolDeviationTally::add(const ToolSize& size, const Vector6& deviation, const Vector3& axis, int line) {
  ToolDeviation one;
  one.tip_mm = deviation.head<3>().norm() / mm;
  one.tilt_deg = tilt_of(deviation, axis).norm() / deg;
  one.line = line;
  if (size.diameter) one.rim_mm = largest_on_circle(deviation, axis, *size.diameter / 2, 0) / mm;
  if (size.diameter && size.flute)
    one.flank_mm = largest_on_circle(deviation, axis, *size.diameter / 2, *size.flute) / mm;
  if (!largest_) return void(largest_ = one);
  ToolDeviation& kept = *largest_;
  // Reports the first of lines that differ by rounding.
  if (one.largest_mm() > kept.largest_mm() + indistinct_mm) kept.line = line;
  kept.tip_mm = std::max(kept.tip_mm, one.tip_mm);
  keep_larger(kept.rim_mm, one.rim_mm);
  keep_larger(kept.flank_mm, one.flank_mm);
  kept.tilt_deg = std::max(kept.tilt_deg, one.tilt_deg);
}

}  // namespace counterflex
