// Steps of the force that act as steps, and blocks that must stay whole.
#include <fmt/format.h>

#include <algorithm>

#include "compensation/support/judge.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const two_cuts = "G21 G90\nG0 X0. Y0. Z0.\nG1 X2. F100\nX4.\nG0 Z20.\nG0 X0.\nM30\n";

std::size_t jumps_of(const Shop& shop, const Compensation& result) {
  std::size_t inserted = 0;
  for (const Commanded& piece : commanded(shop, result)) inserted += piece.u1 < 1;
  return result.counts.inserted_blocks - inserted;
}

}  // namespace

TEST_CASE("without a blend an extra feed move performs the jump into a cut and out of it") {
  const Shop shop(
      {.machine = load_machine(orthoglide_b), .text = two_cuts, .force = constant_force(milling(), 0)});
  const Compensation result = compensated(shop);
  CHECK(jumps_of(shop, result) == 2);
  const std::vector<std::string> lines = lines_of(result.text);
  CHECK(lines[2].starts_with("G1 X"));
  CHECK(lines[2].ends_with(" F100"));
  CHECK(lines[3].starts_with("G1 X"));
  CHECK(lines[5].starts_with("G1 X"));
  CHECK(lines[6].starts_with("G0 Z"));
  CHECK(dense_miss(shop, result, 20).size <= 5e-6);
  // Both ends of a jump hold the tip on the path: before it without force, after it under force.
  const auto moves = read_program(result.text, "c", {}).moves;
  CHECK((cold_tip(shop, moves[1].start_mm * mm, Vector6::Zero())).norm() < 1e-6);
  CHECK((cold_tip(shop, moves[1].end_mm * mm, milling())).norm() < 1.5e-6);
}

TEST_CASE("a modal rapid after a jump has a G0 of its own") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X0. Y0. Z0.\nG1 X2. F100\nG0 Z20.\nX0.\nG1 Z10.\nG0\nZ30.\nM30\n",
                   .force = constant_force(milling(), 0)});
  const Compensation result = compensated(shop);
  CHECK(jumps_of(shop, result) == 4);
  const auto before = shop.program.moves, after = read_program(result.text, "c", {}).moves;
  CHECK(after.back().motion == Motion::rapid);
  CHECK(after[after.size() - 2].motion == Motion::feed);
}

TEST_CASE("an extra feed move before a rapid has the feed of the cut, also if the rapid has another F") {
  const std::string gcode = "G21 G90\nG0 X0. Y0. Z0.\n";
  const std::string klartext = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 R0 FMAX M3\n";
  const std::vector<std::pair<std::string, double>> cases{
      {gcode + "G1 X2. F1000\nG0 Z20. F300\nG1 X4.\nM30\n", 1000},
      {gcode + "G1 X2. F1000\nG0 Z20. M8 F300\nG1 X4.\nM30\n", 1000},
      {gcode + "G1 X2. F1000\nG0 Z20. F#1\nG1 X4. F300\nM30\n", 1000},
      {gcode + "G1 X2. F1000\nG91\nG0 Z20. F300\nG1 X4.\nM30\n", 1000},
      {gcode + "S1000 M3 G95\nG1 X2. F.3\nG0 Z20. S2000\nG1 X4.\nM30\n", 300},
      {klartext + "L X+2 F1000\nL Z+20 FMAX\nL X+4 F300\nEND PGM A MM\n", 1000}};
  for (const std::pair<std::string, double>& program_and_feed : cases) {
    const std::string& text = program_and_feed.first;
    const double feed = program_and_feed.second;
    CAPTURE(text);
    const Shop shop(
        {.machine = load_machine(orthoglide_b), .text = text, .force = constant_force(milling(), 0)});
    const Compensation result = compensated(shop);
    CHECK(refusal_of(shop, result.text) == "");
    const auto before = shop.program.moves, after = read_program(result.text, "c", {}).moves;
    const auto rapid = std::find_if(after.begin() + 1, after.end(),
                                    [](const Move& move) { return move.motion == Motion::rapid; });
    REQUIRE(rapid != after.end());
    CHECK((rapid - 2)->feed_mm_min == feed);
    CHECK((rapid - 1)->feed_mm_min == feed);
    CHECK(after.back().feed_mm_min == before.back().feed_mm_min);
    CHECK(jumps_of(shop, result) == 3);
  }
}

TEST_CASE("before a rapid without a feed that acts, and before one with '/', no feed move is inserted") {
  const std::string gcode = "G21 G90\nG0 X0. Y0. Z0.\n", turning = gcode + "S1000 M3\nG95\nG1 X2. F.1\n";
  const std::string klartext = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 R0 FMAX M3\n";
  for (const std::string& text :
       {gcode + "G93 G1 X2. F10\nG94\nG0 Z20. F300\nG1 X4.\nM30\n",
        turning + "G94\nG0 Z20. F300\nG1 X4.\nM30\n", turning + "M5\nG0 Z20. M3\nG1 X4.\nM30\n",
        gcode + "G1 X2. F100\n/G0 Z20.\nG0 X2. Y0. Z20.\nG1 X4.\nM30\n",
        klartext + "M136\nL X+2 F0.1\nM5\nL Z+20 FMAX M3\nL X+4\nEND PGM A MM\n",
        klartext + "L X+2 F100\n/L Z+20 FMAX\nL X+2 Y+0 Z+20 FMAX\nL X+4\nEND PGM A MM\n"}) {
    CAPTURE(text);
    const Shop shop(
        {.machine = load_machine(orthoglide_b), .text = text, .force = constant_force(milling(), 0)});
    const Compensation result = compensated(shop);
    CHECK(refusal_of(shop, result.text) == "");
    CHECK(jumps_of(shop, result) == 2);
    for (const Move& move : read_program(result.text, "c", {}).moves)
      if (move.motion == Motion::feed) CHECK(move.feed_mm_min > 0);
  }
}

TEST_CASE("a step of the force may be less than a digit away from the end of a block") {
  const double block = 0.02, digit = 1e-6;  // m
  for (const double at : {19.99, 19.999, 19.9994, 19.9998, 19.99995, 20.0, 20.00005, 20.0006, 20.01}) {
    CAPTURE(at);
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = "G21 G90\nG0 X0. Y0. Z0.\nG1 X20. F600\nX40.\nM30\n",
                     .force = step_profile(fmt::format("0, 100, 0, 0\n{}, 200, 60, 0\n", at), 0)});
    const Compensation result = compensated(shop);
    // The jump is known to a digit: a piece that begins so near to it begins behind it.
    std::vector<Commanded> pieces = commanded(shop, result);
    check_complete(shop, pieces);
    std::erase_if(pieces, [&](const Commanded& piece) { return (piece.u1 - piece.u0) * block < digit; });
    for (Commanded& piece : pieces) {
      const double step = at * mm / block - (shop.path.segments[piece.segment].line == 3 ? 0 : 1);
      if (std::abs(step - piece.u0) * block < digit) piece.u0 = std::max(step, piece.u0) + 1e-9;
    }
    const Miss miss = dense_miss(shop, pieces, 40);
    CAPTURE(miss.u);
    CHECK(miss.size <= 5e-6);
  }
}

TEST_CASE("a jump less than a digit before the end of a move belongs to it, whatever follows") {
  const std::string before = "G21 G90 G17\nG0 X0. Y0. Z0.\n";
  const std::vector<std::pair<std::string, double>> cases{{"G1 X20. F600\nG0 Z20.\nM30\n", 20},
                                                          {"G1 X20. F600\nM30\n", 20},
                                                          {"G1 X20. F600\nX20.\nX40.\nM30\n", 20},
                                                          {"G3 X10. I5. F600\nG1 Y9.\nM30\n", 15.70796},
                                                          {"G1 X20. F600\nG2 X30. I5.\nM30\n", 20}};
  for (const auto& one : cases)
    for (const double rest : {1e-3, 6e-4, 2e-4, 5e-5}) {
      const auto& text = one.first;
      const double end = one.second;
      CAPTURE(text);
      CAPTURE(rest);
      const std::string rows = fmt::format("0, 100, 0, 0\n{:.5f}, 200, 60, 0\n", end - rest);
      const Shop shop(
          {.machine = load_machine(orthoglide_b), .text = before + text, .force = step_profile(rows, 0)});
      CHECK(refusal_of(shop, compensated(shop).text) == "");
    }
}

TEST_CASE("a block of one digit behind a jump is a block of its own") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X20. Y0. Z0.\nG1 X20.001 F600\nY20.\nG0 Z20.\nM30\n",
                   .force = constant_force(milling(), 0)});
  const Compensation result = compensated(shop);
  CHECK(jumps_of(shop, result) == 2);
  CHECK(dense_miss(shop, result, 20).size <= 5e-6);
}

TEST_CASE("a step of the force inside a segment is performed where it is") {
  for (const double step : {40.0, 2.0, 1.0, 0.5, 0.3, 0.2, 0.1}) {
    CAPTURE(step);
    const std::string rows = fmt::format("0, 100, 0, 0\n50, {}, 0, 0\n", 100 + step);
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = "G21 G90\nG0 X-60. Y-60. Z-60.\nG1 Y60. F600\nM30\n",
                     .force = step_profile(rows, 0)});
    const Compensation result = compensated(shop);
    const Miss miss = dense_miss(shop, result, 40);
    CAPTURE(miss.u);
    CHECK(miss.size <= 5e-6);
  }
}

TEST_CASE("small jumps that rounding swallows do not shift what the text is held to") {
  for (int i = 0; i < 12; ++i) {
    const double step = 0.1 + 0.05 * i;
    CAPTURE(step);
    const std::string rows = fmt::format("0, 100, 0, 0\n31.7, {}, 0, 0\n70.1, 100, 0, 0\n", 100 + step);
    Order order{.machine = load_machine(orthoglide_b),
                .text = "G21 G90\nG0 X-60. Y-60. Z-60.\nG1 Y-30. Z-40. F600\nG1 Y60.\nM30\n",
                .force = step_profile(rows, 0)};
    order.tolerance = 2e-6;
    const Shop shop(order);
    CHECK(dense_miss(shop, compensated(shop), 10).size <= 2e-6);
  }
}

TEST_CASE("a ramp from one force to another is followed within the tolerance") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X-60. Y-60. Z-60.\nG1 Y60. F600\nM30\n",
                   .force = step_profile("0, 100, 0, 0\n50, 300, -50, 20\n90, 0, 0, 0\n", 2e-3)});
  CHECK(dense_miss(shop, compensated(shop), 60).size <= 5e-6);
}

TEST_CASE("under exact stop a move is not split: its ends are corrected, and it is listed") {
  for (const double blend : {0.0, 2e-3}) {
    CAPTURE(blend);
    const Shop shop(
        {.machine = load_machine(orthoglide_b),
         .text = "G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG61.1\nG1 Y126.35 F600\nG64\nG1 Y-70.\nM30\n",
         .force = constant_force(milling(), blend)});
    const Compensation result = compensated(shop);
    CHECK(pieces_on(result, 4) == 1);
    CHECK(pieces_on(result, 6) > 1);
    REQUIRE(result.left_alone.size() == 1);
    CHECK(result.left_alone[0].line == 4);
    CHECK(result.left_alone[0].why.find("not split") != std::string::npos);
    CHECK(result.left_alone[0].why.find("; the tool stops exactly at its end") != std::string::npos);
    for (const Commanded& piece : commanded(shop, result)) {
      const Segment& segment = shop.path.segments[piece.segment];
      if (segment.line != 4) continue;
      const Vector6 F = shop.forces->at(piece.segment, 1, Side::before);
      CHECK((cold_tip(shop, piece.curve.end, F) - segment.wanted.end).norm() < 1e-6);
    }
  }
}

TEST_CASE("a jump that an exact stop forbids is listed, even where nothing else needs points") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X0. Y0. Z0.\nG61.1\nG1 X2. F100\nG0 Z20.\nM30\n",
                   .force = constant_force(milling(), 0)});
  const Compensation result = compensated(shop);
  REQUIRE(result.left_alone.size() >= 1);
  CHECK(result.left_alone[0].line == 4);
  CHECK(result.counts.inserted_blocks == 0);
}

TEST_CASE("a block with a word that acts at its end is not split") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG1 Y126.35 F600 M5\nM30\n",
                   .force = constant_force(milling())});
  const Compensation result = compensated(shop);
  CHECK(result.counts.inserted_blocks == 0);
  REQUIRE(result.left_alone.size() == 1);
  CHECK(result.left_alone[0].line == 3);
  CHECK(result.left_alone[0].why.find("; a word of its block acts at") != std::string::npos);
}
