#include "counterflex/program/program.hpp"

namespace counterflex {
namespace {

Vector3 angles_of(const OrientationNumbers& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

Turn turn_of(const MoveOrientation& orientation) {
  Turn turn{rotation_of(orientation.form, orientation.start),
            rotation_of(orientation.form, orientation.end),
            {},
            {}};
  if (orientation.form == OrientationForm::axis) turn.axis_in = Matrix3::Identity();
  if (orientation.by_angles)
    turn.angles = Turn::Angles{Matrix3::Identity(), angles_of(orientation.start), angles_of(orientation.end)};
  return turn;
}

OrientationNumbers numbers_at(const MoveOrientation& orientation, double u) {
  if (u == 0) return orientation.start;
  if (u == 1) return orientation.end;
  if (!orientation.by_angles)
    return numbers_of(orientation.form, orientation_at(turn_of(orientation), u), orientation.start);
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = orientation.start[i] + u * (orientation.end[i] - orientation.start[i]);
  return numbers;
}

}  // namespace counterflex
