// Every move of a corrected program goes as the original's: rapid, line or arc, in its sense, plane and
// turns.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// What follows `G1 Z#1`, after which Z is not known, and a program whose first Z comes late.
const char* const held =
    "G21 G90 G17\nG0 X0 Y0 Z5\n/G0 Z7\nG1 X30 Y10 F200\nG2 X50 Y10 I10 J0\nG3 X30 Y10 R10\nM30\n";
const char* const pending = "G21 G90 G17\nG0 X30 Y10\nG2 X50 I10 J0 F200\nG1 X60\nG0 Z5\nG1 X20\nM30\n";
const char* const whole =
    "G21 G90 G17\nG0 X30 Y0 Z0\nG3 X-30 Y0 I-30 J0 F600\nG2 X-20 Y0 I5 J0\nG1 X0\nM30\n";

/// The line of `text` that begins with `start`, with that text in its place.
std::string with_line(const std::string& text, const std::string& start, const std::string& by) {
  std::string changed;
  bool done = false;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const bool this_one = !done && lines[i].starts_with(start);
    changed += (this_one ? by : lines[i]) + "\n";
    done = done || this_one;
  }
  REQUIRE(done);
  return changed;
}

struct Kinds {
  Motion motion;
  bool arc, clockwise;
  int turns;
  bool operator==(const Kinds&) const = default;
};

std::vector<Kinds> kinds_of(const std::string& text) {
  std::vector<Kinds> kinds;
  for (const Move& move : read_program(text, "part.ngc", {}).moves)
    kinds.push_back(
        {move.motion, move.arc.has_value(), move.arc && move.arc->clockwise, move.arc ? move.arc->turns : 0});
  return kinds;
}

}  // namespace

TEST_CASE("moves that are held, or wait for the first known position, keep their kind and sense") {
  for (const std::string text : {held, pending}) {
    CAPTURE(text);
    const Shop shop({.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = text});
    const Compensation result = compensated(shop);
    CHECK(kinds_of(result.text) == kinds_of(text));
    CHECK(result.text != text);
    CHECK(refusal_of(shop, result.text) == "");
  }
}

TEST_CASE("a line in the place of an arc is refused with both lines, held moves included") {
  for (const std::string text : {held, pending, whole}) {
    const Shop shop({.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = text});
    const std::string right = compensated(shop).text;
    for (const Move& move : read_program(right, "corrected.ngc", {}).moves) {
      if (!move.arc) continue;
      CAPTURE(move.line);
      const std::string line = lines_of(right)[static_cast<std::size_t>(move.line - 1)];
      const std::size_t feed = line.find('F');
      const std::string chord = "G1" + line.substr(2, line.find_first_of("IR") - 2) +
                                (feed == std::string::npos ? "" : line.substr(feed));
      const auto failure = judged(shop, replaced(right, line, chord)).failure;
      REQUIRE(failure);
      CHECK(failure->what.find("this block is a line, that of the original is an arc") != std::string::npos);
      CHECK(failure->corrected_line == move.line);
      CHECK(failure->line == move.line);
    }
  }
}

TEST_CASE(
    "an arc of the other sense, another plane, radius or centre is refused under a constant correction") {
  const Shop shop({.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = whole});
  const std::string right = compensated(shop).text;
  REQUIRE(refusal_of(shop, right) == "");
  CHECK(refusal_of(shop, replaced(right, "G3", "G2")).find("this arc goes clockwise") != std::string::npos);
  CHECK_FALSE(refusal_of(shop, replaced(right, "I-30 J0", "I-30 J10")).empty());
  const Shop pended({.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = pending});
  const std::string moved = compensated(pended).text;
  CHECK(refusal_of(pended, replaced(moved, "I10 J0", "I10 J0.5"))
            .find("the centre of this arc is off by 0.5000 mm") != std::string::npos);
  CHECK(refusal_of(pended, replaced(moved, "G2 X", "G3 X")).find("this arc goes counter-clockwise") !=
        std::string::npos);
}

TEST_CASE("a rapid in the place of a feed move, and a feed move in the place of a rapid, are refused") {
  const Shop shop({.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = whole});
  const std::string right = compensated(shop).text;
  CHECK_FALSE(refusal_of(shop, replaced(right, "G1 X", "G0 X")).empty());
  CHECK_FALSE(refusal_of(shop, replaced(right, "G0 X", "G1 X")).empty());
}

TEST_CASE("a held move that is shifted by more than a correction may be is refused") {
  Order order{.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = pending};
  order.max_correction = 1e-3;
  const Shop shop(order);
  const std::string right = compensated(shop).text;
  CHECK(refusal_of(shop, with_line(right, "G1 X59.5", "G1 X69.5")).find("X is shifted by") !=
        std::string::npos);
}

TEST_CASE("a helix of many turns is verified with the numbers of its compensation" *
          doctest::test_suite("long")) {
  for (const int turns : {1, 2, 8, 32, 99}) {
    CAPTURE(turns);
    for (const bool loaded : {false, true}) {
      CAPTURE(loaded);
      Order order{.machine = load_machine(small_mill),
                  .text = "G21 G90 G17\nG0 X30 Y0 Z0\nG3 X30 Y0 Z-8 I-30 J0 P" + std::to_string(turns) +
                          " F600\nG1 X35\nM30\n"};
      if (loaded) order.force = step_profile("0, 0, 0, 0\n0.2, 120, -90, -25\n180, 0, 100, 0\n", 2e-3);
      const Shop shop(order);
      const Compensation result = compensated(shop);
      const Compensation found = judged(shop, result.text);
      if (found.failure) MESSAGE(found.failure->what);
      REQUIRE(!found.failure);
      REQUIRE(found.waypoints.size() == result.waypoints.size());
      for (std::size_t i = 0; i < found.waypoints.size(); ++i) {
        CHECK((found.waypoints[i].after - result.waypoints[i].after).norm() < 1e-10);
        CHECK(found.waypoints[i].fraction == result.waypoints[i].fraction);
      }
    }
  }
}

TEST_CASE("an uncorrected program of short moves is matched with itself, move by move") {
  std::string text = "G21 G90\nG0 X0 Y0 Z0\nG1 X250 F900\n";
  for (int i = 1; i < 200; ++i)
    text += "X" + std::to_string(250 + 0.05 * i) + " Y" + std::to_string(0.02 * (i % 7)) + "\n";
  const Shop shop({.machine = load_machine(small_mill), .text = text + "M30\n"});
  const Compensation found = judged(shop, shop.program.text);
  REQUIRE(!found.waypoints.empty());
  for (const Waypoint& w : found.waypoints)
    if (!w.between) CHECK((w.after - w.before).norm() < 1e-12);
}

// Corrections of this machine are larger than the radius, and arcs end in chords where no arc fits.
TEST_CASE("narrow helices of many turns are verified as they were written") {
  const std::string rows = "0, 0, 0, 0\n0.2, -120, -90, -25\n20, -20, 100, 0\n30, -60, 20, -50\n";
  ForceSource force;
  force.rules =
      read_force_csv("# frame = feed\n# sense = on_tool\ns_mm, fx_N, fy_N, fz_N\n" + rows, "forces.csv");
  const auto written_and_verified = [&](double blend, const std::string& arc) {
    CAPTURE(arc);
    force.blend = blend;
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F300\n" + arc + "\nG1 X11.756\nM30\n",
                     .force = force});
    CHECK(refusal_of(shop, compensated(shop).text) == "");
  };
  written_and_verified(5e-4, "G3 X0 Y0 Z-1.5 I0.081 J0.183 P33");
  written_and_verified(0, "G2 X0 Y0 Z-1.5 I-0.188 J0.068 P100");
}

// The force steps where the arc begins and where it ends, by as much as the correction.
TEST_CASE("arcs whose radius is that of their correction are verified as they were written") {
  ForceSource force;
  force.rules = read_force_csv(
      "# frame = machine\n# sense = on_tool\nline, fx_N, fy_N, fz_N\n"
      "1, 300, -200, -50\n4, -300, 400, -50\n5, 300, -200, -50\n",
      "forces.csv");
  force.blend = 0;
  for (const std::string radius : {"0.01", "0.02", "0.05", "0.1"})
    for (const std::string end : {" Y" + std::to_string(2 * std::stod(radius)), std::string(" Y0 Z-1.2")}) {
      const std::string arc = "G3 X0" + end + " I0 J" + radius;
      CAPTURE(arc);
      const Shop shop({.machine = load_machine(orthoglide_b),
                       .text = "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F300\n" + arc + "\nG1 X8 Y0\nM30\n",
                       .force = force});
      CHECK(refusal_of(shop, compensated(shop).text) == "");
    }
}

TEST_CASE("verify takes the digits of a corrected program from its words") {
  ForceSource force = step_profile("0, 0, 0, 0\n0.2, 120, -90, -25\n6.5, 0, 100, 0\n20, -60, 20, -50\n", 0);
  Order order{
      .machine = load_machine(small_mill),
      .text =
          "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG3 X0 Y0 Z-1 I-0.063 J0.19 P1\nG1 X-17.569 Y-1.088\nM30\n",
      .force = force,
      .tolerance = 2e-6,
      .decimals = 4};
  const std::string text = compensated(Shop(order)).text;
  order.decimals = -1;
  CHECK(refusal_of(Shop(order), text) == "");
}

TEST_CASE("verify refuses a word that is shifted by more than a correction may be, in any kind of check") {
  const std::string begin = "G21 G90 G17\nG0 X20 Y20 Z5\nG41 D1\nG1 X70 F200\nG40\nG1 X90\n";
  const Shop contour({.machine = rigid_gantry("0.5, -0.25, 0.125"), .text = begin + "G0 Z20\nM30\n"});
  const std::string right = compensated(contour).text;
  REQUIRE(refusal_of(contour, right) == "");
  CHECK(refusal_of(contour, replaced(right, "Z19.875", "Z-20")).find("Z is shifted by -40.0000 mm") !=
        std::string::npos);

  const Shop hole({.machine = rigid_gantry("0.5, -0.25, 0.125"),
                   .text = "G21 G90 G17\nG0 X20 Y20 Z5\nG81 X30 Y30 Z-5 R2 F100\nG80\nM30\n"});
  const std::string drilled = compensated(hole).text;
  REQUIRE(refusal_of(hole, drilled) == "");
  for (const char* retract : {"R-4.99", "R-2", "R1.8"}) {
    CAPTURE(retract);
    CHECK(refusal_of(hole, replaced(drilled, "R1.875", retract)).find("the retract plane R is shifted") !=
          std::string::npos);
  }
  CHECK(refusal_of(hole, replaced(drilled, "R1.875", "")).find("R of the original's hole is missing") !=
        std::string::npos);
}
