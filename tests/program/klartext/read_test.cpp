#include <doctest/doctest.h>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext: after M140 the height of the tool is unknown") {
  for (const char* retract : {"L M140 MB MAX\n", "M140 MB MAX\n", "L X+1 M140 MB50\n"}) {
    CAPTURE(retract);
    const Program program = read("BEGIN PGM A MM\nTOOL CALL 1 Z S1000 F100\nL X+0 Y+0 Z+5 R0 FMAX\n" +
                                     std::string(retract) + "L X+300 Y+200 FMAX\nL Z+5 FMAX\nEND PGM A MM\n",
                                 "heidenhain");
    const Move& across = program.moves.at(program.moves.size() - 2);
    CHECK(across.known_start == std::array<bool, 3>{true, true, false});
    CHECK(across.known_end == std::array<bool, 3>{true, true, false});
    // No inserted word of Z moves back down.
    const MoveEdit edit{.move = program.moves.size() - 2, .end_mm = {300.5, 200.25, 5.125}};
    CHECK(rewrite(program, {edit}, {}).text.find("L X+300.5 Y+200.25 FMAX\n") != std::string::npos);
  }
}

TEST_CASE("klartext: blocks may have N words, and brackets behind words are comments") {
  const Program program =
      read("BEGIN PGM A MM\nN1 L X+0 Y+0 Z+0 FMAX (start (1)\nN2 L X+20 F200\nN3 L Y+20\nN4 END PGM A MM\n");
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].block_number == 2);
  CHECK(rewrite(program, {{.move = 1, .inserted = {{{10, 0.1, 0}}}, .end_mm = {20, 0, 0}}}, {}).text ==
        "BEGIN PGM A MM\nN1 L X+0 Y+0 Z+0 FMAX (start (1)\nN2 L X+10.000 Y+0.100 F200\nN3 L X+20 Y+0.000 "
        "F200\nN4 L Y+20\nN5 END PGM A MM\n");
}

TEST_CASE("klartext: LA is the number of blocks of M120") {
  CHECK(all_known(read(klartext({"L X+0 Y+0 Z+50 R0 FMAX M3 M120 LA5"})).moves.at(0).known_end));
  CHECK(read(klartext({"L X+0 Y+0 Z+50 R0 FMAX M3 LA5"})).moves.at(0).fixed[0]);
}

TEST_CASE("klartext: L moves with modal feed, rapid for one block, points and commas") {
  const Program program = read(klartext({"TOOL CALL 3 Z S2500", "L X+10 Y-2,5 Z+50 R0 FMAX M3", "L Z-1. F250",
                                         "L IX+5", "L X+20 F MAX", "L Y1"}));
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[0].motion == Motion::rapid);
  CHECK(program.moves[0].end_mm == Vector3(10, -2.5, 50));
  CHECK(program.moves[0].tool == 3);
  CHECK(program.moves[0].spindle_rpm == 2500);
  CHECK(program.moves[1].feed_mm_min == 250);
  CHECK(program.moves[2].relative);
  CHECK(program.moves[2].end_mm.x() == 15);
  CHECK(program.moves[3].motion == Motion::rapid);
  CHECK(program.moves[4].motion == Motion::feed);
  CHECK(program.moves[4].feed_mm_min == 250);
}

TEST_CASE("klartext: feeds of an inch program are tenths of an inch per minute") {
  const Program program = read(klartext({"L X+1 F100"}, "INCH"));
  CHECK(program.moves.at(0).feed_mm_min == doctest::Approx(254));
}

TEST_CASE(
    "klartext: coordinates without a number and numbers that no control reads are refused with their "
    "position") {
  CHECK(klartext_refusal({"L X+1 FMAX", "L Xnan Y1"}) ==
        "p.ngc:3:5: error: X has no number: 'nan' follows it");
  CHECK(klartext_refusal({"L Z nan FMAX"}) == "p.ngc:2:5: error: Z has no number: 'nan' follows it");
  CHECK(klartext_refusal({"L X1 M399999999990"}) ==
        "p.ngc:2:8: error: M399999999990 is not a code: expected an integer from 0 to 99999");
  CHECK(klartext_refusal({"L X1e5"}) == "p.ngc:2:7: error: X1e5: a number has no exponent here");
  CHECK(klartext_refusal({"L Y1 X0," + std::string(61, '0')}) ==
        "p.ngc:2:8: error: X: a number with 61 decimals; at most 60 are allowed: shorten it");
  CHECK(klartext_refusal({"L X100000"}) == "p.ngc:2:5: error: X100000: coordinates are at most 99999.9999");
  CHECK(klartext_refusal({"CYCL DEF 7.1 Xnan"}) == "p.ngc:2:16: error: X has no number: 'nan' follows it");
  CHECK(klartext_refusal({"<<<<<<< mine"}).starts_with("p.ngc:2:3: error: '<<<<<<<' is a conflict marker"));
  CHECK(diagnostic_of([&] {
          read("L X1 FMAX\n", "heidenhain");
        }).starts_with("p.ngc:1:1: error: a move before the unit"));
}

TEST_CASE("klartext: incremental words beside absolute ones are followed, and stay incremental") {
  const std::vector<std::string> blocks{"L X+0 Y+0 Z+5 FMAX", "L Z-2 F200", "L X+20 IY+5", "L X+30 IZ+1"};
  const Program program = read(klartext(blocks));
  CHECK(program.moves[2].end_mm == Vector3(20, 5, -2));
  CHECK(all_known(program.moves[2].known_end));
  CHECK(program.moves[3].end_mm == Vector3(30, 5, -1));
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+0.5 Y-0.25 Z+5.125 FMAX", "L Z-1.875 F200", "L X+20.5 IY+5", "L X+30.5 IZ+1"}));
  // With a small rotation: differences of positions in the text, so that rounding errors do not add up.
  const auto out = rewrite(program,
                           {{.move = 0, .end_mm = {0, 0.0004, 5}},
                            {.move = 2, .end_mm = {20, 5.0204, -2}},
                            {.move = 3, .end_mm = {30, 5.0304, -1}}},
                           {});
  CHECK(out.text == klartext({"L X+0 Y+0 Z+5 FMAX", "L Z-2 F200", "L X+20 IY+5.02", "L X+30 IZ+1 Y+5.030"}));
}

TEST_CASE("klartext: Q parameters fix their axis, machine positions make their axes unknown") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "L X+Q21 Y+5 F100", "L Z + Q13 FMAX",
                                         "L X+1 IZ-Q2", "L Z-10 FMAX M91", "L X+2"}));
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[1].fixed == std::array{true, false, false});
  CHECK(program.moves[1].words[1]);
  CHECK(program.moves[1].known_end == std::array{false, true, true});
  CHECK(program.moves[2].fixed == std::array{false, false, true});
  CHECK(program.moves[3].fixed == std::array{false, false, false});
  CHECK(program.moves[4].known_start[2] == false);
  CHECK(program.moves[4].line == 7);
}

TEST_CASE("klartext: a block that is not followed is a move fixed on all axes, with its reason") {
  for (const std::string block :
       {"CALL LBL 4", "CALL PGM B.H", "APPR LT X+Q1 Y+2 LEN10 RR F300", "LP PR+10 PA+20",
        "PLANE SPATIAL SPA+10 SPB+0 SPC+0 STAY", "X+5 F100", "TCH PROBE 400", "FUNCTION TCPM F TCP"}) {
    CAPTURE(block);
    const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", block, "L X+3"}));
    REQUIRE(program.moves.size() == 3);
    CHECK(program.moves[1].fixed == std::array{true, true, true});
    CHECK(program.moves[2].known_start == std::array{false, false, false});
    CHECK(program.left_alone.at(0).line == 3);
  }
}

TEST_CASE("klartext: the report shows what is assumed of calls") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "CALL LBL 4", "CALL PGM B.H", "L X+3"}));
  REQUIRE(program.remarks.size() == 1);
  CHECK(program.remarks[0].line == 3);
  CHECK(program.remarks[0].what ==
        "assumed from here on: called programs do not change the datum, the coordinates (shift, rotation, "
        "mirror image, scale, tilt, M128) and the tool; see that their text agrees");
}

TEST_CASE("klartext: a program that is called as a cycle may set the feed, and is a feed move at each call") {
  const std::string definition = "CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM B";
  for (const char* call : {"CYCL CALL", "L Z+0 FMAX M91 M99", "L X+5 FMAX M99", "M99"}) {
    CAPTURE(call);
    const Program program =
        read(klartext({"L X+0 Y+0 Z+0 F100", definition, call, "L X+0 Y+0 Z+5 FMAX", "L X+9"}));
    CHECK(program.moves.back().feed_mm_min == 0);
    CHECK_FALSE(any_axis(program.moves[program.moves.size() - 2].known_start));
    const bool is_machine_position = program.left_alone.at(0).machine_position;
    CHECK((is_machine_position ? program.left_alone[0].feeds : program.moves[1].fixed[2]));
    REQUIRE(program.remarks.size() == 1);
    CHECK(program.remarks[0].line == 4);
    CHECK(program.remarks[0].what.starts_with("assumed from here on: called programs do not change"));
  }
}

TEST_CASE("klartext: coordinates are unknown behind a probing cycle that sets them") {
  const auto why = [](const std::string& probe) {
    const Program program = read(
        klartext({"L X+0 Y+0 Z+0 FMAX", probe, "CYCL DEF 247 Q339=+1", "L X+1 Y+0 Z+0 FMAX", "L X+9 F100"}));
    const bool is_known = all_known(program.moves.back().known_start);
    CHECK(is_known == (program.left_alone.size() == 1 && program.left_alone[0].why.ends_with("supported")));
    return program.left_alone.back().why;
  };
  CHECK(why("TCH PROBE 411 DATUM OUTS. RECTAN. ~\n    Q321=+50 ;CENTER") ==
        "TCH PROBE 411 sets the datum: coordinates are unknown");
  CHECK(why("TCH PROBE 408 SLOT CENTER REF PT") == "TCH PROBE 408 sets the datum: coordinates are unknown");
  CHECK(why("TCH PROBE 419 DATUM") == "TCH PROBE 419 sets the datum: coordinates are unknown");
  CHECK(why("TCH PROBE 400 BASIC ROTATION") ==
        "TCH PROBE 400 turns the coordinates (basic rotation): coordinates are unknown");
  CHECK(why("TCH PROBE 451 MEASURE KINEMATICS") ==
        "TCH PROBE 451 may change the kinematics of the machine: coordinates are unknown");
  CHECK(why("TCH PROBE 1410 PROBING ON EDGE") ==
        "TCH PROBE 1410 may set the datum or turn the coordinates: coordinates are unknown");
  for (const int measuring : {407, 420, 421, 431}) {
    CAPTURE(measuring);
    CHECK(why(fmt::format("TCH PROBE {} MEASURE", measuring)) ==
          fmt::format("TCH PROBE {} is not supported", measuring));
  }
  CHECK(why("TCH PROBE 0.0 REF. PLANE Q5 X-") == "TCH PROBE 0 is not supported");
}

TEST_CASE("klartext: the numbers of labels may have leading zeros") {
  for (const char* blocks : {"LBL 05\nL IX+1\nCALL LBL 5 REP 2\n", "LBL 5\nL IX+1\nCALL LBL 005 REP 2\n",
                             "LBL 05\nL IX+1\nFN 9: IF +Q1 EQU +0 GOTO LBL 5\n"}) {
    CAPTURE(blocks);
    const Program program =
        read(std::string("BEGIN PGM A MM\nL X+0 Y+0 Z+0 F100\n") + blocks + "END PGM A MM\n", "heidenhain");
    CHECK_FALSE(program.moves.at(1).known_end[0]);
  }
}

TEST_CASE("klartext: blocks that a label repeats, calls or skips are not corrected") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "LBL 1", "L X+5 F100", "L IX+5", "CALL LBL 1 REP 2",
                     "L X+7 Y+7 Z+7", "FN 9: IF +Q1 EQU +Q2 GOTO LBL 3", "L X+9", "LBL 3", "L X+8"}));
  REQUIRE(program.moves.size() == 7);
  CHECK(program.moves[1].fixed[0]);
  CHECK_FALSE(program.moves[2].fixed[0]);
  CHECK_FALSE(all_known(program.moves[2].known_end));
  CHECK_FALSE(program.moves[4].fixed[0]);
  CHECK(program.moves[5].fixed[0]);
  CHECK_FALSE(program.moves[6].fixed[0]);
}

TEST_CASE("klartext: forces are read from comments") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "; FORCE FX=-30 FZ=12", "L X+5 F100"}));
  REQUIRE(program.moves[1].force);
  CHECK((*program.moves[1].force)[0] == -30);
}

TEST_CASE("klartext: axes without a number behind M94 and M138 do not move") {
  for (const char* block : {"L M94 C", "L M138 C", "L M138 A C", "M94 C", "L M94"}) {
    CAPTURE(block);
    const Program program = read(klartext({"L X+0 Y+0 Z+5 FMAX", block, "L X+10 F100"}));
    REQUIRE(program.moves.size() == 2);
    CHECK(all_known(program.moves[1].known_end));
    CHECK(program.left_alone.empty());
  }
  CHECK(klartext_refusal({"L C"}).find("C has no number") != std::string::npos);
}

TEST_CASE("klartext: axes behind M118 are limits of the handwheel and no coordinates") {
  const Program program = read(klartext(
      {"L X+0 Y+0 Z+0 FMAX", "L X+60 F500 M118 X1 Y1 Z2", "L Y+30 M118 ZQ5", "M118 X1 Y1", "L X+50"}));
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].end_mm == Vector3(60, 0, 0));
  CHECK(program.moves[2].end_mm == Vector3(60, 30, 0));
  CHECK(all_known(program.moves[3].known_end));
  // Words of the block are inserted before M118.
  const MoveEdit edit{.move = 1, .end_mm = {60.5, 0.25, 0.125}};
  CHECK(rewrite(program, {edit}, {}).text.find("L X+60.5 Y+0.250 Z+0.125 F500 M118 X1 Y1 Z2\n") !=
        std::string::npos);
  CHECK(read(klartext({"L X+0 Y+0 Z+0 FMAX", "L M118 X1 F500 X+20"})).moves.at(1).fixed[0]);
}

TEST_CASE("klartext: an axis twice, and coordinates in blocks that do not move, are refused") {
  CHECK(klartext_refusal({"L X+60 Y+40 Y+7"}) == "p.ngc:2:15: error: Y occurs twice in the block");
  CHECK(klartext_refusal({"L X+60 IX+1"}) == "p.ngc:2:10: error: X occurs twice in the block");
  CHECK(klartext_refusal({"RND R5 X+20"}) ==
        "p.ngc:2:10: error: X is not allowed in a block with RND: write it in a block of its own with L");
  for (const char* block : {"CHF 5 Y+20", "STOP X+20", "TOOL CALL S2000 X+20", "LBL 3 X+20"}) {
    CAPTURE(block);
    CHECK(klartext_refusal({block}).find(" is not allowed in a block with ") != std::string::npos);
  }
  for (const char* block : {"RND R5 F200", "STOP M6", "TOOL CALL 5 Z S2000 F500 DL+0.1", "LBL \"X 20\"",
                            "TOOL CALL \"MILL X5\" Z S2000", "TOOL DEF 7", "LBL 3 ; X+20", "STOP (to X20)"}) {
    CAPTURE(block);
    CHECK(klartext_refusal({block}) == "none");
  }
}

TEST_CASE("klartext: PLANE with MB retracts along the tool, PLANE RESET and a plane of zeros turn nothing") {
  const auto behind = [](const std::string& plane) {
    return read(klartext({"L X+0 Y+0 Z+0 FMAX", plane, "L X+80 F500"})).moves.back();
  };
  using Known = std::array<bool, 3>;
  CHECK(behind("PLANE RESET TURN MB50 FMAX").known_start == Known{true, true, false});
  CHECK(behind("PLANE RESET STAY").known_start == Known{true, true, true});
  CHECK(behind("PLANE SPATIAL SPA+0 SPB+0 SPC+0 STAY").known_start == Known{true, true, true});
  CHECK(behind("PLANE SPATIAL SPA+0 SPB-0.000 SPC+0 TURN MBMAX FMAX").known_start ==
        Known{true, true, false});
  for (const char* tilt : {"PLANE SPATIAL SPA+0 SPB+0.5 SPC+0 STAY", "PLANE SPATIAL SPA+0 SPB+Q1 SPC+0 STAY",
                           "PLANE SPATIAL SPA+0 SPB+0 STAY", "PLANE SPATIAL SPA+0 SPB+0 SPC+05 STAY"}) {
    CAPTURE(tilt);
    CHECK(behind(tilt).fixed[0]);
  }
}

TEST_CASE("klartext: the end of a FUNCTION that does not act moves nothing") {
  for (const char* function : {"FUNCTION RESET TCPM", "FUNCTION MODE MILL"})
    CHECK(read(klartext({function, "L X+0 Y+0 Z+0 FMAX"})).moves.size() == 1);
  for (const char* function : {"FUNCTION TCPM F TCP AXIS POS", "FUNCTION MODE MILL \"KIN\""})
    CHECK(read(klartext({function, "L X+0 Y+0 Z+0 FMAX"})).moves.size() == 2);
}

TEST_CASE("klartext: --evaluate works out FN 5 to FN 8") {
  ReadOptions options;
  options.evaluate = true;
  const auto x_of = [&](const std::string& function) {
    const Program program =
        read_program(klartext({"FN 0: Q2 = +30", function, "L X+Q1 Y+0 Z+0 FMAX"}), "p.h", options);
    return all_known(program.moves.at(0).known_end) ? program.moves[0].end_mm.x() : -1;
  };
  CHECK(x_of("FN 5: Q1 = SQRT +16") == doctest::Approx(4));
  CHECK(x_of("FN 6: Q1 = SIN +Q2") == doctest::Approx(0.5));
  CHECK(x_of("FN 7: Q1 = COS -60") == doctest::Approx(0.5));
  CHECK(x_of("FN 8: Q1 = +3 LEN -4") == doctest::Approx(5));
  CHECK(x_of("FN 13: Q1 = +3 ANG +4") == -1);
  CHECK(x_of("FN 5: Q1 = SQRT Q9") == -1);
}
