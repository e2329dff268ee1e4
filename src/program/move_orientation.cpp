#include "counterflex/program/program.hpp"

namespace counterflex {
namespace {

Vector3 angles_of(const OrientationNumbers& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

// The rotation of numbers, turned about the spindle axis.
Matrix3 rotation_with_spin(const MoveOrientation& orientation, const OrientationNumbers& numbers,
                           double spin) {
  const Matrix3 R = rotation_of(orientation.form, numbers);
  if (spin == 0) return R;
  return R * exp_so3(spin * tool_axes(orientation.spindle_axis).col(2));
}

OrientationNumbers numbers_with_spin(const MoveOrientation& orientation, const OrientationNumbers& numbers,
                                     double spin) {
  if (spin == 0) return numbers;
  return numbers_of(orientation.form, rotation_with_spin(orientation, numbers, spin), numbers);
}

}  // namespace

Turn written_turn_of(const MoveOrientation& orientation) {
  Turn turn{rotation_with_spin(orientation, orientation.start, orientation.start_spin),
            rotation_with_spin(orientation, orientation.end, orientation.end_spin),
            {},
            {}};
  if (orientation.form == OrientationForm::axis) turn.axis_in = Matrix3::Identity();
  if (orientation.by_angles)
    turn.angles = Turn::Angles{.start_deg = angles_of(numbers_at(orientation, 0)),
                               .end_deg = angles_of(numbers_at(orientation, 1))};
  return turn;
}

Turn turn_of(const MoveOrientation& orientation) {
  return written_turn_of(orientation) * tool_axes(orientation.spindle_axis);
}

OrientationNumbers numbers_at(const MoveOrientation& orientation, double u) {
  const OrientationNumbers start = numbers_with_spin(orientation, orientation.start, orientation.start_spin);
  if (u == 0) return start;
  const OrientationNumbers end = numbers_with_spin(orientation, orientation.end, orientation.end_spin);
  if (u == 1) return end;
  if (!orientation.by_angles)
    return numbers_of(orientation.form, orientation_at(written_turn_of(orientation), u), start);
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = start[i] + u * (end[i] - start[i]);
  return numbers;
}

}  // namespace counterflex
