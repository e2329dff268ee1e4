// How a control turns the tool along an arc: relative to the path, or about one axis.
#include "counterflex/program/arc_turn.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"

using namespace counterflex;

namespace {

/// An arc about `normal` along which the tool turns by `phi`.
ArcTurn arc_with(const Vector3& normal, double sweep, const Vector3& phi) {
  const Matrix3 R_start = exp_so3(Vector3(0.3, -0.8, 0.5));
  return {.normal = normal, .sweep = sweep, .turn = {R_start, exp_so3(phi) * R_start, {}, {}}};
}

const Vector3 normal = Vector3(1, 2, -2) / 3, across = Vector3(2, 1, 2) / 3;

}  // namespace

TEST_CASE("a turn about the normal of an arc is the same relative to the path and about one axis") {
  for (const double sweep : {0.1, 1.5, 3.1, 3.3, 4.5})
    for (const double turn : {-1.0, 0.0, 0.3, 2.0}) {
      CAPTURE(sweep);
      CAPTURE(turn);
      CHECK(deviation_by_path(arc_with(normal, sweep, turn * normal)) < 1e-12);
    }
}

TEST_CASE("a small turn across the normal deviates by an eighth of its angle times the sweep") {
  // To first order the axis of the turn goes with the path, by u - 1/2 of the sweep beside the middle one:
  // the integral of e s (u - 1/2) from 0 to u is largest in the middle, e s / 8.
  constexpr double e = 1e-3;
  for (const double sweep : {0.05, 0.2, 0.4}) {
    CAPTURE(sweep);
    CHECK(deviation_by_path(arc_with(normal, sweep, e * across)) ==
          doctest::Approx(e * sweep / 8).epsilon(0.02));
  }
}

TEST_CASE("a turn of 5e-5 rad across the normal deviates by less than 1.3e-4 rad on arcs up to 250 degrees") {
  for (double sweep = 0.1; sweep < 250 * deg; sweep += 0.1)
    for (const double turn : {-0.2, 0.0, 0.2}) {
      CAPTURE(sweep);
      CHECK(deviation_by_path(arc_with(normal, sweep, turn * normal + 5e-5 * across)) < 1.3e-4);
    }
}

TEST_CASE("each limit of a turn along an arc holds up to its value, less the margin") {
  const ArcTurn arc = arc_with(normal, 1, 0.2 * normal + 1e-3 * across);
  const double by_path = deviation_by_path(arc), angle = std::hypot(0.2, 1e-3);
  const Matrix3 R_middle = orientation_at(arc.turn, 0.5);
  const auto keeps = [&](const ArcTurnLimits& limits) { return keeps_limits(limits, arc, 1e-6); };
  CHECK(keeps({}));
  CHECK(keeps({.path_room = by_path + 2e-6}));
  CHECK(!keeps({.path_room = by_path + 0.5e-6}));
  CHECK(keeps({.largest_turn = angle + 2e-6}));
  CHECK(!keeps({.largest_turn = angle + 0.5e-6}));
  const Matrix3 R_point = exp_so3(0.01 * across) * R_middle;
  CHECK(keeps({.R_point = R_point, .point_room = 0.01 + 2e-6}));
  CHECK(!keeps({.R_point = R_point, .point_room = 0.01 + 0.5e-6}));
  CHECK(keeps({.least_share = 0.5 - 2e-6}));
  CHECK(!keeps({.least_share = 0.5 - 0.5e-6}));
}
