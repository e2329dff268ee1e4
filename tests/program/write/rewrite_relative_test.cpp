#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "counterflex/program/rewrite.hpp"
#include "program/small_reader.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr char relative_start[] = "G21 G90 G1 X0. Y0. Z0. F100.\nG91\n";

std::string relative_rewritten(const std::string& blocks, std::vector<MoveEdit> edits) {
  return rewrite(read_small(relative_start + blocks), edits, {}).text.substr(sizeof relative_start - 1);
}

}  // namespace

TEST_CASE("a relative word is the difference between the position in the text and the target") {
  const std::string blocks = "X1.\nX1.\nX1.\n";
  CHECK(relative_rewritten(blocks, {{.move = 1, .end_mm = {1.5, 0, 0}},
                                    {.move = 2, .end_mm = {2.5, 0.25, 0}},
                                    {.move = 3, .end_mm = {3, 0.25, 0}}}) == "X1.5\nX1. Y0.250\nX0.5\n");
  CHECK(relative_rewritten(blocks, {{.move = 1, .end_mm = {1.5, 0, 0}}}) == "X1.5\nX1.\nX1.\n");
  CHECK(relative_rewritten(blocks, {{.move = 2, .end_mm = {2.0004, -0.0004, 0}}}) == blocks);
}

TEST_CASE("the pieces of a relative move are relative, and the block has the last one") {
  CHECK(
      relative_rewritten("N4 X3. F50.\n",
                         {{.move = 1, .inserted = {{{1, 0.25, 0}}, {{2, 0.25, 0}}}, .end_mm = {3, 0, 0}}}) ==
      "N4 X1.000 Y0.250 F50.\nX1.000 F50.\nX1. Y-0.250 F50.\n");
  CHECK(
      relative_rewritten("G1 X3. M8\nX1.\n", {{.move = 1, .inserted = {{{1, 0.25, 0}}}, .end_mm = {3, 0, 0}},
                                              {.move = 2, .end_mm = {4, 0, 0}}}) ==
      "G1 X1. Y0.250 M8\nG1 X2.000 Y-0.250\nX1.\n");
}

TEST_CASE("an arc's centre under G91 is relative to its start in the text") {
  CHECK(relative_rewritten("G3 X-10. Y10. I-10. J0.\n",
                           {{.move = 1, .end_mm = {-10, 10.5, 0}, .centre_mm = Vector3(-10, 0.25, 0)}}) ==
        "G3 X-10. Y10.5 I-10. J0.25\n");
}

TEST_CASE("rounding errors of relative words do not add up over a thousand moves") {
  std::string blocks;
  std::vector<MoveEdit> edits;
  for (std::size_t i = 1; i <= 1000; ++i) {
    blocks += "G1 X0.01 Y0.02\n";
    const double n = static_cast<double>(i);
    edits.push_back({.move = i, .end_mm = {n * 0.0103334, n * 0.0200003, 0}});
  }
  const Program again = read_small(rewrite(read_small(relative_start + blocks), edits, {}).text);
  REQUIRE(again.moves.size() == 1001);
  for (std::size_t i = 1; i <= 1000; ++i)
    CHECK((again.moves[i].end_mm - edits[i - 1].end_mm).cwiseAbs().maxCoeff() <= 0.5e-3 + 1e-9);
}

TEST_CASE("a relative word on an axis with an unknown position stays, and the position remains unknown") {
  const Program program = read_small("G21 G91 G1 X1. F100.\nX1.\n");
  Program unknown = program;
  for (Move& move : unknown.moves) move.known_start = move.known_end = {}, move.fixed = {true, false, false};
  const std::vector<MoveEdit> edits{{.move = 0, .end_mm = {5, 5, 5}}, {.move = 1, .end_mm = {6, 6, 6}}};
  CHECK(rewrite(unknown, edits, {}).text == program.text);
  CHECK(text_position_after(unknown.moves[1], {1.0, 2.0, 3.0}, {6, 6, 6}, {}) == TextPosition{});
}
