#include "counterflex/geometry/curve.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"

using namespace counterflex;

namespace {

// A spiral helix in a tilted frame.
Curve spiral() {
  const Pose X{from_rpy(Vector3(0.3, -0.4, 1.1)), Vector3(5, -2, 7)};
  const double sweep = 4.5;
  return X * Curve{{3, 0, 1},
                   Vector3(4 * std::cos(sweep), 4 * std::sin(sweep), 3),
                   Arc{Vector3::Zero(), Vector3::UnitZ(), sweep}};
}

double numeric_length(const Curve& curve) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int k = 0; k < steps; ++k)
    sum += (point_at(curve, (k + 1.0) / steps) - point_at(curve, double(k) / steps)).norm();
  return sum;
}

}  // namespace

TEST_CASE("the ends of a curve are exactly its start and end points") {
  for (const Curve& curve : {spiral(), Curve{{1, 2, 3}, {0.1, 0.2, 0.3}, {}}}) {
    CHECK(point_at(curve, 0) == curve.start);
    CHECK(point_at(curve, 1) == curve.end);
    CHECK((point_at(curve, 1 - 1e-9) - curve.end).norm() < 1e-7);
  }
}

TEST_CASE("the direction along a curve is the derivative of its points") {
  for (const Curve& curve : {spiral(), Curve{{1, 2, 3}, {0.1, 0.2, 0.3}, {}}})
    for (const double u : {0.1, 0.5, 0.9}) {
      const Vector3 difference = point_at(curve, u + 1e-6) - point_at(curve, u - 1e-6);
      CHECK((direction_at(curve, u) - difference.normalized()).norm() < 1e-9);
    }
  CHECK(direction_at({{1, 1, 1}, {1, 1, 1}, {}}, 0.5).isZero(0));
}

TEST_CASE("length is that of many short chords") {
  for (const Curve& curve : {spiral(), Curve{{1, 2, 3}, {0.1, 0.2, 0.3}, {}}})
    CHECK(length(curve) == doctest::Approx(numeric_length(curve)).epsilon(1e-3));
  const Curve circle{{2, 0, 0}, {2, 0, 0}, Arc{Vector3::Zero(), Vector3::UnitZ(), 2 * pi}};
  CHECK(length(circle) == doctest::Approx(4 * pi));
}

TEST_CASE("a part of a curve passes through the same points") {
  for (const Curve& curve : {spiral(), Curve{{1, 2, 3}, {0.1, 0.2, 0.3}, {}}}) {
    const Curve piece = stretch(curve, 0.25, 0.75);
    for (const double u : {0.0, 0.3, 1.0})
      CHECK((point_at(piece, u) - point_at(curve, 0.25 + 0.5 * u)).norm() < 1e-12);
  }
}

TEST_CASE("an arc sweeps counter-clockwise about its normal, a full turn where it ends at its start") {
  const Vector3 o = Vector3::Zero(), x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  CHECK(sweep_between(x, y, o, z) == doctest::Approx(pi / 2));
  CHECK(sweep_between(x, y, o, -z) == doctest::Approx(1.5 * pi));
  CHECK(sweep_between(x, x, o, z) == doctest::Approx(2 * pi));
  CHECK(sweep_between(x, y + 7 * z, o, z, 2) == doctest::Approx(4.5 * pi));
}
