#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using Axes = std::array<bool, 3>;

}  // namespace

TEST_CASE("under G91 words are differences and ends are absolute") {
  const Program program = read("G21 G90 G0 X1 Y2 Z3\nG91 G1 X10 Z-1 F100\nY.5\nG90 X0\n");
  CHECK(program.moves[1].relative);
  CHECK(program.moves[1].end_mm == Vector3(11, 2, 2));
  CHECK(program.moves[2].end_mm == Vector3(11, 2.5, 2));
  CHECK_FALSE(program.moves[3].relative);
  CHECK(program.moves[3].end_mm == Vector3(0, 2.5, 2));
}

TEST_CASE("a relative word on an unknown axis is fixed and leaves it unknown") {
  const Program program = read("G21 G0 X1 Y2\nG91 Z5\nX1\n");
  CHECK(program.moves[1].fixed == Axes{false, false, true});
  CHECK(program.moves[1].known_end == Axes{true, true, false});
  CHECK_FALSE(program.moves[1].words[2].has_value());
  CHECK(program.left_alone.at(0).why == "a relative position starts from an unknown position");
  CHECK(program.moves[2].fixed == Axes{false, false, false});
}

TEST_CASE("G28 G91 leaves G91 active, and its words are not a target") {
  const Program program = read("G21 G90 G0 X1 Y2 Z3\nG28 G91 Z0.\nX5\nG90 Z1\n");
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].relative);
  CHECK(program.moves[1].end_mm.x() == 6);
  CHECK(program.moves[1].known_end == Axes{true, true, false});
  CHECK_FALSE(program.moves[2].relative);
}

TEST_CASE("G0 and G28 in one block are allowed on shop controls only") {
  CHECK(read("O1\nG21 G0 X1. Y2. Z3.\nG0 G91 G28 Z0.\n").left_alone.size() == 1);
  CHECK(diagnostic_of([] { read("G21 G0 X1. Y2. Z3.\nG0 G91 G28 Z0.\n"); }) ==
        "p.ngc:2:8: error: G28 is not allowed in a block with another motion");
}

TEST_CASE("relative Z in a block with G43 is added to the programmed position on shop controls") {
  const std::string text = "G21 G90 G0 X0. Y0. Z10.\nG91 G43 H2 Z-3.\n";
  const Move shop = read("O1\n" + text).moves.back();
  CHECK(shop.end_mm.z() == 7);
  CHECK(shop.known_end[2]);
  CHECK(read(text).moves.back().fixed[2]);
}

TEST_CASE("with known tool lengths Z shifts by their difference and stays known") {
  ReadOptions options;
  options.tool_lengths_mm = {{1, 50}, {2, 60}};
  const Program program =
      read_program("G21 G43 H1 G0 X0 Y0 Z10\nG43 H2\nX1\nG49\nX2\nT1 M6\nG43\nX3\nG43 H7\nX4\n", "", options);
  CHECK(program.moves[1].start_mm.z() == 0);
  CHECK(program.moves[2].start_mm.z() == 60);
  CHECK(program.moves[3].start_mm.z() == 10);
  CHECK(program.moves[3].known_start[2]);
  CHECK_FALSE(program.moves[4].known_start[2]);
  REQUIRE(program.remarks.size() == 1);
  CHECK(program.remarks[0].line == 9);
}

TEST_CASE("on shop controls Z is not known behind a change between known tool lengths without Z") {
  ReadOptions options;
  options.tool_lengths_mm = {{1, 50}, {2, 60}};
  const auto known = [&](const std::string& blocks) {
    const Program program =
        read_program("O1\nG21 G90 G49 G0 X0. Y0. Z100.\nG43 H1 Z10.\n" + blocks + "\nX1.\n", "", options);
    return program.moves.back().known_end[2];
  };
  for (const char* blocks : {"G43 H2", "G49", "G44 H1", "G49 X2.", "H2"}) CHECK_FALSE(known(blocks));
  for (const char* blocks : {"G43 H1", "G43 H2 Z5.", "G49\nZ5.", "G91 G43 H2 Z-3."}) CHECK(known(blocks));
}

TEST_CASE("T and M6 load a tool, T alone does not") {
  const Program program = read("G21 T3 G0 X1\nM6\nX2\nT5\nX3\n");
  CHECK(program.moves[0].tool == 0);
  CHECK(program.moves[1].tool == 3);
  CHECK(program.moves[2].tool == 3);
}

TEST_CASE(
    "a change between known tool lengths inserts no word: the position in the text is shifted with the "
    "length") {
  ReadOptions options;
  options.tool_lengths_mm = {{1, 50}, {2, 60}};
  const std::string text = "G21 G43 H1 G0 X0 Y0 Z10\nG43 H2\nX1\nX2\nG49\nX3\n";
  const Program program = read_program(text, "", options);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}
