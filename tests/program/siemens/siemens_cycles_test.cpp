/// Drilling cycles of a Sinumerik: their heights are shifted with the holes.
#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/program/program.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr std::string_view start = "G90 G17 G71 G54\nT1 D1 M6\nG0 X10 Y10 Z50 S1000 M3\n";

Program drilled(const std::string& lines) {
  ReadOptions options;
  options.dialect = "siemens";
  options.unit = LengthUnit::millimetres;
  return read_program(std::string(start) + lines, "p.mpf", options);
}

std::string shifted_lines(const std::string& lines) {
  const std::string text = shifted_text(drilled(lines), {0.5, -0.25, 0.125});
  return text.substr(text.find('\n', text.find("G0 ")) + 1);
}

// Whether the last move gets a position of its own.
bool is_fixed(const std::string& lines) {
  const Move move = drilled(lines).moves.back();
  return move.fixed[0] || move.fixed[2];
}

}  // namespace

TEST_CASE("siemens: a cycle that '/' may skip is left alone for that reason") {
  CHECK(drilled("/CYCLE81(50,0,2,-20)\n").left_alone.at(0).why == "'/' may skip this cycle");
}

TEST_CASE("siemens: all absolute heights of a called cycle are shifted, in their own digits") {
  CHECK(shifted_lines("CYCLE81(50,0,2,-20)\n") == "CYCLE81(50.125,0.125,2,-19.875)\n");
  CHECK(shifted_lines("N5 CYCLE82( 50.0, 0.0, 2 , -20.0 , , 0.5) ; hole\n") ==
        "N5 CYCLE82( 50.125, 0.125, 2 , -19.875 , , 0.5) ; hole\n");
  CHECK(shifted_lines("CYCLE83(50,0,2,-30,,-5,,2,0,0.5,1,0)\n") ==
        "CYCLE83(50.125,0.125,2,-29.875,,-4.875,,2,0,0.5,1,0)\n");
  CHECK(shifted_lines("CYCLE84(50,0,2,,15,0.5,5)\n") == "CYCLE84(50.125,0.125,2,,15,0.5,5)\n");
  CHECK(shifted_lines("cycle86(50,0,2,-20,,0.5,3,.2,.2,,45)\n") ==
        "cycle86(50.125,0.125,2,-19.875,,0.5,3,.2,.2,,45)\n");
}

TEST_CASE("siemens: a called cycle leaves the tool at its retract plane") {
  const Program program = drilled("CYCLE81(30,0,2,-20)\nG0 X60\n");
  REQUIRE(program.moves.size() == 3);
  const Move& hole = program.moves[1];
  CHECK(hole.makes_hole);
  CHECK(hole.motion == Motion::rapid);
  CHECK(hole.end_mm == Vector3(10, 10, 0));
  CHECK(program.moves[2].start_mm == Vector3(10, 10, 30));
  CHECK(all_known(program.moves[2].known_start));
}

TEST_CASE("siemens: the bottom of a hole is DP, or DPR below the reference plane, or not known") {
  const auto bottom_of = [](const std::string& call) {
    const Program program = drilled(call + "\n");
    REQUIRE(program.moves.back().called);
    return program.moves.back().called->heights_mm[2];
  };
  CHECK(bottom_of("CYCLE81(50,0,2,-20)") == -20);
  CHECK(bottom_of("CYCLE82(50,1,2,,15,0.5)") == -14);
  CHECK(bottom_of("CYCLE82(50,1,2,,-15)") == -14);
  CHECK(bottom_of("CYCLE81(50,1,2,-20,15)") == -14);
  CHECK(bottom_of("CYCLE81(50,1,2,-20,0)") == -20);
  CHECK(std::isnan(bottom_of("CYCLE81(50,1,2,-20,R1)")));
  CHECK(std::isnan(bottom_of("CYCLE81(50,0,2)")));
  CHECK(std::isnan(bottom_of("CYCLE81(50,0,2,,R1)")));
}

TEST_CASE("siemens: arguments that newer controls append must leave axis and heights as they are") {
  for (const char* call :
       {"CYCLE81(50,0,2,-20,,0,0,1,12)", "CYCLE81(50,0,2,,20,0,0,1,11)", "CYCLE82(50,0,2,-20,,0.6,0,0,0)",
        "CYCLE83(50,0,2,-30,,,5,90,0.6,0.6,90,0,0,5,1.4,0.6,1.6,0,1,12211112)",
        "CYCLE83(50,0,2,-30,,-5,,2,0,0.5,1,0,3)", "CYCLE86(50,0,2,-20,,0.5,3,.2,.2,,45,0,1,12)",
        "CYCLE84(50,0,2,,15,0.5,5,,1.25,0,300,300,0,1,0,0,5,1.4,,,,0,1,11)"}) {
    CAPTURE(call);
    CHECK_FALSE(is_fixed(std::string(call) + "\n"));
  }
  for (const char* call :
       {"CYCLE81(50,0,2,6,,0,10,1,11)", "CYCLE81(50,0,2,-20,,0,1)", "CYCLE81(50,0,2,-20,,0,0,2)",
        "CYCLE81(50,0,2,-20,,0,0,1,11)", "CYCLE82(50,0,2,-20,,0,R1)", "CYCLE82(50,0,2,-20,,0,0,1,2,1)",
        "CYCLE82(50,0,2,,20,0,0,1,12)", "CYCLE83(50,0,2,-30,,-5,,2,0,0.5,1,0,1)",
        "CYCLE83(50,0,2,-30,,-5,,2,0,0.5,1,0,0,0,0,0,0,0,1,12)", "CYCLE840(50,0,2,-20,,0,4,3,1,6,,1)"}) {
    CAPTURE(call);
    CHECK(is_fixed(std::string(call) + "\n"));
    CHECK(drilled(std::string("MCALL ") + call + "\nX20 Y10\n").moves.back().fixed[2]);
  }
}

TEST_CASE("siemens: MCALL is written again if the heights of a hole differ from those in the text") {
  CHECK(shifted_lines("MCALL CYCLE81(50,0,2,-20) ; all\nX20 Y10\nX30\nMCALL\nG0 Z99\n") ==
        "MCALL CYCLE81(50,0,2,-20) ; all\nMCALL CYCLE81(50.125,0.125,2,-19.875)\nX20.5 "
        "Y9.75\nX30.5\nMCALL\nG0 Z99.125\n");
  const Program program = drilled("N5 MCALL CYCLE81(50,0,2,-20)\nX20 Y10\nX30\nMCALL\n");
  REQUIRE(program.moves.size() == 3);
  const std::vector<MoveEdit> edits{{.move = 1, .end_mm = {20, 10, 0.2}}};
  // The second hole is not edited: it gets the heights of the original.
  CHECK(rewrite(program, edits, {})
            .text.ends_with("N5 MCALL CYCLE81(50,0,2,-20)\nMCALL CYCLE81(50.2,0.2,2,-19.8)\nX20 Y10\n"
                            "MCALL CYCLE81(50,0,2,-20)\nX30\nMCALL\n"));
}

TEST_CASE("siemens: under G91 holes are relative to the hole before, their heights are not") {
  const Program program = drilled("MCALL CYCLE81(50,0,2,-20)\nX20 Y10\nG91 X5\nG90 MCALL\n");
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[2].end_mm == Vector3(25, 10, 0));
  CHECK(is_relative(program.moves[2], 0));
  CHECK(is_relative(program.moves[2], 1));
  CHECK_FALSE(is_relative(program.moves[2], 2));
}

TEST_CASE("siemens: a milling cycle is shifted with its centre and its absolute heights") {
  CHECK(shifted_lines("POCKET3(50,0,2,-10,60,20,5,50,40.0,0,4,0.1,0.1,500,200,0,11,5)\n") ==
        "POCKET3(50.125,0.125,2,-9.875,60,20,5,50.5,39.75,0,4,0.1,0.1,500,200,0,11,5)\n");
  CHECK(shifted_lines("POCKET1(50,0,2,-10,15,60,20,5,50,40.0,0,4,0.1,0.1,3)\n") ==
        "POCKET1(50.125,0.125,2,-10,15,60,20,5,50.5,39.75,0,4,0.1,0.1,3)\n");
  CHECK(shifted_lines("N7 POCKET4(50, 0, 2, -10, 25, 60, 40, 4) ; round\n") ==
        "N7 POCKET4(50.125, 0.125, 2, -9.875, 25, 60.5, 39.75, 4) ; round\n");
  CHECK(shifted_lines("LONGHOLE(50,0,2,-10,,4,30,40,45,20,45,90,100,320,6)\n") ==
        "LONGHOLE(50.125,0.125,2,-9.875,,4,30,40.5,44.75,20,45,90,100,320,6)\n");
  CHECK(shifted_lines("CYCLE71(10,0,2,-11,100,100,60,40,10,6,10,5,0,4000,31,2)\n") ==
        "CYCLE71(10.125,0.125,2,-10.875,100.5,99.75,60,40,10,6,10,5,0,4000,31,2)\n");
}

TEST_CASE("siemens: a milling cycle makes X and Y unknown, and is reported as not fully corrected") {
  const Program program = drilled("POCKET4(50,0,2,-10,25,60,40,4)\nG0 X60\n");
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].end_mm == Vector3(60, 40, 0));
  CHECK(program.moves[2].known_start == std::array{false, false, true});
  CHECK(program.moves[2].start_mm.z() == 50);
  CHECK(program.moves[1].mills_at_end);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 4);
}

TEST_CASE("siemens: the reason for a cycle that is not followed names the supported ones") {
  for (const std::string lines :
       {"CYCLE81(R1,0,2,-20)\n", "CYCLE81(50,,2,-20)\n", "POCKET4(50,0,2,-10,25,R1,40)\n",
        "POCKET4(50,0,2,-10,25,60)\n", "SLOT3(50,0,2,-20,0,0,100,50,0)\n",
        "POCKET4(50,0,2,-10,25,60,40,4,0,0,500,200,0,11,5,9,8,5,3,0,1,2,1100,111,111)\n",
        "CYCLE81(50,0,2,-20+1)\n", "/CYCLE81(50,0,2,-20)\n", "CYCLE72(50,0,2,-20,0,0,100,50,0)\n",
        "G18\nCYCLE81(50,0,2,-20)\n", "G70\nCYCLE81(50,0,2,-20)\n", "IF R1==1\nCYCLE81(50,0,2,-20)\nENDIF\n",
        "ROT Z30 X10\nCYCLE81(50,0,2,-20)\n", "MCALL CYCLE81(R1,0,2,-20)\nX5\n",
        "MCALL CYCLE81(50,0,2,-20)\nX5 Z10\n", "MCALL CYCLE81(50,0,2,-20)\nG2 X20 Y10 CR=8\n",
        "MCALL CYCLE81(50,0,2,-20)\nZ10\nX5\n", "/MCALL CYCLE81(50,0,2,-20)\nX5\n",
        "MCALL MY_HOLE(50,0,2,-20)\nX5\n"}) {
    CAPTURE(lines);
    CHECK(is_fixed(lines));
  }
}

TEST_CASE("siemens: the positions of an MCALL that is not followed are holes of unknown heights") {
  for (const std::string call : {"MCALL CYCLE81(50,0,2,R1)\n", "MCALL L100\n", "/MCALL CYCLE81(50,0,2,-20)\n",
                                 "MCALL CYCLE81(50,0,2,-20)\n/MCALL\n"}) {
    CAPTURE(call);
    const Program program = drilled(call + "X20 Y10\nX30\nMCALL\nG0 Z99\n");
    REQUIRE(program.moves.size() == 4);
    CHECK(program.moves[1].makes_hole);
    CHECK(program.moves[2].makes_hole);
    CHECK(program.moves[2].fixed == std::array{false, false, true});
    CHECK_FALSE(program.moves[3].makes_hole);
  }
}

TEST_CASE("siemens: the modal call of a line is found without its number and comment") {
  const auto found = modal_drilling_cycle("MCALL  CYCLE83(50, 0 ,2,-30,,-5) ; deep");
  REQUIRE(found);
  CHECK(found->modal == "MCALL  CYCLE83(50, 0 ,2,-30,,-5)");
  CHECK(found->heights_mm == std::array{0.0, 50.0, -30.0, -5.0});
  for (const std::string_view other :
       {"MCALL", "MCALL ", "MCALLCYCLE81(1,2,3,4)", "MCALL CYCLE81", "MCALL CYCLE81(1,2,3,4",
        "CYCLE81(1,2,3,4)", "MCALL HOLES2(0,0,5,0,0,4)", ""})
    CHECK(!modal_drilling_cycle(other));
}
