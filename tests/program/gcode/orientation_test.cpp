// G-code of six-axis machines: A, B and C are the orientation of the tool.
#include <doctest/doctest.h>

#include "counterflex/program/rewrite.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr char turning_program[] =
    "G21 G90 G0 X0. Y0. Z0. A0. B0. C350.\n"
    "G1 X10. C370. F600\n"
    "Y5.\n"
    "A-1.5 (turns in place)\n"
    "X20. B2\n";

Program read_turning(const std::string& program) {
  return read_program(program, "six.ngc", {.dialect = "linuxcnc", .tool_orientation = true});
}

MoveEdit edit_of(const Program& program, std::size_t move) {
  const Move& m = program.moves[move];
  return {.move = move, .end_mm = m.end_mm, .orientation = m.orientation->end};
}

}  // namespace

TEST_CASE("A, B and C of a six-axis machine are read as the tool's orientation") {
  const Program program = read_turning(turning_program);
  REQUIRE(program.moves.size() == 5);
  CHECK(program.left_alone.empty());
  CHECK(!all_known(program.moves[0].known_start));
  CHECK(all_known(program.moves[0].known_end));
  CHECK(all_known(program.moves[1].known_start));
  CHECK(program.moves[1].orientation->start == OrientationNumbers{0, 0, 350});
  CHECK(program.moves[1].orientation->end == OrientationNumbers{0, 0, 370});
  CHECK(program.moves[2].orientation->end == OrientationNumbers{0, 0, 370});
  CHECK(program.moves[3].start_mm == program.moves[3].end_mm);
  CHECK(program.moves[4].orientation->start == OrientationNumbers{-1.5, 0, 370});
  CHECK(program.moves[4].orientation->end == OrientationNumbers{-1.5, 2, 370});
  CHECK(numbers_at(*program.moves[1].orientation, 0.25) == OrientationNumbers{0, 0, 355});
}

TEST_CASE("without all three angles no position is known, and G91 loses them") {
  const Program part = read_turning("G21 G90 G0 X0 Y0 Z0 A0\nG1 X5 F100\n");
  CHECK(!all_known(part.moves[0].known_end));
  CHECK(!all_known(part.moves[1].known_end));
  REQUIRE(part.left_alone.size() == 1);
  const Program relative = read_turning("G21 G90 G0 X0 Y0 Z0 A0 B0 C0\nG91 G1 X5 A1 F100\nG90 X7\n");
  CHECK(all_known(relative.moves[0].known_end));
  CHECK(!all_known(relative.moves[1].known_end));
  CHECK(!all_known(relative.moves[2].known_end));
}

TEST_CASE("cycles and cutter compensation are refused in a program that turns the tool") {
  CHECK_THROWS_AS(read_turning("G21 G90 G0 X0 Y0 Z9 A0 B0 C0\nG81 X5 Z-3 R1 F100\n"), InputError);
  CHECK_THROWS_AS(read_turning("G21 G90 G0 X0 Y0 Z0 A0 B0 C0\nG41 D1 G1 X5 F100\n"), InputError);
}

TEST_CASE("on other machines a word of A, B or C that is not zero ends correction") {
  const Program program = read_program(turning_program, "six.ngc", {.dialect = "linuxcnc"});
  REQUIRE(program.left_alone.size() == 2);
  CHECK(!program.left_alone[0].feeds);
  CHECK(program.left_alone[1].feeds);  // the block that only turns
  CHECK(!program.moves[1].orientation);
}

TEST_CASE("an orientation that does not change leaves every byte") {
  const Program program = read_turning(turning_program);
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < program.moves.size(); ++m) edits.push_back(edit_of(program, m));
  CHECK(rewrite(program, edits, {}).text == turning_program);
}

TEST_CASE("angles are changed, inserted where the block has none, and kept where they are right") {
  const Program program = read_turning(turning_program);
  MoveEdit first = edit_of(program, 1), second = edit_of(program, 2), third = edit_of(program, 3);
  const MoveEdit last = edit_of(program, 4);
  first.orientation = OrientationNumbers{0.0123, 0, 370.00004};
  second.orientation = OrientationNumbers{0.0123, 0, 370};
  third.orientation = OrientationNumbers{-1.4999, 0.00004, 369.9};
  CHECK(rewrite(program, {first, second, third, last}, {}).text ==
        "G21 G90 G0 X0. Y0. Z0. A0. B0. C350.\n"
        "G1 X10. C370. A0.0123 F600\n"
        "Y5.\n"
        "A-1.4999 C369.9000 (turns in place)\n"
        "X20. B2 A-1.5000 C370.0000\n");
}

TEST_CASE("points inserted into a move carry their angles") {
  const Program program = read_turning(turning_program);
  MoveEdit edit = edit_of(program, 1);
  edit.inserted = {{{5, 0.01, 0}, {}, OrientationNumbers{0, 0, 360.01}}};
  CHECK(rewrite(program, {edit}, {}).text ==
        "G21 G90 G0 X0. Y0. Z0. A0. B0. C350.\n"
        "G1 X5.000 Y0.010 C360.0100 F600\n"
        "G1 X10. Y0.000 C370. F600\n"
        "Y5.\n"
        "A-1.5 (turns in place)\n"
        "X20. B2\n");
}

TEST_CASE("the last piece of a numbered block with angles alone has its words and no N") {
  const Program program = read_turning("G21 G90 G0 X0 Y0 Z0 A0 B0 C0\nN40 G1 X50 F600\nN50 A30\nN60 X60\n");
  MoveEdit edit = edit_of(program, 2);
  edit.inserted = {{{50, 0, 0}, {}, OrientationNumbers{10, 0, 0}}};
  edit.end_mm.y() = 0.05;
  CHECK(rewrite(program, {edit}, {}).text ==
        "G21 G90 G0 X0 Y0 Z0 A0 B0 C0\nN40 G1 X50 F600\nN50 A10.0000\nY0.050 A29.9900 F1.500750\nA30 "
        "F600.\nN60 X60\n");
}

namespace {

constexpr char turn_start[] = "G21 G90 G94 G0 X50 Y0 Z0 A0 B0 C0\n";

/// The text behind `turn_start` where its last block is divided after 10 degrees, and ends at `end_mm`.
std::string divided_turn(const std::string& blocks, const Vector3& inserted_mm, const Vector3& end_mm,
                         const std::string& first = turn_start) {
  const Program program = read_turning(first + blocks);
  MoveEdit edit = edit_of(program, program.moves.size() - 1);
  if (program.moves.back().may_split) edit.inserted = {{inserted_mm, {}, OrientationNumbers{10, 0, 0}}};
  edit.end_mm = end_mm;
  return rewrite(program, {edit}, {}).text.substr(first.size());
}

}  // namespace

TEST_CASE("pieces of a block that only turns the tool have its time, and the last one its F") {
  const Vector3 inserted(50.03, 0, 0), end(50.03, 0.04, 0);
  // 10 degrees in 2 s: 0.03 mm in 2 s. 19.99 degrees in 3.998 s: 0.04 mm in 3.998 s.
  const std::string pieces = "X50.030 A10.0000 F0.9000000\nY0.040 A29.9900 F0.6003002\n";
  CHECK(divided_turn("G1 F300\nA30\n", inserted, end) == "G1 F300\n" + pieces + "A30 F300.\n");
  CHECK(divided_turn("G1 F100\nA30 F300 (slowly)\n", inserted, end) ==
        "G1 F100\n" + pieces + "A30 F300 (slowly)\n");
  CHECK(divided_turn("G1 F300\nN5 A30 M8\n", inserted, end) ==
        "G1 F300\nN5 X50.030 A10. F0.9000000 M8\nY0.040 A29.9900 F0.6003002\nA30.0000 F300.\n");
  CHECK(divided_turn("G1 F300\nA30 F200 M8\n", {50, 0, 0}, end) ==
        "G1 F300\nA10. F200 M8\nX50.030 Y0.040 A29.9900 F0.5002501\nA30.0000 F200\n");
  CHECK(divided_turn("G1 F300\nA30\n", inserted, inserted) ==
        "G1 F300\nX50.030 A10.0000 F0.9000000\nA30 F300.\n");
  // The way of 2 mm ends half a digit before its time: 0.005 degrees.
  CHECK(divided_turn("G1 F300\nA30\n", inserted, {50.03, 2, 0}) ==
        "G1 F300\nX50.030 A10.0000 F0.9000000\nY2.000 A29.9950 F30.00750\nA30 F300.\n");
  CHECK(divided_turn("G1 F300\nA30\n", {50, 0, 0}, {50, 0, 0}) == "G1 F300\nA10.0000\nA30\n");
  // F is in degrees per minute under G20, too: 2 s, and 0.0100 inch.
  CHECK(divided_turn("G1 F300\nA30\n", {50.8, 0, 0}, {50.8, 0, 0}, "G20 G90 G94 G0 X1.99 Y0 Z0 A0 B0 C0\n") ==
        "G1 F300\nX2.0000 A10.0000 F0.3000000\nA30 F300.\n");
}

TEST_CASE("a step of the correction before a block that only turns the tool keeps F") {
  const Program program = read_turning(std::string(turn_start) + "G1 F300\nA30\n");
  MoveEdit edit = edit_of(program, 1);
  edit.inserted = {{{50.5, 0, 0}, {}, OrientationNumbers{0.04, 0, 0}}};
  edit.end_mm = {50.53, 0, 0};
  CHECK(rewrite(program, {edit}, {}).text ==
        std::string(turn_start) + "G1 F300\nX50.500 A0.0400\nX50.530 A29.9900 F0.3005008\nA30 F300.\n");
}

TEST_CASE("under G93 pieces of a block that only turns the tool share its time by their turns") {
  CHECK(divided_turn("G93 G1 A30 F2\n", {50.03, 0, 0}, {50.03, 0.04, 0}) ==
        "G93 G1 X50.030 A10. F5.99999\nG1 Y0.040 A30.0000 F3.000002\n");
}

TEST_CASE("a block that only turns the tool is refused if its pieces cannot have its time") {
  const Vector3 inserted(50.03, 0, 0), end(50.03, 0.04, 0);
  CHECK_THROWS_AS(divided_turn("G1 F300 G61.1\nA30\n", inserted, end), InputError);
  CHECK_THROWS_AS(divided_turn("G1 F300\n/A30\n", inserted, end), InputError);
  CHECK_THROWS_AS(divided_turn("G1\nA30\n", inserted, end), InputError);
  CHECK_THROWS_AS(divided_turn("G95 S1000 M3\nG1 F.3\nA30\n", inserted, end), InputError);
  CHECK(divided_turn("G1 F300\nG61.1 A0.015\n", inserted, end) == "G1 F300\nG61.1 X50.030 Y0.040 A0.015\n");
}
