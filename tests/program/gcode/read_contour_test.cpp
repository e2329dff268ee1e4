#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::vector<int> groups_of(const std::string& text) {
  std::vector<int> groups;
  const Program program = read("G21 G90 F100 G0 X0. Y0. Z10.\n" + text);
  for (const Move& move : program.moves) {
    CHECK((move.handling == Handling::group) == (move.group != 0));
    CHECK((move.group == 0 || !move.may_split || move.arc));
    groups.push_back(move.group);
  }
  return groups;
}

using Groups = std::vector<int>;

}  // namespace

TEST_CASE("a contour extends from the last move across before its plunge to the moves up after G40") {
  CHECK(groups_of("G0 X1\nX2\nZ1\nG1 Z0\nG41 D1 X3\nG3 Y2 J1\nG40 G1 X2\nZ1\nG0 Z9\nX0\nZ1\n") ==
        Groups{0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0});
}

TEST_CASE("moves beside a contour know the side of the cutter, those to it, from it and along Z do not") {
  const auto sides_of = [](const std::string& text) {
    std::vector<CutterSide> sides;
    for (const Move& move : read("G21 G90 F100 G0 X0. Y0. Z10.\n" + text).moves)
      sides.push_back(move.cutter_side);
    return sides;
  };
  constexpr auto none = CutterSide::none, left = CutterSide::left, right = CutterSide::right;
  using Sides = std::vector<CutterSide>;
  CHECK(sides_of("X2\nG1 Z0\nG41 D1 X3\nY4\nG3 Y2 J-1\nG1 Z-1\nX1\nG40 X2\nX5\n") ==
        Sides{none, none, none, none, left, left, none, left, none, none});
  CHECK(sides_of("G42 D1\nG1 X3\nY4\nG40\nX5\n") == Sides{none, none, right, none});
  CHECK(sides_of("G18\nG41 D1 G1 X3\nX4\nG40 X2\n") == Sides{none, none, none, none});
}

TEST_CASE("G41 and G40 may be alone in a block") {
  CHECK(groups_of("X2\nZ1\nG41 D1\nG1 X3\nY4\nG40\nG1 X1\nZ1\nX0\n") == Groups{0, 1, 1, 1, 1, 1, 1, 0});
  CHECK(groups_of("X2\nZ1\nG41 D1\nG1 X3\nY4\nG40\nZ1\nX0\n") == Groups{0, 1, 1, 1, 1, 1, 0});
}

TEST_CASE("contours that share their moves up and down are one contour, others are numbered") {
  CHECK(groups_of("X2\nG1 Z0\nG42 D1 X3\nG40 X2\nZ-1\nG42 X3\nG40 X2\nZ5\nX9\nZ0\nG41 X3\nG40 X9\n") ==
        Groups{0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2});
}

TEST_CASE("a contour does not extend back over a machine position or a tool change") {
  CHECK(groups_of("X2\nG53 Z0\nZ1\nG41 D1 X3 Y1\nG40 X2 Y2\n") == Groups{0, 0, 1, 1, 1});
  CHECK(groups_of("X2\nT1 M6\nZ1\nG41 D1 X3 Y1\nG40 X2 Y2\n") == Groups{0, 0, 1, 1, 1});
}

TEST_CASE("an arc before a contour, or before its plunge, is not part of it") {
  CHECK(groups_of("X2\nG1 Z0\nG2 X3 I0.5\nG41 D1 G1 X4 Y1\nG40 X5 Y2\n") == Groups{0, 0, 0, 0, 1, 1});
  CHECK(groups_of("X2\nG1 Z0\nG2 X3 I0.5\nG1 Z-1\nG41 D1 X4 Y1\nG40 X5 Y2\n") == Groups{0, 0, 0, 0, 1, 1, 1});
}

TEST_CASE("a move that cannot be followed is not part of a contour") {
  CHECK(groups_of("X2\nG1 Z0\nG41 D1 X3\nX#1\nX4\nG40 X2\n") == Groups{0, 1, 1, 1, 0, 1, 1});
}

TEST_CASE("a '/' move across behind a contour leaves G40 known") {
  const std::string start = "G21 G90 G17\nG0 X0 Y0 Z2\nG1 Z-2 F200\nG41 D1 X20 Y0\nY50\n";
  const Program program = read(start + "G40 X0\nG0 Z5\n/G0 X10 Y0 Z5\nG0 X5 Y5 Z5\nG1 Z-1\n");
  CHECK_FALSE(any_axis(program.moves.back().fixed));
  CHECK(all_known(program.moves.back().known_start));
  // G40 in the '/' block, or a '/' block that may end the compensation.
  for (const char* text : {"/G40 X0\nG0 Z5\nX5\n", "G40\n/G1 X0\nX5\n"})
    CHECK(any_axis(read(start + text).moves.back().fixed));
}

TEST_CASE("a contour has the diameter of G41.1, whose sign changes the side") {
  const auto contour = [](const std::string& cutter) {
    return read_program("G21 G90 G17 G54\nG0 X0 Y0 Z0\n" + cutter + " X5 F100\nX9\nG40 X20\n", "part.ngc",
                        {.dialect = "linuxcnc"});
  };
  const Program left = contour("G1 G41.1 D10");
  CHECK(left.moves[2].cutter_side == CutterSide::left);
  CHECK(cutter_diameter_mm(left, 2) == 10.0);
  CHECK(!cutter_diameter_mm(left, 0));
  const Program right = contour("G1 G41.1 D-10");
  CHECK(right.moves[2].cutter_side == CutterSide::right);
  CHECK(cutter_diameter_mm(right, 2) == 10.0);
  CHECK(cutter_diameter_mm(contour("G20 G1 G41.1 D.5"), 2) == 12.7);
  CHECK(!cutter_diameter_mm(contour("G1 G41 D10"), 2));
}
