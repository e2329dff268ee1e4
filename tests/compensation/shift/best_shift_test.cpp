// The constant shift of work offsets, tool lengths and radii that leaves the least deviation.
#include <Eigen/Geometry>
#include <random>

#include "compensation/support/gantry.hpp"
#include "compensation/support/window_run.hpp"
#include "counterflex/compensation/constant_shift.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

ShiftFreedom one_offset(bool turns = false) {
  return {std::vector<std::size_t>(10, 0), 1, turns, !turns};
}

/// The waypoints of the program's places with a shift in effect.
std::vector<Waypoint> shifted(const Order& order, const ConstantShift& shift, std::size_t least_moves = 100) {
  WindowShop shop(order, least_moves);
  WindowRun run;
  REQUIRE_FALSE(predict_shifted_windows(*shop.windows, order.threads, shift, events_for(run)));
  std::erase_if(run.waypoints, [](const Waypoint& w) { return w.between && !w.place; });
  return run.waypoints;
}

/// At the ends of moves: places inside them depend on their rounded lengths.
std::vector<Waypoint> ends(std::vector<Waypoint> waypoints) {
  std::erase_if(waypoints, [](const Waypoint& w) { return w.fraction != 1; });
  return waypoints;
}

ConstantShift moved_by(const Pose& D) {
  return {std::vector<Pose>(10, D), {}, {}};
}

double largest(const std::vector<Waypoint>& waypoints) {
  double size = 0;
  for (const Waypoint& w : waypoints)
    if (w.cutting) size = std::max(size, w.after.head<3>().norm());
  return size;
}

/// Holes have no segment; the first position, which has none either, is 15 mm above the machine's zero.
double largest_with_holes(const std::vector<Waypoint>& waypoints) {
  double size = largest(waypoints);
  for (const Waypoint& w : waypoints)
    if (w.segment == no_segment && w.p_MT.z() < 10 * mm) size = std::max(size, w.after.head<3>().norm());
  return size;
}

/// The search as a run does it: the program is solved again in windows for every pass.
struct Found {
  ShiftFreedom freedom;
  BestShift best;
  std::vector<Waypoint> rest;
};

Found found_shift(const Order& order, const ShiftFreedom& freedom, std::size_t least_moves = 100) {
  Found found{freedom, {}, {}};
  WindowShop shop(order, least_moves);
  const auto pass = [&](const ConstantShift& shift, ShiftPlaces& places) {
    ProgramReader reader(shop.bytes, "part.ngc", order.read, least_moves);
    JobWindows windows({shop.model, shop.frames, order.ignored, order.force, shop.options, order.read,
                        &shop.tools, shop.starts ? &*shop.starts : nullptr},
                       reader);
    const auto solved = [&](const Job& job, const std::vector<Waypoint>& some) { places.add(job, some); };
    const auto nothing = [](const Job&) {};
    return predict_shifted_windows(windows, order.threads, shift,
                                   {nothing, nothing, solved, [](const Job&, const Compensation&) {}});
  };
  ShiftPlaces first(found.freedom);
  REQUIRE_FALSE(pass({}, first));
  found.best = best_shift(found.freedom, first, pass, order.threads, shop.starts ? &*shop.starts : nullptr);
  REQUIRE_FALSE(found.best.failure);
  found.rest = shifted(order, shift_of(found.freedom, found.best), least_moves);
  return found;
}

/// The least largest deviation that grids of shifts find, each finer than the one before, by predictions.
double searched(const Order& order, double reach) {
  constexpr int half = 2;
  Vector3 middle = Vector3::Zero();
  double least = HUGE_VAL;
  for (double step = reach / half; step > 2e-8; step *= 0.55) {
    const Vector3 about = middle;
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half; ++j)
        for (int k = -half; k <= half; ++k) {
          const Vector3 s = about + step * Vector3(i, j, k);
          const double rest = largest(shifted(order, moved_by(translation(s))));
          if (rest < least) least = rest, middle = s;
        }
  }
  return least;
}

const char* const pocket =
    "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z-2 F600\nX40\nG2 X60 Y20 I0 J20\nG1 Y60\nX-10 Y70 Z3\nX0 Y0 Z-2\nM30\n";

/// Axes that are not square: the deviation grows with the coordinates.
Order skewed(const std::string& text = pocket) {
  return {.machine = rigid_gantry("0.3, -0.1, 0.05", 4e-4, -6e-4),
          .text = text,
          .X_MW = translation({0.05, -0.02, 0.01})};
}

}  // namespace

TEST_CASE("with a shift in effect the start of a feed run is a place, as without one") {
  const std::vector<Waypoint> found =
      shifted(skewed("G21 G90 G54\nG0 X40 Y60 Z-2\nG1 X0 F600\nM30\n"), moved_by({}));
  const auto begins = [](const Waypoint& w) { return w.cutting && w.place && w.fraction == 0; };
  CHECK(std::ranges::count_if(found, begins) == 1);
}

TEST_CASE("with a shift in effect the tip is where the moved work offset puts it") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  for (const bool arm : {false, true}) {
    CAPTURE(arm);
    Order order = skewed();
    if (arm) {
      order.machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-spindle/machine.toml");
      order.X_MW = order.machine.work.at("G54").X_MW;
      order.text = "G21 G90 G54\nG0 X0 Y0 Z50\nG1 Z0 F600\nX80\nG2 X90 Y10 J10\nG1 Y60\nM30\n";
    }
    order.datum_shift = 1e-4 * any();
    const Pose D = translation(1e-4 * any());
    Order moved = order;
    moved.X_MW = D * order.X_MW;
    moved.datum_shift = Vector3::Zero();
    const std::vector<Waypoint> with = ends(shifted(order, moved_by(D))), other = ends(shifted(moved, {}));
    REQUIRE(with.size() == other.size());
    for (std::size_t i = 0; i < with.size(); ++i)
      CHECK((with[i].p_MT + with[i].after.head<3>() - (other[i].p_MT + other[i].after.head<3>())).norm() <
            1e-11);
  }
}

TEST_CASE("a turned base takes tip and orientation with it") {
  Order order{.machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml")};
  order.text =
      "def part():\n  movel(p[0.62, -0.26, 0.098, 3.1416, 0, 0], a=0.5, v=0.02)\n"
      "  movel(p[0.62, -0.16, 0.098, 3.1, 0.05, 0], a=0.5, v=0.02)\n"
      "  movel(p[0.52, -0.2, 0.128, 3.2, 0, 0.1], a=0.5, v=0.02)\nend\n";
  order.read.dialect = "ur";
  const Pose D{exp_so3({2e-4, -3e-4, 1e-4}), {1e-4, 2e-4, -1e-4}};
  Order moved = order;
  moved.X_MW = D;
  const std::vector<Waypoint> with = ends(shifted(order, moved_by(D))), other = ends(shifted(moved, {}));
  REQUIRE(with.size() == other.size());
  REQUIRE(with.size() > 1);
  for (std::size_t i = 0; i < with.size(); ++i) {
    CHECK((with[i].p_MT + with[i].after.head<3>() - (other[i].p_MT + other[i].after.head<3>())).norm() <
          1e-10);
    const Matrix3 R = exp_so3(with[i].after.tail<3>()) * *with[i].R_MT;
    const Matrix3 R_other = exp_so3(other[i].after.tail<3>()) * *other[i].R_MT;
    CHECK(rotation_between(R, R_other).norm() < 1e-9);
  }
}

TEST_CASE("a longer tool stays further back, and a larger cutter further from its contour") {
  Order order{.machine = perfect_gantry()};
  order.text =
      "G21 G90\nT1 M6\nG0 X0 Y-10 Z0\nG41 D1 G1 X0 Y0 F600\nY40\nG2 X20 Y60 I20\nG1 X60\nG40 X80\nT2 M6\n"
      "G0 X80 Y80 Z0\nG42 D2 G1 Y60\nY40\nG40 Y30\nM30\n";
  const double dl = 2e-4, dr = 1e-4;
  for (const Waypoint& w : shifted(order, {{}, {{1, dl}, {2, -dl}}, {}})) {
    if (w.segment == no_segment) continue;
    CAPTURE(w.line);
    const double back = w.line < 9 ? dl : -dl;
    if (w.line != 10) CHECK((w.after.head<3>() - Vector3(0, 0, back)).norm() < 1e-12);
  }
  std::size_t beside = 0;
  for (const Waypoint& w : shifted(order, {{}, {}, {{1, dr}, {2, 2 * dr}}})) {
    if (!w.cutting) continue;
    CAPTURE(w.line);
    CAPTURE(w.fraction);
    const Vector3 left = Vector3::UnitZ().cross(w.direction);
    Vector3 expected = Vector3::Zero();
    if (w.line == 4) expected = w.fraction * dr * Vector3(-1, 0, 0);  // towards the contour along Y
    if (w.line >= 5 && w.line <= 7) expected = dr * left;
    if (w.line == 8) expected = (1 - w.fraction) * dr * Vector3(0, 1, 0);
    if (w.line == 11) expected = w.fraction * 2 * dr * Vector3(-1, 0, 0);
    if (w.line == 12) expected = -2 * dr * left;
    if (w.line == 13) expected = (1 - w.fraction) * 2 * dr * Vector3(-1, 0, 0);
    CHECK((w.after.head<3>() - expected).norm() < 1e-10);
    beside += !expected.isZero(0);
  }
  CHECK(beside > 20);
}

TEST_CASE("a machine that is only displaced needs no more than its displacement in the work offset") {
  Order order{.machine = displaced_gantry(), .text = pocket};
  const Found found = found_shift(order, one_offset());
  CHECK((found.best.offsets[0].p - shift_mm * mm).norm() < 1e-9);
  CHECK(largest(found.rest) < 1e-9);
  CHECK(found.best.lengths.empty());
  CHECK(found.best.radii.empty());
  order.machine = perfect_gantry();
  CHECK(found_shift(order, one_offset()).best.offsets[0].p.norm() < 1e-12);
}

TEST_CASE("no shift near the best one leaves less") {
  const Order order = skewed();
  const Found found = found_shift(order, one_offset());
  const double rest = largest(found.rest);
  CHECK(std::abs(rest - found.best.largest) < 1e-12);
  CHECK(rest < 0.5 * largest(shifted(order, {})));
  CHECK(found.best.gap <= 0.01 * um);
  CHECK(found.best.passes <= 4);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 60; ++i) {
    const Vector3 near = std::pow(10.0, -4 - i % 4) * Vector3(normal(random), normal(random), normal(random));
    CHECK(largest(shifted(order, moved_by(translation(found.best.offsets[0].p + near)))) > rest - 0.01 * um);
  }
}

TEST_CASE("a touched datum changes the shift by its own, not the rest") {
  Order order = skewed();
  const Found found = found_shift(order, one_offset());
  order.datum_shift = Vector3(2e-4, -1e-4, 3e-4);
  const Found touched = found_shift(order, one_offset());
  CHECK((touched.best.offsets[0].p - found.best.offsets[0].p - order.datum_shift).norm() < 1 * um);
  CHECK(std::abs(touched.best.largest - found.best.largest) < 1e-8);
}

TEST_CASE("a second tool that is pushed away gets its length, relative to the first") {
  std::string text = "G21 G90 G54\n";
  for (const char* tool : {"T1 M6\n", "T2 M6\n"})
    text += std::string(tool) + "G0 X0 Y0 Z5\nG1 Z-2 F600\nX40\nY60\nX-10 Y70 Z3\nX0 Y0 Z-2\nG0 Z50\n";
  Order order{.machine = read_machine(R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[springs.head]
compliance_diag_si = [1e-9, 1e-9, 1e-6, 1e-9, 1e-9, 1e-9]
[[chain]]
name = "axes"
elements = [
  { actuator = "prismatic", axis = "x", min_mm = -1000, max_mm = 1000 },
  { actuator = "prismatic", axis = "y", min_mm = -1000, max_mm = 1000 },
  { actuator = "prismatic", axis = "z", min_mm = -1000, max_mm = 1000 },
  { spring = "head" },
]
)",
                                      "soft.toml"),
              .text = text + "M30\n"};
  order.force.blend = 0;
  ForceRule& rule = order.force.rules.emplace_back();
  rule.selector.tool = 2;
  rule.content = ConstantForce{(Vector6() << 0, 0, -100, 0, 0, 0).finished()};
  const Found found = found_shift(order, one_offset());
  CHECK(found.best.offsets[0].p.norm() < 1e-8);
  REQUIRE(found.best.lengths.size() == 1);
  CHECK(std::abs(found.best.lengths.at(2) - 1e-4) < 1e-8);
  CHECK(largest(found.rest) < 1e-8);
}

TEST_CASE("the places of cycles count in the search as those of feed moves") {
  Order order{.machine = displaced_gantry(),
              .text = "G21 G90 G54\nG0 X0 Y0 Z5\nG81 X5 Y5 Z-1 R2 F100\nX50 Y70\nG80\nM30\n"};
  CHECK((found_shift(order, one_offset()).best.offsets[0].p - shift_mm * mm).norm() < 1e-9);

  // Holes far from a short cut: the shift is the best one of all, not that of the cut.
  const std::string cut = "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z-1 F600\nX10\nY10\nG0 Z5\n";
  const std::string cycles = "G81 X150 Y80 Z-9 R2\nX-90 Y120\nG80\nM30\n";
  const std::string plunges = "G0 X150 Y80\nG0 Z2\nG1 Z-9\nG0 Z5\nG0 X-90 Y120\nG0 Z2\nG1 Z-9\nG0 Z5\nM30\n";
  const Found drilled = found_shift(skewed(cut + cycles), one_offset());
  const Found only_cut = found_shift(skewed(cut + "M30\n"), one_offset());
  CHECK(drilled.best.largest > 3 * only_cut.best.largest);
  CHECK(drilled.best.largest == doctest::Approx(largest_with_holes(drilled.rest)).epsilon(1e-9));
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 60; ++i) {
    const Vector3 near = std::pow(10.0, -4 - i % 4) * Vector3(normal(random), normal(random), normal(random));
    const Vector3 p = drilled.best.offsets[0].p + near;
    CHECK(largest_with_holes(shifted(skewed(cut + cycles), moved_by(translation(p)))) >
          drilled.best.largest - 0.01 * um);
  }
  // The way down to a hole is a part of the cut in feed moves alone: this deviation grows with the height.
  CHECK(found_shift(skewed(cut + plunges), one_offset()).best.largest > drilled.best.largest - 0.01 * um);
}

TEST_CASE("offsets that share no place each get their own least deviation") {
  Order order = skewed(
      "G21 G90 G54\nG0 X0 Y0 Z5\nG1 X10 F600\nY10\nX0 Y0\nG55\nG0 X0 Y0\nG1 X200\nY200 Z50\nX0 Y0 Z5\nM30\n");
  const ShiftFreedom freedom{{0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 2, false, true};
  const Found both = found_shift(order, freedom);
  const auto rest_of = [&](bool first) {
    double size = 0;
    for (const Waypoint& w : both.rest)
      if (w.cutting && (w.line < 6) == first) size = std::max(size, w.after.head<3>().norm());
    return size;
  };
  CHECK(rest_of(true) < 0.1 * rest_of(false));
  order.text = "G21 G90 G54\nG0 X0 Y0 Z5\nG1 X10 F600\nY10\nX0 Y0\nM30\n";
  CHECK(std::abs(rest_of(true) - found_shift(order, one_offset()).best.largest) < 2e-8);
}

TEST_CASE("a base hardly turns about a straight line, along which this changes little") {
  Order order{.machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-spindle/machine.toml")};
  order.X_MW = order.machine.work.at("G54").X_MW;
  order.force = constant_force((Vector6() << 100, 50, -80, 0, 0, 0).finished());
  for (const char* const way : {"X120", "Y120", "X120 Y90", "Y120\nX2\nY0"}) {
    CAPTURE(way);
    order.text = fmt::format("G21 G90 G54\nG0 X0 Y0 Z20\nG0 Z0\nG1 {} F600\nM30\n", way);
    const Found turned = found_shift(order, one_offset(true));
    CHECK(rotation_between(turned.best.offsets[0].R, Matrix3::Identity()).norm() < 0.3 * deg);
    CHECK(largest(turned.rest) <= found_shift(order, one_offset()).best.largest + 1e-8);
  }
}

TEST_CASE("neither windows nor threads change the shift") {
  std::string text = "G21 G90 G54\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int i = 1; i < 700; ++i) text += fmt::format("X{} Y{} Z{}\n", (i * 7) % 90, (i * 5) % 41, i % 3);
  Order order = skewed(text);
  const Found whole = found_shift(order, one_offset(), 100000);
  order.threads = 3;
  const Found parts = found_shift(order, one_offset(), 37);
  CHECK(whole.best.offsets[0] == parts.best.offsets[0]);
  CHECK(whole.best.largest == parts.best.largest);
  CHECK(whole.best.passes == parts.best.passes);
}

TEST_SUITE("long") {
  TEST_CASE("the rest is that of a grid search over predictions") {
    const Order order = skewed();
    const double rest = largest(found_shift(order, one_offset()).rest);
    CHECK(std::abs(rest - searched(order, 1e-3)) < 0.1 * um);
  }

  TEST_CASE("no base near the best one leaves less on a robot") {
    Order order{.machine = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml")};
    order.text = "def part():\n";
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 12; ++i)
      order.text += fmt::format("  movel(p[{:.4f}, {:.4f}, {:.4f}, 3.1, {:.3f}, 0], a=0.5, v=0.02)\n",
                                0.6 + 0.1 * unit(random), -0.2 + 0.1 * unit(random),
                                0.1 + 0.03 * unit(random), 0.1 * unit(random));
    order.text += "end\n";
    order.read.dialect = "ur";
    const Found found = found_shift(order, one_offset(true));
    const double rest = largest(found.rest);
    CHECK(rest < largest(shifted(order, {})));
    CHECK(rest < found_shift(order, one_offset()).best.largest);
    const Pose& best = found.best.offsets[0];
    const Vector3 about(0.6, -0.2, 0.1);
    for (int i = 0; i < 600; ++i) {
      const double size = std::pow(10.0, -3.5 - i % 4);
      const Vector3 p = size * Vector3(unit(random), unit(random), unit(random)),
                    w = 10 * size * Vector3(unit(random), unit(random), unit(random));
      const Pose near = translation(about + p) * rotation(exp_so3(w)) * translation(-about) * best;
      CHECK(largest(shifted(order, moved_by(near))) > rest - 0.1 * um);
    }
  }
}
