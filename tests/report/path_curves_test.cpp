#include "counterflex/report/path_curves.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "made_up_run.hpp"
#include "report/tally/causes.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr std::size_t many = 100000;

/// A feed move of many short pieces along x, a tenth of a millimetre each.
Waypoint step(std::size_t i, double before_mm) {
  Waypoint w = cut(i, 10 + static_cast<int>(i), 0.1, Vector3(0, before_mm, 0));
  w.s = 0.1 * mm * static_cast<double>(i + 1);
  w.p_MT = Vector3(w.s, 0, 0);
  return w;
}

float value(const std::array<float, quantity_count>& values, Quantity quantity) {
  return values[static_cast<std::size_t>(quantity)];
}

float largest_of_all(const PathCurves& curves, Quantity quantity) {
  float largest = -1;
  for (const Stretch& s : curves.stretches()) largest = std::max(largest, value(s.largest, quantity));
  return largest;
}

PathCurves with_spikes(std::size_t count, const std::vector<std::size_t>& spikes) {
  PathCurves curves(true, true);
  for (std::size_t i = 0; i < count; ++i) {
    const auto spike = std::find(spikes.begin(), spikes.end(), i) - spikes.begin();
    const bool planted = spike < static_cast<std::ptrdiff_t>(spikes.size());
    curves.add(step(i, planted ? 5 + static_cast<double>(spike) : 1e-3 * static_cast<double>(i % 100)), 0);
  }
  return curves;
}

}  // namespace

TEST_CASE("a path that fits has a stretch for each waypoint, with its own values") {
  const PathCurves curves = with_spikes(PathCurves::most_stretches, {});
  REQUIRE(curves.stretches().size() == PathCurves::most_stretches);
  CHECK(curves.waypoints_per_stretch() == 1);
  const Stretch& stretch = curves.stretches()[42];
  CHECK(stretch.s_mm == doctest::Approx(4.3));
  CHECK(stretch.first_line == 52);
  CHECK(stretch.last_line == 52);
  for (std::size_t q = 0; q < quantity_count; ++q)  // an unknown quantity is NaN
    CHECK((stretch.least[q] == stretch.largest[q] ||
           (std::isnan(stretch.least[q]) && std::isnan(stretch.largest[q]))));
  CHECK(value(stretch.largest, Quantity::before) == doctest::Approx(0.042));
  CHECK(value(stretch.largest, Quantity::before_y) == doctest::Approx(0.042));
  CHECK(value(stretch.largest, Quantity::before_across) == doctest::Approx(0.042));
  CHECK(value(stretch.largest, Quantity::after) == doctest::Approx(0.00042));
  CHECK(value(stretch.largest, Quantity::load) == doctest::Approx(0.021));
  CHECK(value(stretch.largest, Quantity::discrepancy) == doctest::Approx(0.042 / 4));
  CHECK(value(stretch.largest, Quantity::air) == doctest::Approx(0.021));
  CHECK(value(stretch.largest, Quantity::force) == doctest::Approx(50));
  CHECK(stretch.place[0] == doctest::Approx(4.3));
}

TEST_CASE(
    "of a path of any length there are few stretches, and every planted spike is the largest of its own") {
  const std::vector<std::size_t> spikes{0, 1, 8191, 8192, 16384, 54321, 65535, 65536, many - 2, many - 1};
  const PathCurves curves = with_spikes(many, spikes);
  CHECK(curves.waypoints() == many);
  CHECK(curves.stretches().size() <= PathCurves::most_stretches);
  CHECK(curves.stretches().size() * curves.waypoints_per_stretch() >= many);
  for (std::size_t k = 0; k < spikes.size(); ++k) {
    CAPTURE(spikes[k]);
    const Stretch& stretch = curves.stretches()[spikes[k] / curves.waypoints_per_stretch()];
    const int line = 10 + static_cast<int>(spikes[k]);
    CHECK(stretch.first_line <= line);
    CHECK(line <= stretch.last_line);
    // A neighbour in the same stretch may be a larger one.
    CHECK(value(stretch.largest, Quantity::before) >= static_cast<float>(5 + k));
    CHECK(value(stretch.largest, Quantity::after) >=
          static_cast<float>(0.05 + 0.01 * static_cast<double>(k)));
  }
  CHECK(largest_of_all(curves, Quantity::before) == doctest::Approx(14));
}

TEST_CASE("the least value is kept as well, and the place shown is that of the largest deviation after") {
  PathCurves curves(true);
  for (std::size_t i = 0; i < 2 * PathCurves::most_stretches; ++i) curves.add(step(i, i == 5 ? -7 : 1), 0);
  const Stretch& stretch = curves.stretches()[5 / curves.waypoints_per_stretch()];
  CHECK(value(stretch.least, Quantity::before_y) == doctest::Approx(-7));
  CHECK(value(stretch.largest, Quantity::before_y) == doctest::Approx(1));
  CHECK(stretch.before[1] == doctest::Approx(-7));
  CHECK(stretch.after[1] == doctest::Approx(-0.07));
  CHECK(stretch.place[0] == doctest::Approx(0.6));
}

TEST_CASE("a sample inside a piece has only the deviation after, and its peak is kept when it is merged") {
  PathCurves curves(true);
  for (std::size_t i = 0; i <= PathCurves::most_stretches; ++i) {
    Waypoint w = step(i, 0.1);
    w.between = i % 2 == 0;
    w.place = !w.between;
    if (i == 6) w.after.head<3>() = Vector3(0, 0, 0.004) * mm;
    curves.add(w, 0);
    if (i == 6) CHECK(std::isnan(value(curves.stretches().back().largest, Quantity::before)));
  }
  REQUIRE(curves.waypoints_per_stretch() == 2);
  const Stretch& merged = curves.stretches()[3];
  CHECK(value(merged.largest, Quantity::after) == doctest::Approx(0.004));
  CHECK(value(merged.largest, Quantity::before) == doctest::Approx(0.1));
  CHECK(value(merged.least, Quantity::before) == doctest::Approx(0.1));
}

TEST_CASE("the first waypoint after a rapid is marked, and the rapid is counted") {
  PathCurves curves(true);
  Waypoint rapid = step(0, 0.8);
  rapid.cutting = false;
  curves.add(rapid, -1);
  curves.add(step(0, 0.4), 3);
  curves.add(step(1, 0.4), 3);
  REQUIRE(curves.stretches().size() == 2);
  CHECK(value(curves.stretches()[0].largest, Quantity::before) == doctest::Approx(0.4));
  CHECK(curves.stretches()[0].begins_after_rapid);
  CHECK_FALSE(curves.stretches()[1].begins_after_rapid);
  CHECK(curves.rapids().count == 1);
}

TEST_CASE("a prediction has no values after, and unsolved waypoints are skipped") {
  PathCurves curves(false);
  curves.add(step(0, 0.5), 0);
  Waypoint unsolved = step(1, 0.5);
  unsolved.status = Status::singular;
  curves.add(unsolved, 0);
  REQUIRE(curves.stretches().size() == 1);
  const Stretch& stretch = curves.stretches()[0];
  for (const Quantity q : {Quantity::after, Quantity::air, Quantity::correction})
    CHECK(std::isnan(value(stretch.largest, q)));
  CHECK(std::isnan(stretch.after[0]));
  CHECK(value(stretch.largest, Quantity::before) == doctest::Approx(0.5));
}

TEST_CASE("gravity has a curve only if weights act") {
  for (const bool weighs : {false, true}) {
    PathCurves curves(true, weighs);
    curves.add(step(0, 0.5), 0);
    CHECK(std::isnan(value(curves.stretches()[0].largest, Quantity::gravity)) != weighs);
  }
}

TEST_CASE("the curves of all causes and of the discrepancy add up to the deviation before") {
  PathCurves curves(true, true, true);
  Waypoint w = step(0, 0.5);
  w.causes = Causes{};
  w.causes->geometry.head<3>() = Vector3(0.1, 0, 0.01) * mm;
  w.causes->load.head<3>() = Vector3(0.2, 0.03, 0) * mm;
  w.causes->fixture.head<3>() = Vector3(-0.07, 0, 0.02) * mm;
  w.causes->gravity.head<3>() = Vector3(0, 0, -0.04) * mm;
  w.causes->superposition.head<3>() = Vector3(0.33, 0.03, 0.005) * mm;  // the rest is of preloads
  curves.add(w, 0);
  const auto& values = curves.stretches()[0].largest;
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const auto component = [&](Quantity x) {
      return value(values, static_cast<Quantity>(static_cast<int>(x) + axis));
    };
    double sum = component(Quantity::discrepancy_x);
    for (const Cause& cause : all_causes) sum += component(cause.curve);
    CHECK(sum == doctest::Approx(component(Quantity::before_x)));
  }
  CHECK(value(values, Quantity::fixture_x) == doctest::Approx(-0.07));
}

TEST_CASE("the fixture has a curve only if the machine has one, also where the part does not deflect") {
  for (const bool has_fixture : {false, true}) {
    PathCurves curves(true, true, has_fixture);
    curves.add(step(0, 0.5), 0);
    CHECK(std::isnan(value(curves.stretches()[0].largest, Quantity::fixture)) != has_fixture);
  }
}

TEST_CASE("marks are thinned out evenly, and counted") {
  PathMarks marks;
  for (int i = 0; i < 10000; ++i) marks.add(i);
  CHECK(marks.count == 10000);
  CHECK(marks.s_mm.size() <= PathMarks::most);
  REQUIRE(marks.s_mm.size() > PathMarks::most / 2);
  for (std::size_t i = 1; i < marks.s_mm.size(); ++i)
    CHECK(marks.s_mm[i] - marks.s_mm[i - 1] == marks.s_mm[1] - marks.s_mm[0]);
}

TEST_CASE("quantities have the names of their columns") {
  CHECK(name_of(Quantity::before_x) == "before_x_mm");
  CHECK(name_of(Quantity::after_rotation) == "after_rotation_deg");
  CHECK(name_of(Quantity::discrepancy) == "discrepancy_mm");
  CHECK(name_of(Quantity::force) == "force_N");
}
