#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A program in Klartext around `blocks`, numbered.
std::string klartext(const std::vector<std::string>& blocks, const std::string& unit = "MM") {
  std::string text = "0 BEGIN PGM COVER " + unit + "\n";
  int number = 1;
  for (const std::string& block : blocks) text += fmt::format("{} {}\n", number++, block);
  return text + fmt::format("{} END PGM COVER {}\n", number, unit);
}

/// With calls replaced by the blocks that they call.
Program expanded_klartext(const std::string& text) {
  ReadOptions options;
  options.expand_subprograms = true;
  return read_program(text, "p.h", options);
}

const Vector3 klartext_shift(0.5, -0.25, 0.125);

std::string klartext_shifted(const Program& program, const WriteOptions& options = {}) {
  return shifted_text(program, klartext_shift, options);
}

std::string klartext_refusal(const std::vector<std::string>& blocks) {
  return diagnostic_of([&] { read(klartext(blocks)); });
}

}  // namespace

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

TEST_CASE("klartext is detected by its first statement") {
  CHECK(read("\r\n0 BEGIN PGM A MM\r\n1 END PGM A MM\r\n").dialect == "heidenhain");
  CHECK(read("G21\nG0 X1\n").dialect == "linuxcnc");
  CHECK(read("BEGIN PGM A INCH\nL X+1 FMAX\n").moves.at(0).end_mm.x() == doctest::Approx(25.4));
}

TEST_CASE("klartext is detected by its first statement behind comments of any kind") {
  for (const char* comments : {"( Sheet\n(   Machine: \"A\"\n(\n( End\n", "; one\n\n * two\n", "-----\r\n",
                               "($Message(\"open\"))\n", "\xEF\xBB\xBF", "0 ; one\n"}) {
    CAPTURE(comments);
    const std::string text = std::string(comments) + "BEGIN PGM A MM\nL X+1 Y+0 Z+0 FMAX\nEND PGM A MM\n";
    const Program program = read(text);
    CHECK(program.dialect == "heidenhain");
    REQUIRE(program.moves.size() == 1);
    CHECK(program.left_alone.empty());
    CHECK(klartext_shifted(program) ==
          std::string(comments) + "BEGIN PGM A MM\nL X+1.5 Y-0.25 Z+0.125 FMAX\nEND PGM A MM\n");
  }
  CHECK(read("(BEGIN PGM A MM)\nG21\nG0 X1\n").dialect == "linuxcnc");
}

TEST_CASE("the extension of a file name decides the dialect if the text does not") {
  const auto dialect_of_file = [](const std::string& text, const std::string& file) {
    ReadOptions options;
    options.unit = LengthUnit::millimetres;
    return read_program(text, file, options).dialect;
  };
  CHECK(dialect_of_file("TOOL CALL 1 Z S100\nL X+1 FMAX\n", "part.H") == "heidenhain");
  CHECK(dialect_of_file("L X+1 FMAX\n", "part.h") == "heidenhain");
  CHECK(dialect_of_file("G21\nG0 X1\n", "part.h") == "linuxcnc");
  CHECK(dialect_of_file("G71 G90\nG0 X1\n", "part.MPF") == "siemens");
  CHECK(dialect_of_file("G71 G90\nG0 X1\n", "part.spf") == "siemens");
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
  CHECK(klartext_refusal({"L X100000"}) == "p.ngc:2:5: error: X100000: coordinates are at most 99999.9999");
  CHECK(klartext_refusal({"CYCL DEF 7.1 Xnan"}) == "p.ngc:2:16: error: X has no number: 'nan' follows it");
  CHECK(klartext_refusal({"<<<<<<< mine"}).starts_with("p.ngc:2:3: error: '<<<<<<<' is a conflict marker"));
  CHECK(diagnostic_of([&] {
          read("L X1 FMAX\n", "heidenhain");
        }).starts_with("p.ngc:1:1: error: a move before the unit"));
}

TEST_CASE("klartext: unchanged text is reproduced byte for byte") {
  const std::string text =
      "0 BEGIN PGM 2.5D COVER MM\r\n1 CYCL DEF 247 PRESET ~\r\n    Q339=1 ;NUMBER\r\n\r\n2 * - FACE\r\n"
      "3 TOOL CALL 1 Z S1500\r\n4  L  X+5,25   Y-7 R0 FMAX ; start\r\n5 L Z2 FMAX\r\n6 CC X+10 Y-7\r\n"
      "7 C X+14,75 DR-\r\n8 CR X+5,25 R-4,8 DR+ F200\r\n9 CALL LBL 7\r\n10 L Z+50 FMAX M91\r\n11 FN18: "
      "SYSREAD Q2 = ID270\r\n"
      "12 M30\r\n13 END PGM 2.5D COVER MM\r\nmore";
  const Program program = read(text);
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (MoveEdit& edit : edits)
    if (const auto& arc = program.moves[edit.move].arc) edit.centre_mm = arc->centre_mm;
  CHECK(rewrite(program, edits, {}).text == text);
  CHECK(rewrite(program, {}, {}).text == text);
}

TEST_CASE("klartext: words keep their comma, their sign style and their decimals") {
  CHECK(klartext_shifted(read(klartext({"L X+10 Y-2,5 Z+50,1234 R0 FMAX M3"}))) ==
        klartext({"L X+10,5 Y-2,75 Z+50,2484 R0 FMAX M3"}));
  CHECK(klartext_shifted(read(klartext({"L X10 Y2.5 Z3. FMAX", "L X0.5"}))) ==
        klartext({"L X10.5 Y2.25 Z3.125 FMAX", "L X1.0"}));
}

TEST_CASE("klartext: a missing word is inserted behind the last coordinate if it is needed") {
  const Program program = read(klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L X+20 F200 M8"}));
  const auto out =
      rewrite(program, {{.move = 0, .end_mm = {10, 10, 5}}, {.move = 1, .end_mm = {20, 10.01, 5}}}, {});
  CHECK(out.text == klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L X+20 Y+10.010 F200 M8"}));
  CHECK(out.inserted_words == 1);
}

TEST_CASE("klartext: incremental words are differences of positions in the text") {
  const Program program = read(klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L IX+5 F200", "L IX+5"}));
  const auto out = rewrite(
      program, {{.move = 1, .end_mm = {15.0014, 10, 5}}, {.move = 2, .end_mm = {20.0028, 10.25, 5}}}, {});
  CHECK(out.text == klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L IX+5.001 F200", "L IX+5.002 IY+0.250"}));
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

TEST_CASE("klartext: blocks are renumbered without gaps only if lines are inserted") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 R0 FMAX", "L X+20 F200", "L Y+20"}));
  const std::vector<MoveEdit> edits{{.move = 1, .inserted = {{{10, 0.1, 0}}}, .end_mm = {20, 0, 0}}};
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 R0 FMAX", "L X+10.000 Y+0.100 F200", "L X+20 Y+0.000 F200", "L Y+20"}));
  const Program plain = read("BEGIN PGM A MM\nL X0 Y0 Z0 FMAX\nL X20 F200\nEND PGM A MM\n");
  CHECK(rewrite(plain, {{.move = 1, .inserted = {{{10, 0.1, 0}}}, .end_mm = {20, 0, 0}}}, {}).text ==
        "BEGIN PGM A MM\nL X0 Y0 Z0 FMAX\nL X10.000 Y0.100 F200\nL X20 Y0.000 F200\nEND PGM A MM\n");
}

TEST_CASE(
    "klartext: the header is written behind BEGIN PGM as comments without numbers, and is found there") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 R0 FMAX"}));
  const std::string text = rewrite(program, {}, {.header = {"Counterflex 1 made", "~ two"}}).text;
  CHECK(text ==
        "0 BEGIN PGM COVER MM\n; COUNTERFLEX 1 MADE\n;   TWO\n1 L X+0 Y+0 Z+0 R0 FMAX\n2 END PGM COVER MM\n");
  CHECK(is_corrected(read(text)));
  CHECK_FALSE(is_corrected(program));
}

TEST_CASE(
    "klartext: a block that starts a spindle is the first of its pieces, one that stops it is not split") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "L X+20 F200 M3", "L X+40 M5"}));
  CHECK(rewrite(program, {{.move = 1, .inserted = {{{10, 0, 0}}}, .end_mm = {20, 0, 0}}}, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "L X+10. F200 M3", "L X+20.000", "L X+40 M5"}));
  CHECK(program.moves[1].may_split);
  CHECK_FALSE(program.moves[2].may_split);
}

TEST_CASE("klartext: an arc about CC moves with its centre") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "C X+0 Y+0 DR-"}));
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.moves[1].arc);
  CHECK(program.moves[1].arc->clockwise);
  CHECK(program.moves[1].arc->centre_mm == Vector3(10, 0, 0));
  CHECK(klartext_shifted(program) == klartext({"L X+0.5 Y-0.25 Z+0.125 FMAX", "CC X+10.5 Y-0.25",
                                               "C X+20.5 Y-0.25 DR- F300", "C X+0.5 Y-0.25 DR-"}));
}

TEST_CASE("klartext: an arc that shares its centre gets a CC of its own if the centre must differ") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "C X+0 Y+0 DR-"}));
  const std::vector<MoveEdit> edits{{.move = 1, .end_mm = {20, 0, 0}, .centre_mm = Vector3(10, 0.5, 0)}};
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0.5", "C X+20 Y+0 DR- F300", "CC X+10.000 Y+0.000",
                  "C X+0 Y+0 DR-"}));
}

TEST_CASE("klartext: arcs are split into arcs or lines") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300"}));
  MoveEdit edit{.move = 1,
                .inserted = {{{10, 10, 0}, Vector3(10, 0, 0)}},
                .end_mm = {20, 0, 0},
                .centre_mm = Vector3(10, 0, 0)};
  CHECK(
      rewrite(program, {edit}, {}).text ==
      klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+10.000 Y+10.000 DR- F300", "C X+20 Y+0 DR- F300"}));
  edit.inserted[0].centre_mm.reset();
  edit.centre_mm.reset();
  CHECK(rewrite(program, {edit}, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "L X+10.000 Y+10.000 F300", "L X+20 Y+0 F300"}));
}

TEST_CASE("klartext: CR arcs turn about the centre given by their radius and sign") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "CR X+10 Y+10 R+10 DR- F100", "CR X+20 Y+0 R-10 DR+"}));
  REQUIRE(program.moves[1].arc);
  CHECK((program.moves[1].arc->centre_mm - Vector3(10, 0, 0)).norm() < 1e-12);
  REQUIRE(program.moves[2].arc);
  CHECK((program.moves[2].arc->centre_mm - Vector3(10, 0, 0)).norm() < 1e-12);
  CHECK(klartext_shifted(program) ==
        klartext(
            {"L X+0.5 Y-0.25 Z+0.125 FMAX", "CR X+10.5 Y+9.75 R+10 DR- F100", "CR X+20.5 Y-0.25 R-10 DR+"}));
}

TEST_CASE("klartext: a contour under RL is one group from the move above its plunge to its retraction") {
  const Program program = read(klartext({"L X+50 Y-7 R0 FMAX", "L Z+2 FMAX", "L Z-10 F200", "L Y+2 RL",
                                         "L X+7", "L Y-7 R0", "L Z+2 FMAX", "L X+51 Y+62 FMAX"}));
  std::vector<int> groups;
  for (const Move& move : program.moves) groups.push_back(move.group);
  CHECK(groups == std::vector<int>{1, 1, 1, 1, 1, 1, 1, 0});
  CHECK(program.moves[3].handling == Handling::group);
  CHECK(program.moves[7].handling == Handling::own);
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

TEST_CASE("klartext: a cycle called in place keeps the position of its hole and makes the height unknown") {
  const Program program =
      read(klartext({"CYCL DEF 200 DRILLING ~\n    Q200=2 ;CLEARANCE ~\n    Q201=-20 ;DEPTH",
                     "L X+10 Y+10 Z+50 R0 FMAX", "L X+20 FMAX M99", "CYCL CALL", "L X+30 FMAX"}));
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].words[0]);
  CHECK(program.moves[1].fixed == std::array{false, false, true});
  CHECK(program.moves[2].fixed == std::array{false, false, true});
  CHECK(program.moves[3].known_start == std::array{true, true, false});
}

TEST_CASE("klartext: forces are read from comments") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "; FORCE FX=-30 FZ=12", "L X+5 F100"}));
  REQUIRE(program.moves[1].force);
  CHECK((*program.moves[1].force)[0] == -30);
}

TEST_CASE("klartext: moves beside corners by RND and CHF are not split") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "RND R2", "L Y+10", "L X+0"}));
  CHECK_FALSE(program.moves[1].may_split);
  CHECK_FALSE(program.moves[2].may_split);
  CHECK(program.moves[3].may_split);
  // Both are in the plane of the corner. Behind the part removed by the corner their heights may change.
  for (const std::size_t m : {1u, 2u}) CHECK(changes_height_inside(program.moves[m]));
  CHECK(program.moves[1].corners->end_mm == doctest::Approx(2));
  CHECK(program.moves[2].corners->begin_mm == doctest::Approx(2));
  CHECK(program.moves[1].takes_no_z);
  CHECK_FALSE(program.moves[2].takes_no_z);
  const Program wide = read(klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "RND R9.5", "L Y+10", "L X+0"}));
  for (const std::size_t m : {1u, 2u}) CHECK_FALSE(changes_height_inside(wide.moves[m]));
  std::vector<MoveEdit> edits = edits_to_original(wide);
  for (MoveEdit& edit : edits) edit.end_mm.z() = 0.01 * static_cast<double>(edit.move);
  CHECK(rewrite(wide, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "RND R9.5", "L Y+10", "L X+0 Z+0.030"}));
}

TEST_CASE("klartext: CT is the arc tangent to the move before it, and becomes C if its words change") {
  const std::string text =
      klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "CT X+20 Y+10", "CT X+10 Y+20", "CT Y+30", "L X+0"});
  const Program program = read(text);
  const Move &quarter = program.moves[2], &next = program.moves[3], &half = program.moves[4];
  REQUIRE(quarter.arc.has_value());
  CHECK((quarter.arc->centre_mm - Vector3(10, 10, 0)).norm() < 1e-12);
  CHECK_FALSE(quarter.arc->clockwise);
  REQUIRE(next.arc.has_value());
  CHECK((next.arc->centre_mm - Vector3(10, 10, 0)).norm() < 1e-12);
  REQUIRE(half.arc.has_value());
  CHECK((half.arc->centre_mm - Vector3(10, 25, 0)).norm() < 1e-12);
  CHECK(half.arc->clockwise);
  std::vector<MoveEdit> edits = edits_to_original(program);
  CHECK(rewrite(program, edits, {}).text == text);
  for (MoveEdit& edit : edits) {
    edit.end_mm.x() += 0.5;
    if (edit.centre_mm) edit.centre_mm->x() += 0.5;
  }
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0.5 Y+0 Z+0 F100", "L X+10.5", "CC X+10.500 Y+10.000", "C X+20.5 Y+10 DR+",
                  "C X+10.5 Y+20 DR+", "CC X+10.500 Y+25.000", "C Y+30 DR-", "L X+0.5"}));
}

TEST_CASE("klartext: CT is held with a height, after an unknown move, straight ahead or to its own start") {
  for (const char* block : {"CT X+20 Y+10 Z+5", "CT X+20", "CT X+10 Y+0"}) {
    CAPTURE(block);
    const Program program = read(klartext({"L X+0 Y+0 Z+0 F100", "L X+10", block, "L X+0"}));
    CHECK(program.moves[2].handling == Handling::held);
    CHECK_FALSE(program.moves[2].arc.has_value());
  }
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "CT X+20 Y+10 F100", "L X+0"}));
  CHECK(program.moves[1].handling == Handling::held);
}

TEST_CASE("klartext: an arc whose ends are not equally far from its CC is refused with both radii") {
  const auto reads = [](const char* end) {
    read(klartext({"L X+10 Y+0 Z+0 FMAX", "CC X+0 Y+0", fmt::format("C X{} Y+0 DR+ F100", end)}));
  };
  CHECK_NOTHROW(reads("-10.016"));
  const std::string what = diagnostic_of([&] { reads("-10.017"); });
  CHECK(what.find("10.0000 mm at the arc's start and 10.0170 mm at its end") != std::string::npos);
}

TEST_CASE(
    "klartext: a CC with one incremental word is kept, and written again if the tool's position changes") {
  const std::string text =
      klartext({"L X+10 Y-2.5 Z+0 FMAX", "CC X+0 IY+0", "C X-10 Y-2.5 DR+ F100", "L X+0"});
  const Program program = read(text);
  REQUIRE(program.moves[1].arc.has_value());
  CHECK((program.moves[1].arc->centre_mm - Vector3(0, -2.5, 0)).norm() < 1e-12);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program).find("CC X+0 IY+0\n3 CC X+0.500 Y-2.750\n") != std::string::npos);
}

TEST_CASE("klartext: a helix of turns is followed, and keeps its polar words when it is shifted") {
  const std::string text = klartext({"TOOL CALL 3 Z S2500", "L X+10 Y+0 Z+5 FMAX", "L Z+0 F100",
                                     "CC X+4,5 Y+0", "CP IPA+720 IZ-2 DR+", "L X+12 Y+1 Z-2"});
  const Program program = read(text);
  REQUIRE(program.moves.size() == 4);
  REQUIRE(program.moves[2].arc);
  CHECK(program.moves[2].arc->turns == 1);
  CHECK(program.moves[2].end_mm == Vector3(10, 0, -2));
  CHECK(all_known(program.moves[2].known_end));
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"TOOL CALL 3 Z S2500", "L X+10,5 Y-0,25 Z+5,125 FMAX", "L Z+0,125 F100", "CC X+5,0 Y-0,25",
                  "CP IPA+720 IZ-2 DR+", "L X+12,5 Y+0,75 Z-1,875"}));
}

TEST_CASE("klartext: a helix becomes lines if polar words cannot hold its correction") {
  const Program program =
      read(klartext({"L X+10 Y+0 Z+0 F100", "CC X+4 Y+0", "CP IPA+360 IZ-2 DR+ F200 M8", "L X+12"}));
  const MoveEdit edit{.move = 1, .inserted = {{{-2, 0.1, -1}}}, .end_mm = {10, 0.1, -2.1}};
  CHECK(rewrite(program, {edit}, {}).text ==
        klartext({"L X+10 Y+0 Z+0 F100", "CC X+4 Y+0", "L X-2.000 Y+0.100 IZ-1. F200 M8",
                  "L X+10.000 IZ-1.100", "L X+12"}));
}

TEST_CASE("klartext: polar arcs end about their pole, in every plane") {
  const Program program = read(klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0", "CP IPA+90 DR+",
                                         "CP PA+180 DR+", "CP IPA-270 DR-", "CP IPA+360 DR+", "L Y-20 Z-5",
                                         "CC Y-10 Z-5", "CP IPA-90 DR-", "CC IY+5 IZ+0", "CP IPA+180 DR+"}));
  const auto ends_at = [&](std::size_t move, const Vector3& end) {
    CAPTURE(move);
    CHECK((program.moves.at(move).end_mm - end).norm() < 1e-12);
    CHECK(program.moves.at(move).arc.has_value());
  };
  ends_at(1, {0, 10, 0});
  ends_at(2, {-10, 0, 0});
  ends_at(3, {0, -10, 0});
  ends_at(4, {0, -10, 0});
  ends_at(6, {0, -10, 5});
  CHECK(program.moves[6].arc->normal == 0);
  ends_at(7, {0, 0, 5});
  CHECK_FALSE(program.moves[7].arc->absolute_centre);
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+10.5 Y-0.25 Z+0.125 F100", "CC X+0.5 Y-0.25", "CP IPA+90 DR+", "CP PA+180 DR+",
                  "CP IPA-270 DR-", "CP IPA+360 DR+", "L Y-20.25 Z-4.875", "CC Y-10.25 Z-4.875",
                  "CP IPA-90 DR-", "CC IY+5 IZ+0", "CP IPA+180 DR+"}));
}

TEST_CASE("klartext: a polar arc in the plane becomes C if its polar words cannot hold the correction") {
  const Program program =
      read(klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0", "CP  IPA+90 DR+ F50", "L X-1"}));
  const MoveEdit edit{.move = 1, .end_mm = {0, 10.02, 0}, .centre_mm = Vector3(0, 0.01, 0)};
  CHECK(rewrite(program, {edit}, {}).text ==
        klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0.01", "C X+0.000 Y+10.020 DR+ F50", "L X-1"}));
}

TEST_CASE("klartext: lines in polar coordinates are followed and become lines in X and Y") {
  const Program program =
      read(klartext({"CC X+50 Y+50", "LP PR+30 PA+0 FMAX", "L Z-2 F100", "LP PA+60", "LP IPA+30", "LP IPR-10",
                     "LP PA+180 IZ+1", "CC X+50 Y+51", "C X+30 Y+52 DR+"}));
  REQUIRE(program.moves.size() == 7);
  const auto ends_at = [&](std::size_t move, const Vector3& end) {
    CAPTURE(move);
    CHECK((program.moves.at(move).end_mm - end).norm() < 1e-12);
  };
  ends_at(1, {80, 50, -2});
  ends_at(2, {65, 50 + 15 * std::sqrt(3.0), -2});
  ends_at(3, {50, 80, -2});
  ends_at(4, {50, 70, -2});
  ends_at(5, {30, 50, -1});
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) ==
        klartext({"CC X+50 Y+50", "L X+80.500 Y+49.750 FMAX", "L Z-1.875 F100", "L X+65.500 Y+75.731",
                  "L X+50.500 Y+79.750", "L X+50.500 Y+69.750", "L X+30.500 Y+49.750 IZ+1",
                  "CC X+50.5 Y+50.75", "C X+30.5 Y+51.75 DR+"}));
}

TEST_CASE("klartext: a line in polar coordinates is rewritten if an arc has moved its pole") {
  const std::string text = klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0", "CP IPA+90 DR+", "LP PR+20 PA+90"});
  const Program program = read(text);
  const MoveEdit edit{.move = 1, .end_mm = {0, 10, 0}, .centre_mm = Vector3(0.01, 0.01, 0)};
  CHECK(rewrite(program, {edit}, {}).text == klartext({"L X+10 Y+0 Z+0 F100", "CC X+0.01 Y+0.01",
                                                       "C X+0.000 Y+10.000 DR+", "L X+0.000 Y+20.000"}));
}

TEST_CASE("klartext: unknown polar coordinates are fixed, with the reason and the cure") {
  for (const auto& [block, why] :
       {std::pair{"LP PR+10 PA+Q5", "LP has no angle"},
        {"LP IPA+10", "LP is relative to the polar coordinates of the block before it"},
        {"CP IPA+90 DR-", "IPA and DR of CP have different signs"},
        {"CP IPA+90", "CP has no DR+ or DR-"},
        {"LP PR+10 PA+20 X+5", "LP with both polar and Cartesian"},
        {"CTP PR+10 PA+20", "CTP is not supported"}}) {
    const std::string shown = block;
    CAPTURE(shown);
    const Program program = read(klartext({"L X+10 Y+0 Z+5 FMAX", "CC X+4 Y+0", shown}));
    CHECK(program.moves.at(1).fixed == std::array<bool, 3>{true, true, true});
    CHECK(program.left_alone.at(0).why.starts_with(why));
  }
  const Program no_pole = read(klartext({"L X+10 Y+0 Z+5 FMAX", "CC X+Q4 Y+0", "CP IPA+90 DR+"}));
  CHECK(no_pole.left_alone.at(0).why.starts_with("CP needs a known pole"));
}

TEST_CASE("klartext: a contour is shifted with its polar arcs") {
  const Program program = read(
      klartext({"L X+10 Y+0 Z+5 FMAX", "L X+9 RL F100", "CC X+4 Y+0", "CP IPA+90 DR+", "L X+3", "L Y-7 R0"}));
  CHECK(program.moves[2].handling == Handling::group);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+10.5 Y-0.25 Z+5.125 FMAX", "L X+9.5 RL F100", "CC X+4.5 Y-0.25", "CP IPA+90 DR+",
                  "L X+3.5", "L Y-7.25 R0"}));
}

TEST_CASE("klartext: an arc moves its CC also if other moves are between them") {
  const Program program =
      read(klartext({"L X+4 Y+0 Z+5 FMAX", "CC X+0 Y+0", "L X+5 F100", "C X-5 Y+0 DR+", "C X+5 Y+0 DR+"}));
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) == klartext({"L X+4.5 Y-0.25 Z+5.125 FMAX", "CC X+0.5 Y-0.25",
                                               "L X+5.5 F100", "C X-4.5 Y-0.25 DR+", "C X+5.5 Y-0.25 DR+"}));
}

TEST_CASE("klartext: after an arc that is not changed no other arc about the same CC is followed") {
  for (const char* arc : {"C X+5", "/C X-5 Y+0 DR+", "C X+Q1 Y+0 DR+"}) {
    const std::string text =
        klartext({"L X+5 Y+0 Z+5 FMAX", "CC X+0 Y+0", arc, "L X+5 Y+0 F100", "C X-5 Y+0 DR+"});
    CAPTURE(text);
    const Program program = read(text);
    CHECK(program.moves.back().fixed[0]);
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  }
}

TEST_CASE(
    "klartext: each hole of a drilling cycle is corrected in X and Y, and the first one moves the surface") {
  const std::string text =
      klartext({"L X+1 Y+0 Z+50 FMAX",
                "CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203=+1.5 ;SURFACE ~\n  Q204=50",
                "L X+2 Y+3 FMAX M99", "L X+4 Y+3 FMAX M99", "CYCL CALL", "L X+0 Y+0 Z+50 FMAX"});
  const Program program = read(text);
  REQUIRE(program.moves.size() == 5);
  for (const std::size_t hole : {1U, 2U, 3U}) {
    const Move& move = program.moves[hole];
    CHECK(move.handling == Handling::own);
    CHECK(move.makes_hole);
    CHECK(move.words[2].has_value());
    CHECK(move.repeats_surface == (hole > 1));
    CHECK(move.motion == Motion::rapid);
    CHECK_FALSE(may_insert_word(move, 2));
    CHECK(all_known(move.known_end));
    CHECK(move.end_mm.z() == 1.5);
  }
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+1.5 Y-0.25 Z+50.125 FMAX",
                  "CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203=+1.625 ;SURFACE ~\n  Q204=50",
                  "L X+2.5 Y+2.75 FMAX M99", "L X+4.5 Y+2.75 FMAX M99", "CYCL CALL",
                  "L X+0.5 Y-0.25 Z+50.125 FMAX"}));
}

TEST_CASE("klartext: a hole at another height repeats the statement that has its cycle's surface") {
  const std::string begin = "L X+1 Y+0 Z+50 FMAX",
                    definition = "CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q203=";
  const std::string rest = " ;SURFACE ~\n  Q204=50";
  const auto with_heights = [](const Program& program, const std::vector<double>& z) {
    std::vector<MoveEdit> edits = edits_to_original(program);
    for (std::size_t k = 0; k < z.size(); ++k) edits.at(k + 1).end_mm.z() += z[k];
    return rewrite(program, edits, {}).text;
  };
  const std::vector<std::string> holes{"L X+2 Y+3 FMAX M99", "L X+4 FMAX M99", "L X+6 FMAX M99", "CYCL CALL"};
  const Program defined =
      read(klartext({begin, definition + "+1.5" + rest, holes[0], holes[1], holes[2], holes[3]}));
  CHECK(with_heights(defined, {0, 0.02, 0.02, 0}) ==
        klartext({begin, definition + "+1.5" + rest, holes[0], definition + "+1.52" + rest, holes[1],
                  holes[2], definition + "+1.5" + rest, holes[3]}));
  const std::string line = "Q203 = +1.5", definitions = "CYCL DEF 200 DRILLING",
                    clearances = "Q200=2\nQ204=50";
  const Program assigned = read("0 BEGIN PGM COVER MM\n" + begin + "\n" + definitions + "\n" + line +
                                " ;SURFACE\n" + clearances + "\n" + holes[0] + "\n" + holes[1] + "\n");
  CHECK(with_heights(assigned, {0.01, 0.03}).find(holes[0] + "\nQ203 = +1.53 ;SURFACE\n") !=
        std::string::npos);
}

TEST_CASE("klartext: under M89 a definition is not repeated, because it would end M89") {
  const Program program =
      read(klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 ~\n  Q200=2 ~\n  Q203=+1.5 ~\n  Q204=50",
                     "L X+2 Y+3 FMAX M89", "L X+4 FMAX", "L X+6 FMAX M99",
                     "CYCL DEF 200 ~\n  Q200=2 ~\n  Q203=+1.5 ~\n  Q204=50", "L X+8 FMAX"}));
  CHECK_FALSE(program.moves[2].words[2].has_value());
  CHECK(program.moves[2].makes_hole);
  CHECK(program.moves[3].makes_hole);
  CHECK_FALSE(program.moves[4].makes_hole);
}

TEST_CASE("klartext: a definition is not repeated if the program may have changed its parameters since") {
  const std::string definition = "CYCL DEF 200 ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203=+1.5 ~\n  Q204=50";
  for (const char* between : {"Q201 = -20", "FN 0: Q201 = -20", "LBL 1", "STOP"}) {
    CAPTURE(between);
    const Program program =
        read(klartext({"L X+1 Y+0 Z+50 FMAX", definition, "L X+2 Y+3 FMAX M99", between, "L X+4 FMAX M99"}));
    for (std::size_t hole = 2; hole < program.moves.size(); ++hole)
      CHECK_FALSE(program.moves[hole].words[2].has_value());
  }
}

TEST_CASE("klartext: holes are held if the height at which a cycle leaves the tool is unknown") {
  for (const char* clearances : {"Q200=2", "Q204=50", "Q200=2 ~\n  Q204=Q9"}) {
    CAPTURE(clearances);
    const Program program =
        read(klartext({"L X+1 Y+0 Z+50 FMAX", fmt::format("CYCL DEF 200 ~\n  Q203=+1.5 ~\n  {}", clearances),
                       "L X+2 Y+3 FMAX M99", "L X+4 FMAX M99"}));
    REQUIRE(program.moves.size() == 3);
    for (const std::size_t hole : {1U, 2U}) {
      CHECK(program.moves[hole].handling == Handling::held);
      CHECK_FALSE(program.moves[hole].known_end[2]);
    }
  }
}

TEST_CASE("klartext: the first call of a cycle may be a block without coordinates") {
  for (const char* call : {"CYCL CALL", "CYCL CALL M8", "M99", "M99 M8"}) {
    CAPTURE(call);
    const std::string begin = "L X+1 Y+0 Z+50 FMAX", cycle = "CYCL DEF 203 DRILLING ~\n  Q201=-10 ~\n  Q203=";
    const std::string text = klartext({begin, cycle + "+1.5", call, "L X+4 Y+3 FMAX M99"});
    const Program program = read(text);
    REQUIRE(program.moves.size() == 3);
    CHECK(program.moves[1].words[2]);
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
    CHECK(klartext_shifted(program) ==
          klartext({"L X+1.5 Y-0.25 Z+50.125 FMAX", cycle + "+1.625", call, "L X+4.5 Y+2.75 FMAX M99"}));
  }
}

TEST_CASE("klartext: holes are fixed if their surface is not a plain number used by them alone") {
  for (const char* surface :
       {"CYCL DEF 200 Q203=+Q5", "CYCL DEF 200 Q201=-5", "/CYCL DEF 200 Q203=+1", "CYCL DEF 252 Q203=+1"}) {
    CAPTURE(surface);
    const Program program = read(klartext({"L X+1 Y+0 Z+50 FMAX", surface, "L X+2 Y+3 FMAX M99"}));
    CHECK(program.moves[1].fixed[2]);
  }
  for (const char* call : {"/L X+2 Y+3 FMAX M99", "L X+2 Z+5 FMAX M99", "Q203 = Q5", "FN 0: Q203 = 5"}) {
    CAPTURE(call);
    const Program program =
        read(klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 Q203=+1", call, "L X+2 Y+3 FMAX M99"}));
    CHECK(program.moves.back().fixed[2]);
  }
}

TEST_CASE("klartext: arcs get no Z word, the lines around them do") {
  const Program program = read(
      klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "CR X+0 Y+0 R+10 DR-", "L X-5"}));
  const std::vector<MoveEdit> edits{{.move = 0, .end_mm = {0, 0, 0}},
                                    {.move = 1, .end_mm = {20, 0, 0.01}, .centre_mm = Vector3(10, 0, 0)},
                                    {.move = 2, .end_mm = {0, 0, 0.01}, .centre_mm = Vector3(10, 0, 0)},
                                    {.move = 3, .end_mm = {-5, 0, 0.01}}};
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "CR X+0 Y+0 R+10 DR-",
                  "L X-5 Z+0.010"}));
  const MoveEdit chords{.move = 1, .inserted = {{{10, 10, 0.005}}}, .end_mm = {20, 0, 0.01}};
  CHECK(rewrite(program, {chords}, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "L X+10.000 Y+10.000 Z+0.005 F300",
                  "L X+20 Y+0 Z+0.010 F300", "CR X+0 Y+0 R+10 DR-", "L X-5"}));
}

TEST_CASE("klartext: incremental holes and a surface in a line of its own are held") {
  const std::string text =
      klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 DRILLING", "Q201 = -15 ;DEPTH", "Q203 = +1.5   ;SURFACE",
                "L IX+2 FMAX M99", "L IY+5 M99", "L X+0 Y+0 Z+50 FMAX"});
  const Program program = read(text);
  CHECK(program.moves[1].handling == Handling::held);
  CHECK(program.moves[2].handling == Handling::held);
  CHECK(program.moves[2].known_end == std::array<bool, 3>{true, true, false});
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+1.5 Y-0.25 Z+50.125 FMAX", "CYCL DEF 200 DRILLING", "Q201 = -15 ;DEPTH",
                  "Q203 = +1.625   ;SURFACE", "L IX+2 FMAX M99", "L IY+5 M99",
                  "L X+0.5 Y-0.25 Z+50.125 FMAX"}));
}

TEST_CASE("klartext: holes of cycles that are relative to the tool are shifted with their positions") {
  const Program program = read(
      klartext({"L X+1 Y+0 Z+2 FMAX", "CYCL DEF 1.0 PECKING", "CYCL DEF 1.1 DIST 2", "CYCL DEF 1.2 DEPTH -10",
                "L FMAX M99", "L X+5 FMAX M99", "CYCL CALL", "L IX+5 M89", "L Y+7", "L X+0 M99", "L Y+9"}));
  REQUIRE(program.moves.size() == 6);
  for (const Move& move : program.moves) {
    CHECK(move.handling == Handling::own);
    CHECK(move.fixed == std::array<bool, 3>{});
  }
  CHECK(all_known(program.moves.back().known_end));
  const Program pocket =
      read(klartext({"L X+1 Y+0 Z+2 FMAX", "CYCL DEF 4.0 POCKET", "L X+5 FMAX M99", "L Y+9"}));
  CHECK(all_known(pocket.moves[1].known_start));
  CHECK(pocket.moves[1].mills_at_end);
  REQUIRE(pocket.left_alone.size() == 1);
  CHECK(pocket.left_alone[0].why.starts_with("the cycle is shifted as a whole"));
  CHECK(pocket.moves[2].known_start == std::array<bool, 3>{});
}

TEST_CASE("klartext: M89 calls the cycle at the end of all moves up to M99") {
  const Program program = read(klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 DRILLING Q203=+0",
                                         "L X+2 FMAX M89", "L X+3", "L X+4 M99", "L X+5"}));
  std::vector<bool> held;
  for (const Move& move : program.moves) held.push_back(move.handling == Handling::held);
  CHECK(held == std::vector<bool>{false, true, true, true, false});
}

TEST_CASE("klartext: APPR and DEP are shifted with the contour between them") {
  const std::string text =
      klartext({"L X+120 Y+0 Z+1 R0 FMAX", "L Z-10 F100", "APPR LCT X+45 Y+0 R20 RL F220", "L X+45 Y-18",
                "RND R4", "L X+18 Y-45", "DEP LCT X+120 Y+0 R20", "L Z+1 R0 FMAX", "L X+150 FMAX"});
  const Program program = read(text);
  REQUIRE(program.moves.size() == 8);
  std::vector<int> groups;
  for (const Move& move : program.moves) groups.push_back(move.group);
  CHECK(groups == std::vector<int>{1, 1, 1, 1, 1, 1, 1, 0});
  CHECK(program.moves[2].end_mm == Vector3(45, 0, -10));
  CHECK(program.moves[2].feed_mm_min == 220);
  CHECK_FALSE(all_known(program.moves[2].known_start));
  CHECK(all_known(program.moves[3].known_start));
  CHECK(program.moves[6].start_mm == Vector3(120, 0, -10));
  CHECK(program.left_alone.at(0).why == "APPR is shifted with its contour; its path is not computed");
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+120.5 Y-0.25 Z+1.125 R0 FMAX", "L Z-9.875 F100", "APPR LCT X+45.5 Y-0.25 R20 RL F220",
                  "L X+45.5 Y-18.25", "RND R4", "L X+18.5 Y-45.25", "DEP LCT X+120.5 Y-0.25 R20",
                  "L Z+1.125 R0 FMAX", "L X+150.5 FMAX"}));
}

TEST_CASE("klartext: the end of a DEP without a point is unknown, the contour before it is known") {
  const Program program = read(klartext({"L X+20 Y+0 Z+1 FMAX", "APPR LT X+45 Y+0 Z-5 LEN10 RL F220",
                                         "L X+60", "DEP LT LEN10", "L Z+1 FMAX", "L X+0 Y+0 FMAX"}));
  REQUIRE(program.moves.size() == 6);
  CHECK(program.moves[1].end_mm.z() == -5);
  CHECK(program.moves[3].known_end == std::array<bool, 3>{false, false, true});
  CHECK(program.moves[3].fixed == std::array<bool, 3>{});
  CHECK(all_known(program.moves[5].known_end));
}

TEST_CASE("klartext: the reason for APPR and DEP that are not followed names the block") {
  for (const char* block :
       {"APPR LT X+Q1 Y+2 LEN10 RR", "APPR PLT PR+5 PA+3 LEN10 RL", "APPR LT IX+1 Y+2 LEN10 RR",
        "APPR LT X+1 Y+2 LEN10", "DEP LT LEN10", "APPR LN X+1 Y+2 LEN+2 RL M3"}) {
    CAPTURE(block);
    const Program program = read(klartext({"L X+20 Y+0 Z+1 FMAX", block, "L X+60 Y+0"}));
    CHECK(program.moves[1].fixed[0]);
    CHECK(program.left_alone.at(0).why.find("needs X and Y as plain numbers") != std::string::npos);
  }
}

TEST_CASE("klartext: repeated parts and subprograms replace their calls") {
  const Program program = expanded_klartext(
      klartext({"L X+0 Y+0 Z+5 FMAX", "LBL 5", "L IX+10 F100", "CALL LBL \"HOLE\"", "L IY+1",
                "CALL LBL 5 REP 2/2", "L Z+9", "M30", "LBL \"HOLE\"", "L IZ-1 ~\nF50 ; down", "LBL 0"}));
  CHECK(program.text ==
        klartext({"L X+0 Y+0 Z+5 FMAX", "LBL 5", "L IX+10 F100", "L IZ-1 ~\nF50 ; down", "L IY+1",
                  "L IX+10 F100", "L IZ-1 ~\nF50 ; down", "L IY+1", "L IX+10 F100", "L IZ-1 ~\nF50 ; down",
                  "L IY+1", "L Z+9", "M30", "LBL \"HOLE\"", "L IZ-1 ~\nF50 ; down", "LBL 0"}));
  CHECK(program.left_alone.empty());
  CHECK(program.expansion.calls == 5);
  std::vector<int> lines;
  for (const Move& move : program.moves) lines.push_back(move.line);
  CHECK(lines == std::vector<int>{2, 4, 11, 6, 4, 11, 6, 4, 11, 6, 8});
  CHECK(program.moves.back().end_mm == Vector3(30, 3, 9));
}

TEST_CASE("klartext: calls that cannot be replaced stay, with the reason") {
  for (const auto& [call, why] :
       {std::pair{"CALL LBL 7", "line 3: LBL 7 is missing"},
        {"CALL LBL 1", "line 6: LBL 1 calls itself"},
        {"CALL LBL Q1", "line 3: the label is a Q parameter"},
        {"/CALL LBL 2", "line 3: '/' may skip the call"},
        {"CALL LBL 2 REP 3", "line 3: LBL 2 is not before its REP"},
        {"CALL LBL 3", "line 12: a subprogram ends the program"},
        {"CALL LBL 2\nFN 9: IF +Q1 EQU +1 GOTO LBL 2", "line 4: the program jumps to a label"}}) {
    const std::string shown = call;
    CAPTURE(shown);
    const Program program = expanded_klartext(
        "BEGIN PGM A MM\nL X+0 Y+0 Z+5 FMAX\n" + shown +
        "\nM30\nLBL 1\nCALL LBL 1\nLBL 0\nLBL 2\nL IX+1\nLBL 0\nLBL 3\nL IX+1 M2\nLBL 0\nEND PGM A MM\n");
    CHECK(program.expansion.calls == 0);
    CHECK(program.moves.at(1).fixed[0]);
    const std::string reason =
        std::string(
            "a subprogram or a part of the program is called and cannot be put in the place of its call: ") +
        why;
    CHECK(std::any_of(program.left_alone.begin(), program.left_alone.end(),
                      [&](const LeftAlone& left) { return left.why == reason; }));
  }
  CHECK(diagnostic_of([&] {
          expanded_klartext(klartext({"LBL 1", "L IX+1", "CALL LBL 1 REP 900000000"}));
        }).find("the expanded calls are longer than") != std::string::npos);
}

TEST_CASE("Q parameters set to constants are evaluated with --evaluate") {
  const std::string begin =
      "BEGIN PGM A MM\nL X+0 Y+0 Z+5 FMAX\nFN 0: Q1 = +12,5\nQ2 = Q1 * 2 - 5\nFN 4: Q3 = +Q2 DIV +8\n";
  ReadOptions options{.dialect = "heidenhain", .evaluate = true};
  const auto last = [&](const std::string& statements) {
    return read_program(begin + statements + "END PGM A MM\n", "p.h", options).moves.back();
  };
  const Move line = last("L X+Q1 IY-Q3 F200\n");
  CHECK(all_known(line.known_end));
  CHECK((line.end_mm - Vector3(12.5, -2.5, 5)).norm() < 1e-12);
  CHECK(last("CC X+Q1 Y+0\nL X+0 Y+0\nC X+25 Y+0 DR-\n").arc);
  for (const char* doubt :
       {"FN 18: SYSREAD Q1 = ID270 NR1 IDX3\n", "/ Q1 = 5\n", "CALL PGM OTHER\nL X+0 Y+0 Z+5\n",
        "Q1 = SIN Q9\n", "FN #0: Q1 = +5\n", "LBL 1\nQ1 = Q1 + 1\nCALL LBL 1 REP 3\nL X+0 Y+0 Z+5\n",
        "FN 5: Q1 = SQRT +4\n"}) {
    CAPTURE(doubt);
    CHECK_FALSE(last(std::string(doubt) + "L X+Q1 F200\n").known_end[0]);
  }
  CHECK_FALSE(last("L X+Q100 F200\n").known_end[0]);
  options.evaluate = false;
  CHECK_FALSE(last("L X+Q1 F200\n").known_end[0]);
}
