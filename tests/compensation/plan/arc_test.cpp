// Arcs: shifted ones stay what they are, sheared ones are refitted, halved, or become chords.
#include <numbers>

#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double half_digit_mm = 0.5e-3 + 1e-9;

/// Arcs as programs have them: omitted words, radii, three planes, helices, G90.1.
const char* const arcs =
    "G21 G90 G17\nG0 X10. Y-20. Z5.\nG1 Z-1. F300\nG2 X30. Y0. I20. J0.\nG3 X10. Y20. I-20.\nX-10. Y0. "
    "J-20.\n"
    "G2 X0. Y10. R10.\nG3 X20. Y10. R-15.\nG2 X40. Z-3. I10. J0.\nG18 G3 X50. Z7. I0. K10.\nG2 X60. Z-3. "
    "R10.\n"
    "G19 G2 Y20. Z-13. J0. K-10.\nG17\nG90.1 G2 X70. Y10. I60. J10.\nG91.1 G1 X0.\nG0 Z20.\nM30\n";

const char* const circles =
    "G21 G90\nG0 X10. Y0. Z5.\nG1 Z0. F300\nG2 X10. Y0. I-10. J0.\nG3 I-10. J0.\nG2 X10. Y0. Z-2. I-5. J0.\n"
    "G3 X10. Y-0.01 I-10. J-0.005\nG0 Z5.\nM30\n";

Vector3 radius_vector(const Move& move) {
  return move.start_mm - move.arc->centre_mm;
}

double sweep_of(const Move& move) {
  return curve_of(move).arc->sweep;
}

/// The largest distance between the ways of two arcs (mm), the first moved by `shift`.
double distance_mm(const Move& a, const Move& b, const Vector3& shift) {
  double largest = 0;
  for (int k = 0; k <= 32; ++k) {
    const double u = k / 32.0;
    largest = std::max(largest, (point_at(curve_of(a), u) + shift - point_at(curve_of(b), u)).norm());
  }
  return largest;
}

}  // namespace

TEST_CASE("a perfect machine gives back programs with arcs byte for byte") {
  for (const char* text : {arcs, circles}) {
    const Compensation result = compensated(Shop({.machine = perfect_gantry(), .text = text}));
    CHECK(result.text == text);
  }
}

TEST_CASE("a ramp of the force may be shorter than what it deflects the tip along an arc") {
  for (const double blend : {0.01 * mm, 0.015 * mm}) {
    CAPTURE(blend);
    const Shop shop({.machine = yielding_gantry(),
                     .text = "G21 G90 G17\nG0 X0 Y0 Z0\nG3 X10 I5 F500\nG0 Z5\nM30\n",
                     .force = constant_force((Vector6() << 0, -200, 0, 0, 0, 0).finished(), blend)});
    CHECK(dense_miss(shop, compensated(shop), 7).size <= shop.options.tolerance);
  }
}

TEST_CASE("a constant shift leaves arcs arcs, with the same I, J, K and R") {
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = arcs}));
  const std::vector<Move> before = arcs_in(arcs), after = arcs_in(result.text);
  REQUIRE(after.size() >= before.size());
  std::size_t a = 0;
  for (const Move& move : before) {
    CAPTURE(move.line);
    REQUIRE(a < after.size());
    double sweep = sweep_of(after[a]);
    if (sweep < 0.9 * sweep_of(move)) {
      sweep += sweep_of(after[++a]);  // halved: an R near half a turn
      CHECK(move.arc->radius_word);
    } else {
      CHECK(distance_mm(move, after[a], shift_mm) < 1.5e-3);
      CHECK((radius_vector(after[a]) - radius_vector(move)).norm() < 1e-3);
    }
    CHECK((after[a].end_mm - move.end_mm - shift_mm).cwiseAbs().maxCoeff() <= half_digit_mm);
    CHECK(sweep == doctest::Approx(sweep_of(move)).epsilon(1e-4));
    ++a;
  }
  CHECK(a == after.size());
}

TEST_CASE("a constant shift keeps the centre of an arc although its ends are rounded") {
  // In inches to 1/10000 ends are off by up to 1.3 µm. A centre fitted to such ends is off by 20 µm and more.
  std::string text = "G20 G90 G17 G91.1\nG0 X0.3000 Y0. Z0.\nF10.\n";
  for (int k = 1; k <= 12; ++k) {
    const double from = 0.5 * (k - 1), to = 0.5 * k;
    text += fmt::format("G3 X{:.4f} Y{:.4f} I{:.4f} J{:.4f}\n", 0.3 * std::cos(to), 0.3 * std::sin(to),
                        -0.3 * std::cos(from), -0.3 * std::sin(from));
  }
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = text + "M30\n"}));
  const std::vector<Move> before = arcs_in(text), after = arcs_in(result.text);
  REQUIRE(after.size() == before.size());
  for (std::size_t k = 1; k < after.size(); ++k) {
    CAPTURE(before[k].line);
    CHECK((radius_vector(after[k]) - radius_vector(before[k])).norm() < 1e-9);
    CHECK(sweep_of(after[k]) == doctest::Approx(sweep_of(before[k])).epsilon(2e-3));
  }
}

TEST_CASE("full and nearly full circles that change are written as two halves, which sweep them once") {
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = circles}));
  const std::vector<Move> before = arcs_in(circles), after = arcs_in(result.text);
  REQUIRE(before.size() == 4);
  std::size_t a = 0;
  for (const Move& move : before) {
    CAPTURE(move.line);
    REQUIRE(a < after.size());
    double sweep = sweep_of(after[a]);
    if (sweep < 4) sweep += sweep_of(after[++a]);
    CHECK(sweep == doctest::Approx(sweep_of(move)).epsilon(1e-3));
    CHECK((after[a].end_mm - move.end_mm - shift_mm).cwiseAbs().maxCoeff() <= half_digit_mm);
    CHECK((after[a].arc->centre_mm - move.arc->centre_mm - shift_mm).head<2>().norm() < 2e-3);
    ++a;
  }
  CHECK(a == after.size());
  CHECK(a >= 7);  // one of the circles has no end point, and may stay as it is
}

TEST_CASE("arcs on a machine out of square stay within the tolerance everywhere") {
  for (const char* text : {arcs, circles})
    for (const double angle : {1e-3, -1e-3}) {
      CAPTURE(angle);
      const Shop shop({.machine = rigid_gantry("0, 0, 0", angle), .text = text});
      const Compensation result = compensated(shop);
      const Miss miss = dense_miss(shop, result, 60);
      CAPTURE(miss.line);
      CAPTURE(miss.u);
      CHECK(miss.size <= 5e-6);
      CHECK(result.counts.inserted_blocks > 0);
      CHECK(result.counts.inserted_blocks < 60);  // sub-arcs, no chords
    }
}

TEST_CASE("a correction that waves about the middle of an arc's quarter does not pass for a line") {
  Order order{.machine = rigid_gantry("0, 0, 0", 0.05 * deg),
              .text = "G21 G90 G17\nG0 X0. Y0. Z0.\nG3 X80. Y80. I40. J40. F250\nM30\n"};
  const Shop shop(order);
  const Compensation result = compensated(shop);
  CHECK(dense_miss(shop, result, 60).size <= 5e-6);
  CHECK(result.counts.inserted_blocks < 8);
}

TEST_CASE("a circle across many positions of a table is divided until it follows all of them") {
  const Machine machine = slides(
      "[error_tables.x]\n"
      "positions_mm = [-70, -60, -50, -40, -30, -20, -10, 0, 10, 20, 30, 40, 50, 60, 70]\n"
      "EXX_um = [-10, 3.3, -0.6, 5.2, -2.5, 5.4, -4.5, 6, 4.6, -1.7, 0.8, 3.6, -6.1, 1.1, 6.1]\n"
      "EYX_um = [-2.8, 2, -3.9, 1.8, -8.2, 7.6, 0.5, -7.7, 3.3, -3.8, -6.1, -0.3, -7.2, -5.8, 7.3]\n",
      ", error_table = \"x\"", "");
  for (int tenths = 60; tenths <= 120; tenths += 2) {
    CAPTURE(tenths);
    const Shop shop({.machine = machine,
                     .text = "G21 G90 G17\nG0 X-60 Y0 Z0\nG2 I60 J0 F500\nM30\n",
                     .tolerance = 0.1e-6 * tenths});
    CHECK(dense_miss(shop, compensated(shop), 99).size <= 1.001 * shop.options.tolerance);
  }
}

TEST_CASE("an arc that eight pieces cannot follow is divided into more") {
  Order order{.machine = rigid_gantry("0, 0, 0", 20e-3),
              .text = "G21 G90\nG0 X0. Y0. Z0.\nG2 X100. Y0. I50. J0. F500\nG3 X120. Y20. I0. J20.\nM30\n",
              .decimals = 4};
  order.tolerance = 1e-6;
  const Shop shop(order);
  const Compensation result = compensated(shop);
  CHECK(result.text.find("G1") == std::string::npos);
  CHECK(result.counts.inserted_blocks > 16);
  CHECK(result.counts.inserted_blocks < 100);
  CHECK(dense_miss(shop, result, 20).size <= 1e-6);
}

TEST_CASE("arcs follow a force that steps, ramps and turns the correction along them" *
          doctest::test_suite("long")) {
  for (const double blend : {0.0, 2e-3}) {
    CAPTURE(blend);
    const Shop shop(
        {.machine = load_machine(orthoglide_b),
         .text = "G21 G90\nG0 X-40 Y0 Z0\nG1 Z-2 F300\nG2 X40 I40 J0 F600\nG3 X0 Y40 I-40 J0\nM30\n",
         .force = step_profile("0, 50, 0, 0\n60, 215, -10, -25\n140, 20, 100, -25\n", blend)});
    const Miss miss = dense_miss(shop, compensated(shop), 60);
    CAPTURE(miss.line);
    CAPTURE(miss.u);
    CHECK(miss.size <= 5e-6);
  }
}

TEST_CASE("under exact stop an arc stays one block, and its miss is listed") {
  const std::string text = "G21 G90 G61.1\nG0 X0. Y0. Z0.\nG2 X200. Y0. I100. J0. F500\nM30\n";
  const Compensation result = compensated(Shop({.machine = rigid_gantry("0, 0, 0", 1e-3), .text = text}));
  CHECK(result.counts.inserted_blocks == 0);
  REQUIRE(result.left_alone.size() == 1);
  CHECK(result.left_alone[0].line == 3);
  CHECK(result.left_alone[0].why.find("not split") != std::string::npos);
}

TEST_CASE("every arc that is written keeps to the controls' rules for its radii") {
  for (const double angle : {1e-3, -1e-3})
    for (const char* text : {arcs, circles})
      check_radii(compensated(Shop({.machine = rigid_gantry("0, 0, 0", angle), .text = text})).text);
}

TEST_CASE("an arc of several turns keeps them under a shift, in P and in TURN") {
  const std::string turns =
      "G21 G90 G17\nG0 X10. Y0. Z5.\nG1 Z0. F300\nG3 X0. Y10. Z-3. I-10. J0. P3\nG0 Z5.\nM30\n";
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = turns}));
  CHECK(lines_of(result.text)[3] == "G3 X-0.5 Y10.25 Z-3.125 I-10. J0. P3");
  const std::string siemens =
      "STOPRE\nG71 G90 G17\nG0 X10. Y0. Z5.\nG1 Z0. F300\nG3 X0. Y10. Z-3. I-10. J0. TURN=2\nG0 Z5.\nM30\n";
  const Compensation other = compensated(Shop({.machine = displaced_gantry(), .text = siemens}));
  CHECK(lines_of(other.text)[4] == "G3 X-0.5 Y10.25 Z-3.125 I-10. J0. TURN=2");
}

TEST_CASE("a helix of full circles is divided in the first of them: the last piece makes the others") {
  const std::string turns =
      "G21 G90 G17\nG0 X10. Y0. Z5.\nG1 Z0. F300\nG3 X10. Y0. Z-3. I-10. J0. P3\nG0 Z5.\nM30\n";
  const Compensation shifted = compensated(Shop({.machine = displaced_gantry(), .text = turns}));
  CHECK(lines_of(shifted.text)[3] == "G3 X-10.500 Z-0.625 I-10.000 J0.000");
  CHECK(lines_of(shifted.text)[4] == "G3 X9.5 Y0.25 Z-3.125 I10. J0. P3");
  const Shop skewed({.machine = rigid_gantry("0, 0, 0", 2e-3), .text = turns});
  const Compensation result = compensated(skewed);
  CHECK(result.text.find("P3") == std::string::npos);
  CHECK(dense_miss(skewed, result, 20).size <= 5e-6);
}
