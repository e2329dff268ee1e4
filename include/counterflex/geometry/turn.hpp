#pragma once
/// Orientations of a tool: how programs write them, and how a control goes from one to the next.
#include <array>
#include <cstdint>
#include <optional>

#include "counterflex/geometry/pose.hpp"

namespace counterflex {

/// The numbers with which a program gives an orientation.
enum class OrientationForm : std::uint8_t {
  fixed_axes,       ///< degrees about X, Y, Z: R = Rz Ry Rx. A B C of LinuxCNC, W P R of FANUC, C B A of KUKA
  quaternion,       ///< w x y z: ABB
  rotation_vector,  ///< rad about X, Y, Z: Universal Robots
  /// The direction of the tool axis, of any length: I J K of APT. The turn about the axis is not given:
  /// `rotation_of` takes the smallest rotation that turns +Z to the axis, for -Z half a turn about X.
  axis,
};

/// The direction from the tip to the spindle, in the tool frame of the control. In this library z of the tool
/// frame has this direction.
enum class SpindleAxis : std::uint8_t { z, minus_z, x, minus_x, y, minus_y };

/// The rotation of this library's tool frame in that of the control, whose `axis` points to the spindle.
Matrix3 tool_axes(SpindleAxis axis);

/// Numbers of an orientation, three or four (quaternion); the rest are 0.
using OrientationNumbers = std::array<double, 4>;

/// How many numbers the form has.
std::size_t number_count(OrientationForm form);

/// The rotation of the numbers. A quaternion and an axis are normalised; an axis of length 0 gives +Z.
Matrix3 rotation_of(OrientationForm form, const OrientationNumbers& numbers);

/// Numbers of the rotation `R`: of all that give it those nearest to `near`, so that a small rotation changes
/// numbers little. At the poles of `fixed_axes` (90 degrees about Y) the angle about X is that of `near`. Of
/// `axis` it is the third column of `R` in the length of `near`.
OrientationNumbers numbers_of(OrientationForm form, const Matrix3& R, const OrientationNumbers& near);

/// The part of a rotation vector (rad) that tilts `axis`, a unit vector; the rest turns about it.
inline Vector3 tilt(const Vector3& turn, const Vector3& axis) {
  return turn - turn.dot(axis) * axis;
}

/// How the orientation changes along a move.
struct Turn {
  Matrix3 start = Matrix3::Identity(), end = Matrix3::Identity();
  /// A control that interpolates the angles of `fixed_axes` linearly, as LinuxCNC does: angles in degrees,
  /// counted on beyond 360, in the frame `outer`, of a frame in which the tool has the rotation `inner`. Else
  /// it turns about one axis, the shorter way.
  struct Angles {
    Matrix3 outer = Matrix3::Identity(), inner = Matrix3::Identity();
    Vector3 start_deg = Vector3::Zero(), end_deg = Vector3::Zero();
  };
  std::optional<Angles> angles{};
  /// A control that knows only the tool axis: it turns the axis in the plane of both ends, and the rotation
  /// is that of `OrientationForm::axis` in this frame.
  std::optional<Matrix3> axis_in{};
};

/// The orientation at fraction `u` of the way; its start and end exactly at 0 and 1.
Matrix3 orientation_at(const Turn& turn, double u);

/// The turn between fractions `u0` < `u1`.
Turn stretch(const Turn& turn, double u0, double u1);

/// The angle between its ends (rad); the sum of the angles where they are interpolated, which is not less.
double angle_of(const Turn& turn);

/// The turn in frame A of one given in frame B.
Turn operator*(const Matrix3& R_AB, const Turn& turn);

/// The turn of frame T, which is fixed to the turning frame C.
Turn operator*(const Turn& turn, const Matrix3& R_CT);

}  // namespace counterflex
