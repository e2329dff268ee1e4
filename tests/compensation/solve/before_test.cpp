// Of one program all runs find the same deviation before compensation.
#include <fmt/format.h>

#include <cmath>

#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Lines, quarters, full circles and helices; short moves and long ones.
const char* const all_ways =
    "G21 G90 G17\nG0 X25. Y0. Z5.\nG1 Z-1. F300\nG3 X25. Y0. I-25. J0. F600\nG3 X0. Y25. I-25. J0.\n"
    "G1 X0. Y-10.\nX0.4\nX0.9 Y-9.7\nG2 X0.9 Y-9.7 Z-3. I5. J0. P3\nG2 X8. Y-2. R9.\nG1 X70. Y-30.\nG0 "
    "Z20.\nM30\n";

struct MeasuredPlace {
  std::size_t segment;
  double fraction;
  Vector6 before;
};

std::vector<MeasuredPlace> measured_places(const std::vector<Waypoint>& waypoints) {
  std::vector<MeasuredPlace> places;
  for (const Waypoint& w : waypoints)
    if (w.place) places.push_back({w.segment, w.fraction, w.before});
  return places;
}

void check_same_places(const std::vector<MeasuredPlace>& expected, const std::vector<MeasuredPlace>& found) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    CAPTURE(expected[i].segment);
    CAPTURE(expected[i].fraction);
    REQUIRE(found[i].segment == expected[i].segment);
    REQUIRE(found[i].fraction == expected[i].fraction);
  }
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(expected[i].segment);
    CAPTURE(expected[i].fraction);
    CHECK(found[i].segment == expected[i].segment);
    CHECK(found[i].fraction == expected[i].fraction);
    CHECK((found[i].before - expected[i].before).cwiseAbs().maxCoeff() < 1e-10);
  }
}

void check_runs_agree_before(const Order& order) {
  const Shop shop(order);
  const ForwardRun predicted = solve_pieces(shop.job(), original_pieces(shop.job()), {.inside = false});
  REQUIRE(!predicted.failure);
  const Compensation verified = judged(shop, order.text);
  const std::vector<MeasuredPlace> expected = measured_places(predicted.waypoints);
  CHECK(expected.size() > 100);
  const auto first = std::ranges::find_if(expected, [](const auto& at) { return at.segment != no_segment; });
  REQUIRE(first != expected.end());
  CHECK(first->fraction == 0);  // the start of the first feed, behind a rapid from an unknown place
  check_same_places(expected, measured_places(verified.waypoints));
  check_same_places(expected, measured_places(compensated(shop).waypoints));
}

double largest_miss_after(const std::vector<Waypoint>& waypoints) {
  double largest = 0;
  for (const Waypoint& w : waypoints) largest = std::max(largest, w.after.head<3>().norm());
  return largest;
}

}  // namespace

TEST_CASE("predict, verify and compensate find the same deviation before, at the same places") {
  const ForceSource forces[] = {{},
                                constant_force(milling()),
                                constant_force(milling(), 0),
                                step_profile("0, 50, 0, 0\n60, 215, -10, -25\n140, 20, 100, -25\n", 0),
                                step_profile("0, 50, 0, 0\n60, 215, -10, -25\n140, 20, 100, -25\n", 2e-3)};
  for (const ForceSource& force : forces)
    for (const bool in_batches : {false, true}) {
      CAPTURE(in_batches);
      check_runs_agree_before({.machine = rigid_gantry("0, 0, 0", 0.05 * deg),
                               .text = all_ways,
                               .force = force,
                               .in_batches = in_batches});
      const bool slow = !in_batches && &force != &forces[1];  // one by one
      if (slow) continue;
      check_runs_agree_before({.machine = load_machine(orthoglide_b),
                               .text = all_ways,
                               .force = force,
                               .in_batches = in_batches});
    }
}

TEST_CASE(
    "where the force steps the deviation before is known on both sides, where a move begins and inside it") {
  const Shop shop({.machine = load_machine(small_mill),
                   .text = "G21 G90 F500\nG0 X0 Y0 Z0\nG1 X50\nG1 X100\nM30\n",
                   .force = step_profile("0, 0, 0, 0\n50, 500, 0, 0\n72, 0, 0, 0\n", 0)});
  const ForwardRun predicted = solve_pieces(shop.job(), original_pieces(shop.job()), {.inside = false});
  const auto at = [](const std::vector<Waypoint>& waypoints, double s_mm, double force) {
    return std::ranges::find_if(waypoints, [&](const Waypoint& w) {
      return w.place && std::abs(w.s - s_mm * mm) < 1e-9 && w.wrench.x() == force;
    });
  };
  const Compensation written = compensated(shop);
  for (const std::vector<Waypoint>& waypoints : {predicted.waypoints, written.waypoints})
    for (const double s_mm : {50.0, 72.0}) {
      CAPTURE(s_mm);
      const auto free = at(waypoints, s_mm, 0), loaded = at(waypoints, s_mm, 500);
      REQUIRE(free != waypoints.end());
      REQUIRE(loaded != waypoints.end());
      CHECK((loaded->before - free->before).head<3>().norm() > 5e-6);
      CHECK(free->weight + loaded->weight > 0);
    }
}

TEST_CASE("verify finds a wrong circle along which the correction is constant") {
  // The start, the middle and the end of the circle are where this machine is right.
  for (const std::string turns : {"", " P2", " P8", " P64"}) {
    CAPTURE(turns);
    const std::string bore =
        "G21 G90\nG0 X25 Y0 Z5\nG1 Z-5 F300\nG3 X25 Y0 I-25 J0" + turns + " F600\nG0 Z20\nM30\n";
    const Shop shop({.machine = rigid_gantry("0, 0, 0", 0.05 * deg), .text = bore});
    const Compensation run = judged(shop, bore);
    CHECK(largest_miss_after(run.waypoints) == doctest::Approx(25e-3 * std::sin(0.05 * deg)).epsilon(1e-3));
    const auto failure = tolerance_failure(shop.job(), run.waypoints);
    REQUIRE(failure);
    CHECK(failure->kind == ErrorKind::not_compensated);
    CHECK(failure->line == 4);
  }
}

TEST_CASE("what verify finds does not depend on its tolerance") {
  Order order{
      .machine = load_machine(small_mill),
      .text = "G21 G90 F500\nG0 X0 Y0 Z0\nG1 X250\nG1 Y250\nG1 X0 Y0\nM30\n",
      .force = step_profile("0, 50, 0, 0\n60, 215, -10, -25\n340, 20, 100, -25\n600, 250, 100, 30\n", 2e-3)};
  const Shop shop(order);
  const Compensation written = compensated(shop);
  REQUIRE(written.counts.inserted_blocks > 0);
  const double expected = largest_miss_after(written.waypoints);
  for (const double times : {2., 5., 10.}) {
    CAPTURE(times);
    order.tolerance = times * shop.job().options.tolerance;
    const Shop other(order);
    const Compensation found = judged(other, written.text);
    CHECK(largest_miss_after(found.waypoints) < expected + 1e-6);
  }
}

// The circle begins at several of its points, between which its places are elsewhere.
TEST_CASE("the largest deviation around a circle with a turning force is found wherever the circle begins") {
  ForceSource force;
  force.rules = read_force_csv(
      "# frame = feed\n# sense = on_tool\nline, fx_N, fy_N, fz_N\n1, 300, 100, -40\n", "forces.csv");
  force.blend = 0;
  const std::string machine = replaced(read_file(small_mill), "[2e-7, 2e-7,", "[2e-7, 1e-8,");
  double least = 1, most = 0;
  for (const double begin_deg : {0.0, 5.0, 11.25, 17.0}) {
    const double x = 3 * std::cos(begin_deg * deg), y = 3 * std::sin(begin_deg * deg);
    const std::string circle =
        fmt::format("G0 X{0:.6f} Y{1:.6f} Z0\nG3 X{0:.6f} Y{1:.6f} I{2:.6f} J{3:.6f}", x, y, -x, -y);
    const Shop shop({.machine = read_machine(machine, "mill.toml"),
                     .text = "G21 G90 G17\n" + circle + " F600\nM30\n",
                     .force = force});
    const ForwardRun predicted = solve_pieces(shop.job(), original_pieces(shop.job()), {.inside = false});
    REQUIRE(!predicted.failure);
    double largest = 0;
    for (const Waypoint& w : predicted.waypoints)
      if (w.cutting) largest = std::max(largest, w.before.head<3>().norm());
    least = std::min(least, largest);
    most = std::max(most, largest);
  }
  CHECK(least > (1 - 4e-4) * most);
}
