#include "counterflex/geometry/turn.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

using Numbers = OrientationNumbers;

constexpr double gimbal = 1e-9;  // cosine of the angle about Y below which X and Z are one axis

Vector3 first_three(const Numbers& n) {
  return {n[0], n[1], n[2]};
}

double squared_distance(const Numbers& a, const Numbers& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

const Numbers& nearer(const Numbers& a, const Numbers& b, const Numbers& near) {
  return squared_distance(b, near) < squared_distance(a, near) ? b : a;
}

// The same angle (deg), as few turns as possible from `near`.
double same_angle_near(double angle, double near) {
  return near + std::remainder(angle - near, 360.0);
}

Numbers angles_near(const Vector3& angles_deg, const Numbers& near) {
  Numbers numbers{};
  for (std::size_t i = 0; i < 3; ++i)
    numbers[i] = same_angle_near(angles_deg[static_cast<Eigen::Index>(i)], near[i]);
  return numbers;
}

// An orientation has two triples of angles, and at the poles any angle about X.
Numbers fixed_axes_of(const Matrix3& R, const Numbers& near) {
  if (std::hypot(R(0, 0), R(1, 0)) < gimbal) {
    const double roll = near[0] * deg;
    const Matrix3 rest = R * exp_so3(roll * Vector3::UnitX()).transpose();  // Rz Ry
    const double yaw = std::atan2(-rest(0, 1), rest(1, 1));
    return angles_near(Vector3(roll, R(2, 0) < 0 ? pi / 2 : -pi / 2, yaw) / deg, near);
  }
  const Vector3 one = to_rpy(R) / deg;
  const Vector3 other(one.x() + 180, 180 - one.y(), one.z() + 180);
  return nearer(angles_near(one, near), angles_near(other, near), near);
}

Numbers quaternion_of(const Matrix3& R, const Numbers& near) {
  const Eigen::Quaterniond q(R);
  const Numbers one{q.w(), q.x(), q.y(), q.z()}, other{-q.w(), -q.x(), -q.y(), -q.z()};
  return nearer(one, other, near);
}

// Vectors that give one rotation have one line, and lengths that differ by full turns.
Numbers rotation_vector_of(const Matrix3& R, const Numbers& near) {
  constexpr double turn = 2 * pi;
  Vector3 phi = log_so3(R);
  const Vector3 wanted = first_three(near);
  if (phi.isZero(0)) phi = turn * std::round(wanted.norm() / turn) * wanted.stableNormalized();
  const double angle = phi.norm();
  if (angle == 0) return {};
  const Vector3 axis = phi / angle;
  const double nearest = angle + turn * std::round((axis.dot(wanted) - angle) / turn);
  return {nearest * axis.x(), nearest * axis.y(), nearest * axis.z(), 0};
}

// Half a turn about X for -Z, where the axis of the smallest rotation is not determined.
Matrix3 rotation_of_axis(const Vector3& axis) {
  const Vector3 z = axis.isZero(0) ? Vector3::UnitZ() : axis.stableNormalized();
  const Vector3 normal = Vector3::UnitZ().cross(z);
  const double sine = normal.norm();
  if (sine == 0) return z.z() > 0 ? Matrix3::Identity() : exp_so3(pi * Vector3::UnitX());
  return exp_so3(std::atan2(sine, z.z()) / sine * normal);
}

Numbers axis_of(const Matrix3& R, const Numbers& near) {
  const double length = first_three(near).stableNorm();
  const Vector3 axis = (length > 0 ? length : 1) * R.col(2);
  return {axis.x(), axis.y(), axis.z(), 0};
}

// The axis at fraction u of the way from `start` to `end`, in the plane of both.
Vector3 axis_between(const Vector3& start, const Vector3& end, double u) {
  const Vector3 normal = start.cross(end);
  const double sine = normal.norm();
  if (sine == 0 && start.dot(end) > 0) return start;
  const Vector3 about = sine > 0 ? Vector3(normal / sine) : start.unitOrthogonal();
  return exp_so3(u * std::atan2(sine, start.dot(end)) * about) * start;
}

Matrix3 rotation_of_angles(const Vector3& angles_deg) {
  return from_rpy(angles_deg * deg);
}

}  // namespace

std::size_t number_count(OrientationForm form) {
  return form == OrientationForm::quaternion ? 4 : 3;
}

Matrix3 rotation_of(OrientationForm form, const OrientationNumbers& numbers) {
  switch (form) {
    case OrientationForm::fixed_axes:
      return rotation_of_angles(first_three(numbers));
    case OrientationForm::quaternion:
      return from_quaternion({numbers[0], numbers[1], numbers[2], numbers[3]});
    case OrientationForm::rotation_vector:
      return exp_so3(first_three(numbers));
    case OrientationForm::axis:
      return rotation_of_axis(first_three(numbers));
  }
  return Matrix3::Identity();
}

OrientationNumbers numbers_of(OrientationForm form, const Matrix3& R, const OrientationNumbers& near) {
  switch (form) {
    case OrientationForm::fixed_axes:
      return fixed_axes_of(R, near);
    case OrientationForm::quaternion:
      return quaternion_of(R, near);
    case OrientationForm::rotation_vector:
      return rotation_vector_of(R, near);
    case OrientationForm::axis:
      return axis_of(R, near);
  }
  return near;
}

Matrix3 orientation_at(const Turn& turn, double u) {
  if (u == 0) return turn.start;
  if (u == 1) return turn.end;
  if (const auto& angles = turn.angles)
    return angles->outer * rotation_of_angles(angles->start_deg + u * (angles->end_deg - angles->start_deg)) *
           angles->inner;
  if (const auto& outer = turn.axis_in)
    return *outer *
           rotation_of_axis(outer->transpose() * axis_between(turn.start.col(2), turn.end.col(2), u));
  return exp_so3(u * rotation_between(turn.end, turn.start)) * turn.start;
}

Turn stretch(const Turn& turn, double u0, double u1) {
  Turn part{orientation_at(turn, u0), orientation_at(turn, u1), turn.angles, turn.axis_in};
  if (!turn.angles) return part;
  const Vector3 way_deg = turn.angles->end_deg - turn.angles->start_deg;
  part.angles->start_deg += u0 * way_deg;
  part.angles->end_deg = turn.angles->start_deg + u1 * way_deg;
  return part;
}

double angle_of(const Turn& turn) {
  if (turn.angles) return (turn.angles->end_deg - turn.angles->start_deg).lpNorm<1>() * deg;
  return rotation_between(turn.end, turn.start).norm();
}

Turn operator*(const Matrix3& R_AB, const Turn& turn) {
  Turn turned{R_AB * turn.start, R_AB * turn.end, turn.angles, turn.axis_in};
  if (turned.angles) turned.angles->outer = R_AB * turned.angles->outer;
  if (turned.axis_in) turned.axis_in = R_AB * *turned.axis_in;
  return turned;
}

// A control that knows only the tool axis writes the direction to the spindle: T is C there.
Turn operator*(const Turn& turn, const Matrix3& R_CT) {
  Turn turned{turn.start * R_CT, turn.end * R_CT, turn.angles, turn.axis_in};
  if (turned.angles) turned.angles->inner = turned.angles->inner * R_CT;
  return turned;
}

Matrix3 tool_axes(SpindleAxis axis) {
  switch (axis) {
    case SpindleAxis::z:
      break;
    case SpindleAxis::minus_z:
      return Vector3(1, -1, -1).asDiagonal();
    case SpindleAxis::x:
      return (Matrix3() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished();
    case SpindleAxis::minus_x:
      return (Matrix3() << 0, 0, -1, 0, 1, 0, 1, 0, 0).finished();
    case SpindleAxis::y:
      return (Matrix3() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
    case SpindleAxis::minus_y:
      return (Matrix3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
  }
  return Matrix3::Identity();
}

}  // namespace counterflex
