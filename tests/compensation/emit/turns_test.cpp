// Arcs of many turns where the correction varies around them.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double out_of_square = 0.05 * deg;  // 0.0218 mm at a radius of 25 mm

std::string bore_with(const std::string& start, const std::string& arc) {
  return "G21 G90 G17\nG0 " + start + " Z5.\nG1 Z-5. F300\n" + arc + " F600\nG0 Z20.\nM30\n";
}

void check_followed_around(const Order& order) {
  CAPTURE(order.text);
  const Shop shop(order);
  const Compensation result = compensated(shop);
  const Miss miss =
      dense_miss(shop, result, 12);  // 13 parts of a piece: no turns of an undivided arc come back
  CAPTURE(miss.u);
  CHECK(miss.size <= 5e-6);
  CHECK(result.counts.inserted_blocks > 0);
}

}  // namespace

TEST_CASE("a helix of any number of turns is followed on all of them") {
  for (const int turns : {1, 3, 8, 16, 64})
    check_followed_around(
        {.machine = rigid_gantry("0, 0, 0", out_of_square),
         .text = bore_with("X25. Y0.", fmt::format("G3 X25. Y0. Z-13. I-25. J0. P{}", turns))});
}

TEST_CASE("a flat circle of many turns is followed on all of them") {
  for (const int turns : {8, 16})
    check_followed_around({.machine = rigid_gantry("0, 0, 0", out_of_square),
                           .text = bore_with("X25. Y0.", fmt::format("G2 I-25. J0. P{}", turns))});
}

TEST_CASE("the turns of a Siemens helix are followed") {
  for (const char* centre : {"I-25. J0.", "I=AC(0.) J=AC(0.)"})
    for (const int turns : {7, 15})
      check_followed_around(
          {.machine = rigid_gantry("0, 0, 0", out_of_square),
           .text = fmt::format(
               "STOPRE\nG71 G90 G17\nG0 X25. Y0. Z5.\nG1 Z-5. F300\nG3 X25. Y0. Z-13. {} TURN={} F600\n"
               "G0 Z20.\nM30\n",
               centre, turns)});
}

TEST_CASE("a helix that begins where the datum was touched is followed") {
  const double y = 25e-3;
  for (const int turns : {1, 8})
    check_followed_around(
        {.machine = rigid_gantry("0, 0, 0", out_of_square),
         .text = bore_with("X0. Y25.", fmt::format("G3 X0. Y25. Z-13. I0. J-25. P{}", turns)),
         .datum_shift = Vector3(-y * std::sin(out_of_square), y * (std::cos(out_of_square) - 1), 0)});
}

TEST_CASE("a helix of many turns is followed where the machine deflects under the cut") {
  for (const int turns : {8})
    for (const ForceSource& force : {ForceSource{}, constant_force(milling())})
      check_followed_around(
          {.machine = load_machine(small_mill),
           .text = bore_with("X30. Y0.", fmt::format("G3 X30. Y0. Z-8. I-30. J0. P{}", turns)),
           .force = force});
}

TEST_CASE("chords that replace many turns go around on each of them") {
  const double tolerance = 2e-6;
  const Shop shop({.machine = rigid_gantry("0, 0, 0", 20e-3),
                   .text = bore_with("X50. Y0.", "G2 X50. Y0. Z-6. I-50. J0. P4"),
                   .tolerance = tolerance,
                   .decimals = 4});
  const Compensation result = compensated(shop);
  CHECK(result.counts.inserted_blocks > 200);
  CHECK(dense_miss(shop, result, 20).size <= tolerance);
}
