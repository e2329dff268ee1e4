// Arcs along which the force ramps and steps, and those that no sub-arc follows: what is left of them.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const ramp = "0, 0, 0, 0\n31, 180, -90, -25\n";

/// The feed moves of a corrected text that are not arcs, from its `first` move on.
std::size_t chords_in(const std::string& text, std::size_t first) {
  std::size_t count = 0;
  const std::vector<Move> moves = moves_in(text);
  for (std::size_t m = first; m < moves.size(); ++m)
    count += moves[m].motion == Motion::feed && !moves[m].arc;
  return count;
}

Shop shop_with(const std::string& machine, const std::string& text, const ForceSource& force) {
  return Shop({.machine = load_machine(machine), .text = text, .force = force});
}

void check_within_tolerance(const Shop& shop, const Compensation& result) {
  const Miss miss = dense_miss(shop, result, 60);
  CAPTURE(miss.line);
  CAPTURE(miss.u);
  CHECK(miss.size <= 5e-6);
  check_radii(result.text);
}

}  // namespace

TEST_CASE("a ramp of the force within an arc leaves all of it arcs, divided where the ramp begins and ends") {
  for (const std::string arc :
       {"G3 X30. Y0. I-30. J0.", "G2 X30. Y0. Z-6. I-30. J0.", "G3 X-30. Y0. R30.", "G3 X0. Y30. R30. M8",
        "G91 G3 X-30. Y30. I-30.", "G90.1 G3 X0. Y30. I0. J0."}) {
    CAPTURE(arc);
    for (const double at : {0.2, 10.0, 31.0, 45.0}) {
      CAPTURE(at);
      const std::string rows = fmt::format("0, 0, 0, 0\n{}, 180, -90, -25\n", at);
      const Shop shop = shop_with(small_mill, "G21 G90 G17\nG0 X30. Y0. Z0.\n" + arc + " F600\nM30\n",
                                  step_profile(rows, 2e-3));
      const Compensation result = compensated(shop);
      CHECK(chords_in(result.text, 1) == 0);
      CHECK(result.counts.inserted_blocks <= 8);
      check_within_tolerance(shop, result);
    }
  }
}

TEST_CASE("a short ramp of the force within an arc is an arc of its own, which needs no chords beside it") {
  const std::string circle = "G21 G90 G17\nG0 X30. Y0. Z0.\nG3 X30. Y0. Z-4. I-30. J0. F600\nM30\n";
  // In a ramp that is much shorter than the correction the text goes across the arc.
  const Shop shop = shop_with(orthoglide_b, circle, step_profile("0, 0, 0, 0\n31, 180, -90, -25\n", 0.1e-3));
  const Compensation result = compensated(shop);
  CHECK(chords_in(result.text, 1) == 0);
  CHECK(arcs_in(result.text).size() >= 8);
  CHECK(arcs_in(result.text).size() < 40);  // of chords alone there would be 160
  check_within_tolerance(shop, result);
}

TEST_CASE("an arc is divided further where that saves chords") {
  const std::string circle = "G21 G90 G17\nG0 X300. Y0. Z0.\nG2 X300. Y0. I-300. J0. F600\nM30\n";
  const Shop shop({.machine = rigid_gantry("0, 0, 0", 0.05 * deg, 0.05 * deg), .text = circle});
  const Compensation result = compensated(shop);
  CHECK(chords_in(result.text, 1) == 0);
  CHECK(arcs_in(result.text).size() > 16);
  CHECK(arcs_in(result.text).size() < 80);  // of chords there would be 540
  check_within_tolerance(shop, result);
}

TEST_CASE("a step of the force within an arc is one line between arcs") {
  for (const std::string arc : {"G3 X-30. Y0. I-30. J0.", "G3 X-30. Y0. Z-4. R30.", "G3 X0. Y30. R30. M8"}) {
    CAPTURE(arc);
    const Shop shop = shop_with(orthoglide_b, "G21 G90 G17\nG0 X30. Y0. Z0.\n" + arc + " F600\nM30\n",
                                step_profile(ramp, 0));
    const Compensation result = compensated(shop);
    CHECK(chords_in(result.text, 1) == 1);
    CHECK(result.counts.inserted_blocks <= 12);
    check_within_tolerance(shop, result);
  }
}

TEST_CASE("a block without a motion word of its own repeats G2 or G3 behind the line of a step") {
  const Shop shop =
      shop_with(orthoglide_b,
                "G21 G90 G17\nG0 X30. Y0. Z0.\nG3 X29.99 Y0.775 R30. F600\nX0. Y30. R30.\nX-30. Y0. R30.\n"
                "M30\n",
                step_profile(ramp, 0));
  const Compensation result = compensated(shop);
  CHECK(chords_in(result.text, 1) == 1);
  CHECK(moves_in(result.text).back().arc);
  check_within_tolerance(shop, result);
}

TEST_CASE("under G93 arcs and the line of a step share the time of their block by length") {
  const Shop shop = shop_with(
      orthoglide_b, "G21 G90 G17\nG0 X30. Y0. Z0.\nG93 G3 X-30. Y0. I-30. J0. F4.\nG94 G1 X-31. F100\nM30\n",
      step_profile(ramp, 0));
  const Compensation result = compensated(shop);
  double minutes = 0;
  for (const Move& move : moves_in(result.text))
    if (move.feed_mode == FeedMode::inverse_time) minutes += 1 / move.feed_per_min;
  CHECK(minutes == doctest::Approx(0.25).epsilon(1e-5));
  CHECK(chords_in(result.text, 1) == 2);
  check_within_tolerance(shop, result);
}

TEST_CASE("of a helix of several turns whose last piece cannot make them only that piece becomes chords") {
  const std::string helix = "G21 G90 G17\nG0 X30. Y0. Z0.\nG3 X30. Y0. Z-3. I-30. J0. P3 F600\nM30\n";
  const Shop shop = shop_with(small_mill, helix, step_profile(ramp, 2e-3));
  const Compensation result = compensated(shop);
  const std::size_t chords = chords_in(result.text, 1);
  CHECK(chords > 0);
  CHECK(chords < 60);
  CHECK(arcs_in(result.text).size() >= 4);
  CHECK(result.text.find('P') == std::string::npos);
  check_within_tolerance(shop, result);
}

TEST_CASE("the turns of a helix are in its last piece, where the block itself is the first") {
  const std::string helix = "G21 G90 G17\nG0 X30. Y0. Z0.\nG3 X30. Y0. Z-3. I-30. J0. P3 F600 M8\nM30\n";
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = helix}));
  const std::vector<std::string> lines = lines_of(result.text);
  CHECK(lines[2] == "G3 X-30.5 Y0.25 Z-0.625 I-30. J0. F600 M8");
  CHECK(lines[3] == "G3 X29.500 Z-3.125 I30.000 J0.000 P3 F600");
  REQUIRE(arcs_in(result.text).size() == 2);
  CHECK(arcs_in(result.text)[1].arc->turns == 2);
}

TEST_CASE("klartext: a helix along whose start the force grows is written at each tolerance") {
  const Vector6 F = (Vector6() << 30, 10, -20, 0, 0, 0).finished();
  Order order{.machine = load_machine(small_mill),
              .text =
                  "BEGIN PGM A MM\nTOOL CALL 1 Z S1000 F250\nL X-9.87 Y+1.092 Z+2 R0 FMAX\nL Z-0.444 "
                  "FMAX\nCC X-6.7432 Y-2.1442\nCP IPA+1053.633 IZ-1.44444 DR+\nL X-14.85 Y+0 Z-1.889\n"
                  "L Z+10 FMAX\nEND PGM A MM\n",
              .force = constant_force(F)};
  order.read.dialect = "heidenhain";
  for (order.tolerance = 2e-6; order.tolerance < 13e-6; order.tolerance += 0.3e-6) {
    CAPTURE(order.tolerance);
    CHECK(!compensated(Shop(order)).text.empty());
  }
}
