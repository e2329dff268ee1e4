#include "counterflex/geometry/turn.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"

using namespace counterflex;

namespace {

using Form = OrientationForm;

double miss(const OrientationNumbers& a, const OrientationNumbers& b) {
  double most = 0;
  for (std::size_t i = 0; i < 4; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// A small rotation that is not about an axis of the frame.
Matrix3 small() {
  return exp_so3({1e-5, -2e-5, 3e-5});
}

}  // namespace

TEST_CASE("an orientation keeps its numbers, in every form and at every branch") {
  const std::pair<Form, OrientationNumbers> cases[] = {
      {Form::fixed_axes, {10, 20, 30}},
      {Form::fixed_axes, {-170, 100, 359.999}},  // more than 90 degrees about Y
      {Form::fixed_axes, {190, -20, -359.999}},
      {Form::fixed_axes, {25, 90, 12}},   // gimbal: only 12 - 25 is determined
      {Form::fixed_axes, {25, -90, 12}},  // and here 12 + 25
      {Form::fixed_axes, {25, 450, 12}},
      {Form::quaternion, {-0.5, 0.5, -0.5, 0.5}},
      {Form::quaternion, {0, 1, 0, 0}},
      {Form::quaternion, {0, -1, 0, 0}},
      {Form::rotation_vector, {pi, 0, 0}},
      {Form::rotation_vector, {-pi, 0, 0}},
      {Form::rotation_vector, {2.2, -2.2, 1}},
      {Form::rotation_vector, {0, 4, 0}},  // longer than pi
      {Form::rotation_vector, {0, 0, 0}},
      {Form::rotation_vector, {0, 2 * pi, 0}},
      {Form::axis, {0, 0, 1}},
      {Form::axis, {0, 0, -1}},
      {Form::axis, {0.6, 0, -0.8}},
      {Form::axis, {1e-9, 0, -1}},
      {Form::axis, {30, -40, 120}},  // length 130
  };
  for (const auto& one : cases) {
    const Form form = one.first;
    const OrientationNumbers& numbers = one.second;
    CAPTURE(static_cast<int>(form));
    CAPTURE(numbers[0]);
    CAPTURE(numbers[1]);
    CAPTURE(numbers[2]);
    const Matrix3 R = rotation_of(form, numbers);
    CHECK(miss(numbers_of(form, R, numbers), numbers) < 1e-9);
  }
}

TEST_CASE("numbers of a rotation nearby are near, and give it") {
  const std::pair<Form, OrientationNumbers> cases[] = {
      {Form::fixed_axes, {10, 20, 359.9995}},      {Form::fixed_axes, {-170, 100, -180}},
      {Form::quaternion, {1e-6, 0.6, 0.8, 0}},     {Form::quaternion, {-1e-6, -0.6, -0.8, 0}},
      {Form::rotation_vector, {pi - 1e-6, 0, 0}},  {Form::rotation_vector, {0, -pi, 0}},
      {Form::rotation_vector, {0, 2 * pi - 1, 0}},
  };
  for (const auto& one : cases) {
    const Form form = one.first;
    const OrientationNumbers& numbers = one.second;
    CAPTURE(static_cast<int>(form));
    CAPTURE(numbers[0]);
    CAPTURE(numbers[1]);
    CAPTURE(numbers[2]);
    const Matrix3 R = small() * rotation_of(form, numbers);
    const OrientationNumbers found = numbers_of(form, R, numbers);
    CHECK(miss(found, numbers) < (form == Form::fixed_axes ? 0.02 : 2e-4));
    CHECK((rotation_of(form, found) - R).norm() < 1e-12);
  }
}

TEST_CASE("the angles at a pole are those of a hand-computed pose") {
  // At 90 degrees about Y, R = Rz(c) Ry(90) Rx(a) depends on a - c alone: Ry(90) Rx(a - c).
  Matrix3 R;
  R << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  CHECK(miss(numbers_of(Form::fixed_axes, R, {0, 90, 0}), {0, 90, 0}) < 1e-12);
  CHECK(miss(numbers_of(Form::fixed_axes, R, {40, 89, 39}), {40, 90, 40}) < 1e-12);
}

TEST_CASE("angles that are interpolated go their own way, one rotation the shorter") {
  const Matrix3 R_start = rotation_of(Form::fixed_axes, {0, 0, 359.999}),
                R_end = rotation_of(Form::fixed_axes, {0, 0, 0.001});
  const Turn one{R_start, R_end, {}};
  const Turn angles{R_start, R_end,
                    Turn::Angles{.start_deg = Vector3(0, 0, 359.999), .end_deg = Vector3(0, 0, 0.001)}};
  CHECK((orientation_at(one, 0.5) - Matrix3::Identity()).norm() < 1e-12);
  CHECK((orientation_at(angles, 0.5) - from_rpy({0, 0, pi})).norm() < 1e-12);
  CHECK(orientation_at(angles, 1) == R_end);
  const Matrix3 frame = exp_so3({0.3, 0.2, 0.1});
  CHECK((orientation_at(frame * angles, 0.3) - frame * orientation_at(angles, 0.3)).norm() < 1e-14);
  CHECK((orientation_at(frame * one, 0.3) - frame * orientation_at(one, 0.3)).norm() < 1e-14);
}

TEST_CASE("an axis is the third column of the smallest rotation that turns +Z to it") {
  // Hand-computed: from +Z to +X a quarter turn about +Y; to (0, -1, 0) a quarter turn about +X.
  Matrix3 to_x, to_minus_y, to_minus_z;
  to_x << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  to_minus_y << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  to_minus_z << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  CHECK((rotation_of(Form::axis, {2, 0, 0}) - to_x).norm() < 1e-15);
  CHECK((rotation_of(Form::axis, {0, -0.5, 0}) - to_minus_y).norm() < 1e-15);
  CHECK((rotation_of(Form::axis, {0, 0, -3}) - to_minus_z).norm() < 1e-15);
  CHECK(rotation_of(Form::axis, {0, 0, 0}) == Matrix3::Identity());
  const Vector3 axis = Vector3(1, 2, -2) / 3;
  const Matrix3 R = rotation_of(Form::axis, {axis.x(), axis.y(), axis.z()});
  CHECK((R.col(2) - axis).norm() < 1e-15);
  CHECK(log_so3(R).norm() == doctest::Approx(std::acos(axis.z())));
  CHECK(std::abs(log_so3(R).z()) < 1e-12);
}

TEST_CASE("the turn about an axis is not among its numbers") {
  const Matrix3 R = rotation_of(Form::axis, {0.6, 0, 0.8});
  const Matrix3 turned = R * exp_so3({0, 0, 1.2});
  CHECK(miss(numbers_of(Form::axis, turned, {0.6, 0, 0.8}), {0.6, 0, 0.8}) < 1e-15);
  CHECK(miss(numbers_of(Form::axis, turned, {0, 0, 5}), {3, 0, 4}) < 1e-14);
  CHECK(miss(numbers_of(Form::axis, turned, {}), {0.6, 0, 0.8}) < 1e-15);
}

TEST_CASE("an axis turns in the plane of both ends") {
  const OrientationNumbers start{1, 0, 0}, end{0, 1, 0};
  Turn turn{rotation_of(Form::axis, start), rotation_of(Form::axis, end)};
  turn.axis_in = Matrix3::Identity();
  const double half = std::sqrt(0.5);
  CHECK((orientation_at(turn, 0.5).col(2) - Vector3(half, half, 0)).norm() < 1e-15);
  CHECK((orientation_at(turn, 0.5) - rotation_of(Form::axis, {half, half, 0})).norm() < 1e-15);
  CHECK((orientation_at(turn, 1e-9) - turn.start).norm() < 1e-8);
  CHECK((orientation_at(turn, 1 - 1e-9) - turn.end).norm() < 1e-8);
  const Matrix3 frame = exp_so3({0.3, 0.2, 0.1});
  CHECK((orientation_at(frame * turn, 0.3) - frame * orientation_at(turn, 0.3)).norm() < 1e-14);
}

TEST_CASE("a stretch of a turn is a part of it") {
  const OrientationNumbers start{0.6, 0, 0.8}, end{0, 0.6, 0.8};
  Turn about_one_axis{exp_so3({0.1, 0.2, 0.3}), exp_so3({-0.5, 0.9, 0.1})},
      by_angles = about_one_axis, by_axis{rotation_of(Form::axis, start), rotation_of(Form::axis, end)};
  by_angles.angles = Turn::Angles{.start_deg = Vector3(10, 20, 30), .end_deg = Vector3(-40, 70, 200)};
  by_angles.start = orientation_at(by_angles, 1e-300), by_angles.end = orientation_at(by_angles, 1 - 1e-16);
  by_axis.axis_in = Matrix3::Identity();
  for (const Turn& turn : {about_one_axis, by_angles, by_axis, exp_so3({0.3, 0.2, 0.1}) * by_axis})
    for (const double u : {0.0, 0.3, 0.5, 1.0}) {
      CHECK((orientation_at(stretch(turn, 0, 1), u) - orientation_at(turn, u)).norm() < 1e-14);
      CHECK((orientation_at(stretch(turn, 0.2, 0.7), u) - orientation_at(turn, 0.2 + 0.5 * u)).norm() <
            1e-14);
    }
}

TEST_CASE("z of the tool frame has the direction of the spindle in the control's tool frame") {
  const std::pair<SpindleAxis, Vector3> axes[] = {
      {SpindleAxis::z, Vector3(0, 0, 1)}, {SpindleAxis::minus_z, Vector3(0, 0, -1)},
      {SpindleAxis::x, Vector3(1, 0, 0)}, {SpindleAxis::minus_x, Vector3(-1, 0, 0)},
      {SpindleAxis::y, Vector3(0, 1, 0)}, {SpindleAxis::minus_y, Vector3(0, -1, 0)}};
  for (const auto& [axis, direction] : axes) {
    const Matrix3 R = tool_axes(axis);
    CHECK(R.col(2) == direction);
    CHECK(R.determinant() == 1);
    CHECK(R * R.transpose() == Matrix3::Identity());
  }
}

TEST_CASE("a frame that is fixed to a turning frame turns with it") {
  const Matrix3 fixed = exp_so3({0.4, -0.7, 1.1});
  Turn about_one_axis{exp_so3({0.1, 0.2, 0.3}), exp_so3({-0.5, 0.9, 0.1})}, by_angles = about_one_axis;
  by_angles.angles = Turn::Angles{.start_deg = Vector3(10, 20, 30), .end_deg = Vector3(-40, 70, 200)};
  for (const Turn& turn : {about_one_axis, by_angles})
    for (const double u : {0.0, 0.2, 0.7, 1.0}) {
      CHECK((orientation_at(turn * fixed, u) - orientation_at(turn, u) * fixed).norm() < 1e-14);
      CHECK((orientation_at(stretch(turn * fixed, 0.1, 0.9), u) -
             orientation_at(stretch(turn, 0.1, 0.9), u) * fixed)
                .norm() < 1e-14);
    }
}
