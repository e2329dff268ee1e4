// Contours under G41 and G42 that are divided: the tool must still fit into their inner corners.
#include "compensation/emit/contour_radius.hpp"

#include <cmath>

#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

ContourWay contour_line(double x0, double y0, double x1, double y1) {
  return {.curve = {Vector3(x0, y0, 0), Vector3(x1, y1, 0)}};
}

ContourWay contour_arc(const Vector3& centre, double radius, double from, double sweep) {
  const auto at = [&](double angle) -> Vector3 {
    return centre + radius * Vector3(std::cos(angle), std::sin(angle), 0);
  };
  const Vector3 normal(0, 0, sweep > 0 ? 1 : -1);
  return {.curve = {at(from), at(from + sweep), Arc{centre, normal, std::abs(sweep)}}};
}

ContourWay divided_way(ContourWay way, double first_mm, double last_mm) {
  way.is_divided = true;
  way.first_mm = first_mm;
  way.last_mm = last_mm;
  return way;
}

// The frame is turned about X: heights change along Y.
Machine leaning_gantry(double angle) {
  Machine machine = perfect_gantry();
  std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(angle, 0, 0));
  return machine;
}

Compensation corrected_contour(const std::string& blocks, double angle, double tolerance = 10 * um) {
  const std::string text = "%\nO1\nG21 G90 G17 G40 G54\nT10 M6\nG0 X50. Y50. Z50.\nZ5.\nG1 Z-1. F200.\n" +
                           blocks + "G0 Z50.\nM30\n%\n";
  return compensated(Shop({.machine = leaning_gantry(angle),
                           .text = text,
                           .tolerance = tolerance,
                           .read = {.dialect = "fanuc"}}));
}

}  // namespace

TEST_CASE("an inner corner of two lines lets the radius through whose shortening the lines have") {
  for (const double turn : {10 * deg, 45 * deg, 90 * deg, 150 * deg}) {
    CAPTURE(turn);
    const std::vector<ContourWay> ways{contour_line(-30, 0, 0, 0),
                                       contour_line(0, 0, 20 * std::cos(turn), 20 * std::sin(turn))};
    const ContourRadius radius = largest_radius(ways, false);
    CHECK(radius.mm == doctest::Approx(std::min(20 / std::tan(turn / 2), largest_tool_radius_mm)));
    if (radius.mm < largest_tool_radius_mm) CHECK(radius.way == 1);
    auto right = ways;
    for (ContourWay& way : right) way.side = CutterSide::right;
    CHECK(largest_radius(right, false).mm == largest_tool_radius_mm);
  }
}

TEST_CASE("a line between two inner corners is shortened at both ends, a piece of it at one") {
  std::vector<ContourWay> ways{contour_line(-100, 0, 0, 0), contour_line(0, 0, 0, 20),
                               contour_line(0, 20, -100, 20)};
  CHECK(largest_radius(ways, false).mm == doctest::Approx(10));
  ways[1] = divided_way(ways[1], 10, 10);
  CHECK(largest_radius(ways, true).mm == doctest::Approx(10));
  ways[1] = divided_way(ways[1], 15, 2);
  CHECK(largest_radius(ways, true).mm == doctest::Approx(2));
  CHECK(largest_radius(ways, true).way == 1);
  CHECK(largest_radius(ways, false).mm == doctest::Approx(10));
}

TEST_CASE("half a disc lets a circle in that touches its arc and its chord") {
  std::vector<ContourWay> ways{contour_line(-50, 0, 50, 0), contour_arc(Vector3::Zero(), 50, 0, pi),
                               contour_line(-50, 0, 50, 0)};
  CHECK(largest_radius(ways, false).mm == doctest::Approx(25));
  // It touches the arc 22.5 degrees behind the corner: (50 - r) sin 22.5 deg = r.
  const double piece = 50 * pi / 8, s = std::sin(pi / 8);
  ways[1] = divided_way(ways[1], piece, piece);
  CHECK(largest_radius(ways, true).mm == doctest::Approx(50 * s / (1 + s)));
}

TEST_CASE("inner arcs let no larger radius through than their own, outer ones do") {
  CHECK(largest_radius({contour_arc(Vector3::Zero(), 8, 0, pi)}, false).mm == doctest::Approx(8));
  CHECK(largest_radius({contour_arc(Vector3::Zero(), 8, 0, -pi)}, false).mm == largest_tool_radius_mm);
}

TEST_CASE("a line that meets an outer arc lets the circle through that touches the line at its begin") {
  // At (50, -r), and r + 20 from the centre of the arc.
  CHECK(largest_radius({contour_line(50, 0, 20, 0), contour_arc(Vector3::Zero(), 20, 0, -2)}, false).mm ==
        doctest::Approx((50.0 * 50 - 20 * 20) / (2 * 20)));
}

TEST_CASE("the flat parts beside chamfers at inner corners of a contour are as long as the tool needs them") {
  const Compensation inside = corrected_contour(
      "G42 D10 X50. Y20. F300.\nX20. ,C4.\nY80. ,C4.\nX80. ,C4.\nY20. ,C4.\nX45.\nG40 Y50.\n", 8e-4);
  CHECK(inside.narrowed.empty());
  const Compensation outside = corrected_contour(
      "G41 D10 X50. Y20. F300.\nX20. ,C4.\nY80. ,C4.\nX80. ,C4.\nY20. ,C4.\nX45.\nG40 Y50.\n", 8e-4);
  CHECK(outside.narrowed.empty());
  const auto shortest = [](const Compensation& result) {
    double least = HUGE_VAL;
    for (const Move& move : moves_in(result.text))
      if (move.cutter_side != CutterSide::none)
        least = std::min(least, (move.end_mm - move.start_mm).head<2>().norm());
    return least;
  };
  CHECK(shortest(inside) > 4 * (1 + std::sqrt(0.5)));
  CHECK(shortest(outside) < 1.1 * 4);
}

TEST_CASE("a contour whose arc is divided beside an inner corner is listed with the radii that pass") {
  const std::string disc = "G41 D10 X-1. Y0. F300.\nX50.\nG3 X-50. Y0. I-50. J0.\nG1 X1.\nG40 X0. Y22.\n";
  const Compensation result = corrected_contour(disc, 1e-3);
  REQUIRE(result.narrowed.size() == 1);
  CHECK(result.narrowed[0].line == 10);
  CHECK(result.narrowed[0].tool == 10);
  CHECK(result.narrowed[0].programmed_mm == doctest::Approx(25));
  const double s = std::sin(pi / 8);
  CHECK(result.narrowed[0].written_mm == doctest::Approx(50 * s / (1 + s)).epsilon(1e-3));
  CHECK(corrected_contour(disc, 1e-3, 1 * mm).narrowed.empty());
  std::string with_rapid = disc;
  with_rapid.replace(with_rapid.find("G1 X1."), 6, "G0 X1.");
  REQUIRE(corrected_contour(with_rapid, 1e-3).narrowed.size() == 1);
  CHECK(corrected_contour(with_rapid, 1e-3).narrowed[0].written_mm == result.narrowed[0].written_mm);
  const std::string outer = "G42 D10 X0.5 Y0. F300.\nX50.\nG3 X-50. Y0. I-50. J0.\nG1 X0.6\nG40 X0. Y-22.\n";
  CHECK(corrected_contour(outer, 1e-3).narrowed.empty());
}

TEST_CASE("in LinuxCNC the block that approaches a contour takes a part of the first line, too") {
  const std::string text =
      "G21 G90 G17 G40 G54\nT10 M6\nG0 X0 Y22 Z50\nZ5\nG1 Z-1 F200\nG41 D10 X0.5 Y0 F300\nX50\nG3 X-50 Y0 "
      "I-50 J0\nG1 X0.6\nG40 X0 Y22\nG0 Z50\nM30\n";
  const Compensation result =
      compensated(Shop({.machine = leaning_gantry(1e-3), .text = text, .tolerance = 10 * um}));
  REQUIRE(result.narrowed.size() == 1);
  CHECK(result.narrowed[0].programmed_mm ==
        doctest::Approx(20.7005).epsilon(1e-5));  // its interpreter: the same
}

namespace {

// The diameter of the tool in a contour whose first blocks are `cutter`, with X0.5 Y0 in the last of them.
std::optional<double> stated_diameter(const std::string& cutter, bool evaluate = false,
                                      const std::string& behind = "X50\n") {
  const std::string text = "G21 G90 G17 G40 G54\nT10 M6\nG0 X0 Y22 Z50\nZ5\nG1 Z-1 F200\n" + cutter +
                           "X0.5 Y0 F300\n" + behind +
                           "G3 X-50 Y0 I-50 J0\nG1 X0.6\nG40 X0 Y22\nG0 Z50\nM30\n";
  const Compensation result = compensated(Shop({.machine = leaning_gantry(1e-3),
                                                .text = text,
                                                .tolerance = 10 * um,
                                                .read = {.dialect = "linuxcnc", .evaluate = evaluate}}));
  REQUIRE(result.narrowed.size() == 1);
  return result.narrowed[0].diameter_mm;
}

}  // namespace

TEST_CASE("D of G41.1 is the diameter of the tool in a contour, where it is a number") {
  CHECK(stated_diameter("G41.1 D20 ") == 20.0);
  CHECK(stated_diameter("g41.1 (D7) d 12.5 ") == 12.5);
  CHECK(stated_diameter("D8 G41.1 ; D9\n") == 8.0);
  CHECK(stated_diameter("G041.1 D8 ") == 8.0);
  CHECK(!stated_diameter("G41 D10 "));
  CHECK(!stated_diameter("G41.1 D#<_d> "));
}

TEST_CASE("D of G41.1 is a variable whose value is worked out") {
  CHECK(stated_diameter("#1=12\nG41.1 D#1 ", true) == 12.0);
  CHECK(!stated_diameter("#1=12\nG41.1 D#1 "));
}

TEST_CASE("D of G41.1 holds behind a position that is not known, and not where '/' may change it") {
  CHECK(stated_diameter("G41.1 D20 ", false, "X20\nX#<_x>\nX30 Y0\nX50\n") == 20.0);
  CHECK(!stated_diameter("G41.1 D20 ", false, "X20\n/G41.1 D12\nX21\nX30 Y0\nX50\n"));
}
