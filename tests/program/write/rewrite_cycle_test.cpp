#include <doctest/doctest.h>

#include "counterflex/program/rewrite.hpp"
#include "program/reading.hpp"
#include "program/small_reader.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr char cycle_start[] = "G21 G90 G17 G0 X0. Y0. Z10.\n";

std::string cycle_rewritten(const std::string& blocks, const std::vector<MoveEdit>& edits) {
  return rewrite(read_small(cycle_start + blocks), edits, {}).text.substr(sizeof cycle_start - 1);
}

MoveEdit hole(std::size_t move, const Vector3& end_mm, double bottom_mm, double retract_mm) {
  return {.move = move, .end_mm = end_mm, .bottom_mm = bottom_mm, .retract_mm = retract_mm};
}

}  // namespace

TEST_CASE("each hole of a cycle has its own position, and a depth if it changes") {
  const std::string holes = "G98 G81 X1. Y1. Z-5. R2. F100\nX2.\nX3. Y2.\nX4.\nG80\n";
  CHECK(
      cycle_rewritten(holes, {hole(1, {1.01, 1, 10}, -5.02, 1.98), hole(2, {2.01, 1, 10}, -5.02, 1.98),
                              hole(3, {3, 2.01, 10}, -5.03, 1.97), hole(4, {4, 2.01, 10}, -5.0301, 1.97)}) ==
      "G98 G81 X1.01 Y1. Z-5.02 R1.98 F100\nX2.01\nX3. Y2.01 Z-5.030\nX4.\nG80\n");
  CHECK(cycle_rewritten(holes, {hole(2, {2, 1.01, 10}, -5, 2)}) ==
        "G98 G81 X1. Y1. Z-5. R2. F100\nX2. Y1.010\nX3. Y2.\nX4.\nG80\n");
  CHECK(cycle_rewritten("G99G83X1.Y1.Z-5.R2.Q1.F100\nY2.\n",
                        {hole(1, {1, 1, 2.5}, -4.5, 2.5), hole(2, {1.01, 2, 2.5}, -4.6, 2.4)}) ==
        "G99G83X1.Y1.Z-4.5R2.5Q1.F100\nY2. X1.010 Z-4.600\n");
}

TEST_CASE(
    "a hole that is not edited repeats the depth in the text, and the next hole takes this into account") {
  const std::string holes = "G81 X1. Y1. Z-5. R2. F100\nX2.\nX3.\n";
  CHECK(cycle_rewritten(holes, {hole(1, {1, 1, 10}, -5.5, 2), hole(3, {3, 1, 10}, -5.5, 2)}) ==
        "G81 X1. Y1. Z-5.5 R2. F100\nX2.\nX3.\n");
  CHECK(cycle_rewritten(holes, {hole(1, {1, 1, 10}, -5.5, 2), hole(3, {3, 1, 10}, -5, 2)}) ==
        "G81 X1. Y1. Z-5.5 R2. F100\nX2.\nX3. Z-5.000\n");
}

TEST_CASE("under G91 a shift of the first hole applies to the next ones") {
  const std::string holes = "G91\nG81 X1. Y1. Z-7. R-8. F100\nX1.\nX1.\n";
  CHECK(cycle_rewritten(holes, {hole(1, {1.5, 1, 10}, -4.5, 2.25), hole(2, {2.5, 1, 10}, -4.5, 2.25),
                                hole(3, {3.5, 1, 10}, -4.5, 2.25)}) ==
        "G91\nG81 X1.5 Y1. Z-6.75 R-7.75 F100\nX1.\nX1.\n");
}

TEST_CASE("the height at which a cycle leaves Z is known to later moves") {
  const std::string text = std::string(cycle_start) + "G99 G81 X1. Y1. Z-5. R2. F100\nG80\nG0 X5.\n";
  const Program program = read_small(text);
  const TextPosition position = text_position_after(program.moves[1], {0.0, 0.0, 10.0}, {1, 1, 2.5}, {});
  CHECK(position == TextPosition{1.0, 1.0, 2.5});
  const std::vector<MoveEdit> edits{hole(1, {1, 1, 2.5}, -4.5, 2.5), {.move = 2, .end_mm = {5, 1, 2}}};
  CHECK(rewrite(program, edits, {}).text ==
        std::string(cycle_start) + "G99 G81 X1. Y1. Z-4.5 R2.5 F100\nG80\nG0 X5. Z2.000\n");
}

TEST_CASE("the initial height of a series is known after holes that leave the tool at R") {
  const std::string text =
      std::string(cycle_start) + "G99 G81 X1. Y1. Z-5. R2. F100\nX2.\nG98 X3.\nG80\nG0 X5.\nX6. Z12.\n";
  const Program program = read(text);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  const std::vector<MoveEdit> rapid_higher{{.move = 0, .end_mm = {0, 0, 10.25}},
                                           {.move = 4, .end_mm = {5, 1, 10.25}}};
  CHECK(rewrite(program, rapid_higher, {}).text ==
        "G21 G90 G17 G0 X0. Y0. Z10.25\n" + text.substr(sizeof cycle_start - 1));
}

TEST_CASE("the plane of a G99 hole without R is known if the tool is at that plane") {
  const std::string stays = std::string(cycle_start) + "G99 G81 X1. Y1. Z-5. R2.\nX2.\n";
  CHECK(read(stays).moves.back().known_end[2]);
  const std::string text = std::string(cycle_start) + "G98 G81 X1. Y1. Z-5. R2.\nG99 X2.\nG80\nG0 X5.\n";
  const Program program = read(text);
  CHECK_FALSE(program.moves.back().known_end[2]);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}

TEST_CASE("a depth first programmed behind a hole that is not followed is repeated without a word") {
  const std::string text = "O1\nG21 G90 G0 X0. Y0. Z2.\nG81\nZ-5.\nX3.\nZ-6. R1.\nX4.\nG80\nX5.\n";
  const Program program = read(text);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}
