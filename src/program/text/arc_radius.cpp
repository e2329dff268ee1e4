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

}  // namespace counterflex
