#include <doctest/doctest.h>

#include <algorithm>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE(
    "klartext: a reset of planes does not move, and blocks under a displacement move only by program words") {
  const std::string begin = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000 F100\nL X+0 Y+0 Z+5 R0 FMAX\n",
                    end = "L X+3\nEND PGM A MM\n";
  const Program reset = read(begin + "PLANE RESET STAY\nPLANE RESET TURN FMAX\n" + end, "heidenhain");
  REQUIRE(reset.moves.size() == 2);
  CHECK(all_known(reset.moves[1].known_start));
  const auto moved_only = [&](const std::string& blocks) {
    return read(begin + blocks + end, "heidenhain").moves.back().moved_only_by_program;
  };
  CHECK(moved_only("CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X\n") == std::array<bool, 3>{true, true, true});
  CHECK(moved_only("L Z+0 FMAX M91\nCYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X\n") ==
        std::array<bool, 3>{true, true, false});
  CHECK(moved_only("") == std::array<bool, 3>{});
}

TEST_CASE("klartext: moves in shifted, rotated and tilted coordinates are fixed until the reset") {
  for (const auto& [on, off] : {std::pair{"CYCL DEF 7.1 X+Q1", "CYCL DEF 7.1 X+0"},
                                {"CYCL DEF 7.1 C+10", "CYCL DEF 7.1 C+0"},
                                {"/CYCL DEF 7.1 X+10", "CYCL DEF 7.1 X+0"},
                                {"CYCL DEF 10.1 ROT+Q3", "CYCL DEF 10.1 ROT+0"},
                                {"CYCL DEF 8.1 X", "CYCL DEF 8.1"},
                                {"CYCL DEF 11.1 SCL 0.99", "CYCL DEF 11.1 SCL 1"},
                                {"PLANE SPATIAL SPA+1 SPB+0 SPC+0 STAY", "PLANE RESET STAY"}}) {
    const auto& shown = on;
    CAPTURE(shown);
    const Program program = read(klartext({on, "L X+1 Y+1 Z+1 F100", off, "L X+1 Y+1 Z+1"}));
    const auto moving = [](const Move& move) { return move.words[0] || move.words[1]; };
    CHECK(std::count_if(program.moves.begin(), program.moves.end(), moving) == 1);
    CHECK(program.moves.back().fixed == std::array{false, false, false});
  }
}

TEST_CASE("klartext: coordinates are unknown behind TRANS and behind data that the program writes") {
  const auto last = [](const std::string& block) {
    return read(klartext({block, "L X+0 Y+0 Z+5 FMAX", "L X+10 F100"})).moves.back();
  };
  for (const char* block :
       {"TRANS DATUM AXIS Y+500", "TRANS DATUM TABLE TABLINE5", "TRANS MIRROR AXIS X",
        "TRANS ROTATION ROT+90", "TRANS SCALE SCL0.9", "TRANS DATUM RESET\nTRANS SCALE SCL2",
        "FN 25: PRESET = Y/+5/+500", "FN 17: SYSWRITE ID 210 NR3 IDX0 = +30",
        "CYCL DEF 10.1 ROT+90\nTRANS ROTATION RESET"}) {
    CAPTURE(block);
    CHECK(last(block).fixed[0]);
    CHECK_FALSE(last(block).known_end[0]);
  }
  for (const char* block :
       {"TRANS DATUM RESET", "TRANS DATUM AXIS Y+500\nTRANS DATUM RESET", "TRANS MIRROR RESET",
        "TRANS ROTATION RESET", "TRANS SCALE RESET", "CYCL DEF 7.1 X+Q1\nTRANS DATUM RESET"}) {
    CAPTURE(block);
    CHECK(all_known(last(block).known_start));
    CHECK(last(block).words[0]);
  }
  const Program preset = read(klartext({"FN 25: PRESET = Y/+5/+500", "L X+0 Y+0 Z+5 FMAX"}));
  CHECK(preset.remarks.at(0).what == "FN 25: PRESET sets the datum: coordinates are unknown");
}

TEST_CASE("klartext: a datum shift by plain numbers is a frame, and the words stay in it") {
  const Program program = read(klartext(
      {"L X+1 Y+2 Z+3 FMAX", "CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 X+10", "CYCL DEF 7.2 IY-5",
       "L X+0 F100", "CYCL DEF 7.1 IX+1", "L Y+0", "CYCL DEF 7.1 X+0", "CYCL DEF 7.2 Y+0", "L Z+1"}));
  REQUIRE(program.moves.size() == 4);
  const auto in_base = [&](const Move& move, const Vector3& p) {
    return Vector3(in_offset(program.frames.at(move.frame)) * p);
  };
  CHECK(program.moves[1].start_mm == Vector3(-9, 7, 3));
  CHECK(program.moves[1].end_mm == Vector3(0, 7, 3));
  CHECK(in_base(program.moves[1], program.moves[1].end_mm) == Vector3(10, 2, 3));
  CHECK(in_base(program.moves[2], program.moves[2].end_mm) == Vector3(10, -5, 3));
  CHECK(in_base(program.moves[3], program.moves[3].end_mm) == Vector3(10, -5, 1));
  CHECK(program.moves[3].frame == 0);
  CHECK(program.left_alone.empty());
  CHECK(klartext_shifted(program).find("CYCL DEF 7.2 IY-5\n5 L X+0.5 F100\n") != std::string::npos);
}

TEST_CASE("klartext: a rotation about Z is a frame about the shifted datum") {
  const Program program = read(
      klartext({"L X+1 Y+2 Z+3 FMAX", "CYCL DEF 7.1 X+10", "CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+90",
                "L X+5 Y+1 F100", "CYCL DEF 10.1 IROT-90,0", "L X+3 Y+0", "CYCL DEF 7.1 X+0", "L Y+2"}));
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].known_start == std::array<bool, 3>{false, false, true});
  CHECK((in_offset(program.frames.at(program.moves[1].frame)) * program.moves[1].end_mm - Vector3(9, 5, 3))
            .norm() < 1e-12);
  CHECK((in_offset(program.frames.at(program.moves[2].frame)) * program.moves[2].end_mm - Vector3(13, 0, 3))
            .norm() < 1e-12);
  CHECK(program.moves[3].end_mm.isApprox(Vector3(13, 2, 3)));
  const Program later =
      read(klartext({"L X+1 Y+2 Z+3 FMAX", "CYCL DEF 10.1 ROT+90", "CYCL DEF 7.1 X+10", "L X+5 Y+1"}));
  CHECK(later.moves.back().fixed[0]);
  CHECK(later.left_alone.back().why ==
        "CYCL DEF 7 shifts coordinates that CYCL DEF 10 has turned; shift them before");
  const Program twice = read(klartext(
      {"L X+1 Y+2 Z+3 FMAX", "CYCL DEF 10.1 ROT+90", "CYCL DEF 7.1 X+10", "CYCL DEF 7.1 X+10", "L X+5 Y+1"}));
  CHECK(twice.moves.back().fixed[0]);
}

TEST_CASE("klartext: the end of the shift along one axis leaves that of a datum table along the others") {
  const auto last = [](const std::string& blocks) {
    return read(klartext({"CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 #5", blocks, "L X+0 Y+0 Z+5 FMAX",
                          "L X+10 F100"}))
        .moves.back();
  };
  for (const char* block : {"CYCL DEF 7.1 X+0", "CYCL DEF 7.1 X+0\nCYCL DEF 7.2 Y+0"}) {
    CAPTURE(block);
    CHECK(last(block).fixed[0]);
  }
  CHECK_FALSE(last("CYCL DEF 7.1 X+0\nCYCL DEF 7.2 Y+0\nCYCL DEF 7.3 Z+0").fixed[0]);
}

TEST_CASE("klartext: PRESET, FUNCTION and M143 change the coordinates") {
  const auto last = [](const std::string& blocks) {
    return read(klartext({blocks, "L X+0 Y+0 Z+5 FMAX", "L X+10 F100"})).moves.back();
  };
  const std::string moves = "L X+0 Y+0 Z+5 FMAX\n";
  for (const std::string& blocks :
       {std::string("PRESET SELECT #3\nPRESET SELECT #4"),
        std::string("CYCL DEF 247 Q339=+3\nPRESET SELECT #4"), std::string("PRESET CORR X+2"),
        std::string("PRESET SELECT \"NEW\" KEEP TRANS"), std::string("FUNCTION PARAXMODE X Y W"),
        std::string("FUNCTION MODE TURN"), std::string("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"),
        moves + "L M143", std::string("/L M143"), "L M143\nPRESET SELECT #3\n" + moves + "L M143",
        "PRESET SELECT #3\n" + moves + "L M143\nPRESET SELECT #3"}) {
    CAPTURE(blocks);
    CHECK(last(blocks).fixed[0]);
  }
  for (const std::string& blocks :
       {std::string("PRESET SELECT #3"), std::string("CYCL DEF 247 Q339=+3\nPRESET SELECT #3"),
        std::string("FUNCTION PARAXMODE X Y W\nFUNCTION PARAXMODE OFF"),
        std::string("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nFUNCTION RESET TCPM"), std::string("L M143"),
        "L M143\n" + moves + "L M143"}) {
    CAPTURE(blocks);
    CHECK(all_known(last(blocks).known_end));
    CHECK_FALSE(last(blocks).fixed[0]);
  }
  CHECK(read(klartext({"PRESET SELECT #3", moves})).remarks.at(0).what == "PRESET SELECT selects preset 3");
}
