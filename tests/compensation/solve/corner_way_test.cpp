#include "compensation/solve/corner_way.hpp"

#include <Eigen/Geometry>
#include <array>

#include "compensation/support/gantry.hpp"
#include "compensation/support/window_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double error = 2e-4;  // rad: by which Y of the gantry is turned against X

// X 140 Y 10 is the corner of 69 degrees that is rounded by `size`.
std::string rounded(const std::string& size) {
  return "%\nO1\nG21 G90 G17 G54\nG0 X0. Y10. Z0.\nG1 X140. ,R" + size + " F600\nX90. Y140.\nM30\n%\n";
}

struct Fillet {
  Eigen::Vector2d centre, begin, end;
};

// Between the lines from `p` to `q` and from `q` to `r`, by half angles.
Fillet fillet(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r, double radius) {
  const Eigen::Vector2d a = (p - q).normalized(), b = (r - q).normalized(), middle = (a + b).normalized();
  const double half = std::acos(a.dot(b)) / 2;
  return {q + radius / std::sin(half) * middle, q + radius / std::tan(half) * a,
          q + radius / std::tan(half) * b};
}

// The distance of a point from the circle of the fillet (mm).
double distance(const Fillet& way, const Eigen::Vector2d& p) {
  return std::abs((p - way.centre).norm() - (way.begin - way.centre).norm());
}

Eigen::Vector2d on(const Fillet& way, double u) {
  const Eigen::Vector2d from = way.begin - way.centre, to = way.end - way.centre;
  const double angle = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  return way.centre + Eigen::Rotation2Dd(u * angle) * from;
}

// What the rounding between written lines misses, across its way (mm).
double largest_miss_mm(const std::vector<Move>& lines, double radius) {
  const auto place = [](const Vector3& p) { return Eigen::Vector2d(p.head<2>()); };
  const Fillet wanted = fillet({0, 10}, {140, 10}, {90, 140}, radius),
               written =
                   fillet(place(lines[0].start_mm), place(lines[0].end_mm), place(lines[1].end_mm), radius);
  double largest = 0;
  for (int i = 0; i <= 1000; ++i) {
    const Eigen::Vector2d target = on(written, i / 1e3);
    const Eigen::Vector2d tip(target.x() - std::sin(error) * target.y(), std::cos(error) * target.y());
    largest = std::max(largest, distance(wanted, tip));
  }
  return largest;
}

double largest_in_corners(const std::vector<Waypoint>& waypoints) {
  double largest = 0;
  for (const Waypoint& w : waypoints)
    if (w.in_corner) largest = std::max(largest, w.after.head<3>().norm());
  return largest;
}

std::vector<Move> feeds_in(const std::string& text, const std::string& file = "part.nc") {
  std::vector<Move> feeds;
  for (const Move& move : read_program(text, file, {}).moves)
    if (move.motion == Motion::feed) feeds.push_back(move);
  return feeds;
}

// The ends of a chamfer between the first two moves that takes `side` mm from both.
std::array<Vector3, 2> chamfer_ends(const std::vector<Move>& feeds, double side) {
  const Curve before = curve_of(feeds[0]), after = curve_of(feeds[1]);
  return {point_at(before, 1 - side / length(before)), point_at(after, side / length(after))};
}

void check_touches(const Curve& way, const Vector3& direction_before, const Vector3& direction_behind) {
  CHECK((direction_at(way, 0) - direction_before).norm() < 1e-9);
  CHECK((direction_at(way, 1) - direction_behind).norm() < 1e-9);
}

}  // namespace

TEST_CASE("the rounding of a corner touches both of its sides, lines or arcs") {
  const Vector3 corner(50, 0, 3);
  const Curve line{{0, 0, 3}, corner, {}}, up{corner, {50, 40, 3}, {}};
  const auto square = corner_way(line, up, CornerKind::round, 5);
  REQUIRE(square);
  CHECK((square->start - Vector3(45, 0, 3)).norm() < 1e-12);
  CHECK((square->end - Vector3(50, 5, 3)).norm() < 1e-12);
  check_touches(*square, {1, 0, 0}, {0, 1, 0});
  for (const double side : {-1, 1})
    for (const double turn : {0.3, 1.5, 2.5}) {
      CAPTURE(side);
      CAPTURE(turn);
      const Vector3 begins(std::cos(turn), std::sin(turn), 0), z(0, 0, side);
      const Vector3 centre = corner + 30 * z.cross(begins);
      const Curve arc{corner, centre + exp_so3(0.8 * z) * (corner - centre), Arc{centre, z, 0.8}};
      const auto way = corner_way(line, arc, CornerKind::round, 2);
      REQUIRE(way);
      CHECK(std::abs((way->start - way->arc->centre).norm() - 2) < 1e-9);
      CHECK(std::abs((way->end - centre).norm() - 30) < 1e-9);
      check_touches(*way, {1, 0, 0}, z.cross(way->end - centre) / 30);
    }
  CHECK(!corner_way(line, up, CornerKind::round, 41));
  CHECK(!corner_way(line, {corner, {90, 0, 3}, {}}, CornerKind::round, 5));
  CHECK(corner_way(line, up, CornerKind::side, 5)->start == Vector3(45, 0, 3));
  CHECK(std::abs(length(*corner_way(line, up, CornerKind::chamfer, 5)) - 5) < 1e-12);
}

TEST_CASE("a rounding that the control inserts is judged where the control makes it") {
  for (const double radius : {1., 20., 60.}) {
    CAPTURE(radius);
    const Shop shop(
        {.machine = rigid_gantry("0, 0, 0", error), .text = rounded(fmt::format("{:.1f}", radius))});
    const Compensation result = compensated(shop);
    const double expected = largest_miss_mm(feeds_in(result.text), radius) * mm;
    CHECK(std::abs(largest_in_corners(result.waypoints) - expected) < 0.01 * expected);
  }
}

TEST_CASE("a corner of unknown size, and one that does not fit, is judged as the largest that fits") {
  for (const char* size : {"#1", "500."}) {
    CAPTURE(size);
    const Shop shop({.machine = rigid_gantry("0, 0, 0", error), .text = rounded(size)});
    const Compensation result = compensated(shop);
    const double expected =
        largest_miss_mm(feeds_in(result.text), 0.95 * 139.28 * std::tan(0.5 * 1.2036)) * mm;
    CHECK(std::abs(largest_in_corners(result.waypoints) - expected) < 0.05 * expected);
  }
}

TEST_CASE("a rounding that begins a little earlier than the wanted one does not miss it") {
  std::string text = "%\nO1\nG21 G90 G17 G54\nG0 X0. Y0. Z0.\nG1 F600\n";
  double x = 0, y = 0;
  for (int i = 0; i < 12; ++i) {
    x += 20 * std::cos(2 * deg * i), y += 20 * std::sin(2 * deg * i);
    text += fmt::format("X{:.3f} Y{:.3f} ,R400.\n", x, y);
  }
  const Shop shop({.machine = rigid_gantry("0, 0, 0", error), .text = text + "X400. Y400.\nM30\n%\n"});
  const Compensation result = compensated(shop);
  CHECK(largest_in_corners(result.waypoints) > 0);
  CHECK(largest_in_corners(result.waypoints) < 1.5 * um);
}

TEST_CASE("windows do not part the sides of a corner") {
  for (const char* z : {"", " Z0."}) {
    CAPTURE(z);
    std::string text = "%\nO1\nG21 G90 G17 G54\nG0 X0. Y0. Z0.\nG1 F600\n";
    for (int i = 1; i < 100; ++i)
      text += fmt::format("X{}. Y{}.{}{}\n", 3 * i, 40 * (i % 2), z, i % 3 == 0 ? "" : " ,R2.");
    const Order order{.machine = rigid_gantry("0, 0, 0", error), .text = text + "M30\n%\n"};
    const WindowRun whole = in_windows(order, 1000), parts = in_windows(order, 8);
    CHECK(parts.windows > 5);
    CHECK(std::ranges::count_if(whole.waypoints, &Waypoint::in_corner) >= 66 * 17);
    CHECK(largest_in_corners(parts.waypoints) == largest_in_corners(whole.waypoints));
    CHECK(parts.waypoints.size() == whole.waypoints.size());
  }
}

TEST_CASE("a chamfer beside an arc is judged, too") {
  const std::string text =
      "0 BEGIN PGM P MM\n1 TOOL CALL 1 Z S1000\nL X+0 Y+10 Z+0 R0 FMAX\nL X+140 F600\nCHF 30\n"
      "CR X+90 Y+140 R+200 DR+\nEND PGM P MM\n";
  const Shop shop({.machine = rigid_gantry("0, 0, 0", error), .text = text});
  const Compensation result = compensated(shop);
  const std::array<Vector3, 2> wanted = chamfer_ends(feeds_in(text, "part.h"), 30),
                               written = chamfer_ends(feeds_in(result.text, "part.h"), 30);
  const Vector3 across = Vector3::UnitZ().cross(wanted[1] - wanted[0]).normalized();
  double expected = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3& target = written[i];
    const Vector3 tip(target.x() - std::sin(error) * target.y(), std::cos(error) * target.y(), 0);
    expected = std::max(expected, std::abs(across.dot(tip - wanted[i])) * mm);
  }
  CHECK(expected > 1 * um);
  CHECK(std::abs(largest_in_corners(result.waypoints) - expected) < 0.01 * expected);
}
