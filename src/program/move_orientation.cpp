#include "counterflex/program/program.hpp"

namespace counterflex {
namespace {

Vector3 angles_of(const OrientationNumbers& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

Turn written_turn_of(const MoveOrientation& orientation) {
  Turn turn{rotation_of(orientation.form, orientation.start),
            rotation_of(orientation.form, orientation.end),
            {},
            {}};
  if (orientation.form == OrientationForm::axis) turn.axis_in = Matrix3::Identity();
  if (orientation.by_angles)
    turn.angles =
        Turn::Angles{.start_deg = angles_of(orientation.start), .end_deg = angles_of(orientation.end)};
  return turn;
}

Turn turn_of(const MoveOrientation& orientation) {
  return written_turn_of(orientation) * tool_axes(orientation.spindle_axis);
}

OrientationNumbers numbers_at(const MoveOrientation& orientation, double u) {
  if (u == 0) return orientation.start;
  if (u == 1) return orientation.end;
  if (!orientation.by_angles)
    return numbers_of(orientation.form, orientation_at(written_turn_of(orientation), u), orientation.start);
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = orientation.start[i] + u * (orientation.end[i] - orientation.start[i]);
  return numbers;
}

}  // namespace counterflex
