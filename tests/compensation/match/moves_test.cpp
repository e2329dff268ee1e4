// Moves that are not long cuts: rapids, first moves, moves that go nowhere.
#include <fmt/format.h>

#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Compensation on_orthoglide(const std::string& text, const ForceSource& force = {}) {
  return compensated(Shop({.machine = load_machine(orthoglide_b), .text = text, .force = force}));
}

/// Correction of each move of a corrected program that has as many moves as the original (mm).
std::vector<Vector3> corrections(const std::string& before, const std::string& after) {
  const auto a = read_program(before, "a", {}).moves, b = read_program(after, "b", {}).moves;
  REQUIRE(a.size() == b.size());
  std::vector<Vector3> c;
  for (std::size_t m = 0; m < a.size(); ++m) c.push_back(b[m].end_mm - a[m].end_mm);
  return c;
}

}  // namespace

TEST_CASE("rapids get no points, and their ends are corrected without force") {
  const std::string text = "G21 G90\nG0 X-70. Y-70. Z-70.\nG0 X120. Y120. Z100.\nG0 X0. Y100. Z20.\nM30\n";
  const Compensation unloaded = on_orthoglide(text), loaded = on_orthoglide(text, constant_force(milling()));
  CHECK(unloaded.text == loaded.text);
  CHECK(unloaded.counts.inserted_blocks == 0);
  const Shop shop({.machine = load_machine(orthoglide_b), .text = text});
  const std::vector<Vector3> ends = ends_of(shop, loaded.text), wanted = ends_of(shop, text);
  for (std::size_t m = 0; m < ends.size(); ++m)
    CHECK((cold_tip(shop, ends[m], Vector6::Zero()) - wanted[m]).norm() < 1e-6);
}

TEST_CASE("with a blend a rapid starts where the cut ended") {
  const std::string text = "G21 G90\nG0 X0. Y0. Z0.\nG1 X1. F100\nG1 X2.\nG0 Z20.\nM30\n";
  const Compensation result = on_orthoglide(text, constant_force(milling()));
  const std::vector<std::string> lines = lines_of(result.text);
  // The rapid is the last move, and nothing is between it and the end of the cut.
  CHECK(lines[lines.size() - 3].substr(0, 4) == "G0 Z");
  CHECK(lines[lines.size() - 4].find("G1") == 0);
  const auto moves = read_program(result.text, "c", {}).moves;
  const Vector3 loaded = moves[moves.size() - 2].end_mm - Vector3(2, 0, 0),
                unloaded = moves.back().end_mm - Vector3(2, 0, 20);
  CHECK((loaded - unloaded).norm() > 0.05);
}

TEST_CASE("words before all axes are known take the correction of the first known position") {
  const std::string text = "G21 G90\nG0 Z40.\nG0 X10.\nM3 S1000\nG0 Y-20.\nG1 X20. F100\nM30\n";
  const Compensation result = on_orthoglide(text);
  const std::vector<std::string> lines = lines_of(result.text);
  const Shop shop({.machine = load_machine(orthoglide_b), .text = text});
  const auto moves = read_program(result.text, "c", {}).moves;
  REQUIRE(moves.size() == 4);
  const Vector3 first = moves[2].end_mm - Vector3(10, -20, 40);
  CHECK((cold_tip(shop, moves[2].end_mm * mm, Vector6::Zero()) - Vector3(10, -20, 40) * mm).norm() < 1e-6);
  CHECK(first.cwiseAbs().minCoeff() > 0.05);
  CHECK(moves[0].end_mm.z() - 40 == doctest::Approx(first.z()));
  CHECK(moves[1].end_mm.x() - 10 == doctest::Approx(first.x()));
  CHECK(result.counts.inserted_words == 2);  // in the cut alone, which moves by more than rounding
  CHECK(result.left_alone.empty());
}

TEST_CASE("words further than 64 blocks before the first known position are left alone and listed") {
  for (const int blocks : {62, 63, 64}) {
    CAPTURE(blocks);
    std::string text = "G21 G90\nG0 Z40.\n";
    for (int i = 0; i < blocks; ++i) text += "M8\n";
    text += "G0 X10. Y-20.\nM30\n";
    const Compensation result = on_orthoglide(text);
    const bool near = blocks + 1 <= 64;
    CHECK((lines_of(result.text)[1] != "G0 Z40.") == near);
    REQUIRE(result.left_alone.size() == (near ? 0 : 1));
    if (!near) CHECK(result.left_alone[0].line == 2);
  }
}

TEST_CASE("words are left alone and listed where no position ever becomes known") {
  const std::string text = "G21 G90\nG0 Z40.\nG0 X10.\nM30\n";
  const Compensation result = on_orthoglide(text);
  CHECK(result.text == text);
  CHECK(result.waypoints.empty());
  REQUIRE(result.left_alone.size() == 2);
  CHECK(result.left_alone[0].line == 2);
  CHECK(result.left_alone[1].line == 3);
}

TEST_CASE("moves that go nowhere keep the correction that holds there") {
  const std::string text =
      "G21 G90\nG0 X10. Y20. Z30.\nG0 X10. Y20. Z30.\nG1 X12. F100\nG1 X12. Y20.\nG1 Z30. F50\nG1 "
      "Y21.\nM30\n";
  for (const double blend : {0.0, 2e-3}) {
    const Shop shop(
        {.machine = load_machine(orthoglide_b), .text = text, .force = constant_force(milling(), blend)});
    const Compensation result = compensated(shop);
    const auto moves = read_program(result.text, "c", {}).moves;
    // In every block without motion in the original the corrected program does not move either.
    int still = 0;
    for (const Move& move : moves) still += move.start_mm == move.end_mm && move.known_start[0];
    CHECK(still == 3);
    CHECK(dense_miss(shop, result, 20).size <= 5e-6);
  }
}

TEST_CASE(
    "a coordinate that a block omits follows when the correction needs it, and so does the next block") {
  const std::string text = "G21 G90\nG0 X-60. Y-60. Z-60.\nG0 X100.\nG0 Y100.\nG0 Z80.\nM30\n";
  const Compensation result = on_orthoglide(text);
  const std::vector<Vector3> c = corrections(text, result.text);
  const Shop shop({.machine = load_machine(orthoglide_b), .text = text});
  const std::vector<Vector3> ends = ends_of(shop, result.text), wanted = ends_of(shop, text);
  for (std::size_t m = 0; m < ends.size(); ++m)
    CHECK((cold_tip(shop, ends[m], Vector6::Zero()) - wanted[m]).norm() < 1e-6);
  CHECK(result.counts.inserted_words == 6);
  CHECK((c[1] - c[0]).norm() > 0.1);
}

TEST_CASE("after a machine position the axes are known again only when they are programmed") {
  const std::string text = "G21 G90\nG0 X0. Y0. Z0.\nG53 G0 Z0.\nG0 X50. Y50.\nG0 Z20.\nG1 X60. F100\nM30\n";
  const Compensation result = on_orthoglide(text);
  const std::vector<std::string> lines = lines_of(result.text);
  CHECK(lines[2] == "G53 G0 Z0.");
  const auto moves = read_program(result.text, "c", {}).moves;
  const Shop shop({.machine = load_machine(orthoglide_b), .text = text});
  for (std::size_t m = 0; m < moves.size(); ++m) {
    if (moves[m].line != 5) continue;
    CHECK((cold_tip(shop, moves[m].end_mm * mm, Vector6::Zero()) - Vector3(50, 50, 20) * mm).norm() < 1e-6);
  }
  CHECK(lines[3] != "G0 X50. Y50.");
}

TEST_CASE("words behind a machine position are unshifted where an inserted word has ended the shift") {
  for (const std::string to_machine : {"G53 G0 Z0\n", "G91 G28 Z0\nG90\n"}) {
    CAPTURE(to_machine);
    const Shop shop(
        {.machine = yielding_gantry(),
         .text = "G21 G90 G17\nG0 X0 Y0 Z50\nG1 Z0 F200\nX40\nG0 Z50\n" + to_machine + "G0 X0 Y0\nZ50\nM2\n",
         .force = constant_force(milling())});
    const Compensation result = compensated(shop);
    CHECK(!result.failure);
    if (result.failure) MESSAGE(result.failure->what);
    CHECK(result.text.find("\nG0 X0 Y0\nZ50\n") != std::string::npos);
  }
}
