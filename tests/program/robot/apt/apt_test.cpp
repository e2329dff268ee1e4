// APT and cutter location files: reading, and writing of corrected points.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/program/program_reader.hpp"
#include "program/robot/corpus.hpp"
#include "program/robot/edits.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Program read_apt(const std::string& text, std::optional<LengthUnit> unit = {}) {
  return read_program(text, "job.cls", {.unit = unit});
}

std::string refusal_of_apt(const std::string& text) {
  return diagnostic_of([&] { read_apt(text); });
}

const std::string apt_milling =
    "PARTNO BRACKET $$ 2 off\n"
    "UNITS/MM\n"
    "$$ POCKET\n"
    "LOADTL/5\n"
    "SPINDL/2000,RPM,CLW\n"
    "FROM/0,0,100,0,0,1\n"
    "RAPID\n"
    "GOTO/10,20,30.0,0,0.6,.8 $$ above\n"
    "FEDRAT/ 250.5 , MMPM\n"
    "GOTO / 10.0, 20, -1.5\n"
    "FEDRAT/IPM,10\n"
    "goto/+6E1,20.,$ and the rest\n"
    "  -1.5,0.0000000,0.0000000,1.0000000\n"
    "FINI\n";

}  // namespace

TEST_CASE("the points of GOTO are read with tool axis, tool, feed and rapid") {
  const Program program = read_apt(apt_milling);
  CHECK(program.dialect == "apt");
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 6);
  CHECK(program.left_alone[0].machine_position);
  const Move &rapid = program.moves[0], &down = program.moves[1], &across = program.moves[2];
  CHECK(rapid.motion == Motion::rapid);
  CHECK(rapid.line == 8);
  CHECK(!rapid.known_start[0]);
  CHECK(rapid.end_mm == Vector3(10, 20, 30));
  CHECK(!rapid.may_split);
  CHECK(down.motion == Motion::feed);
  CHECK(down.start_mm == Vector3(10, 20, 30));
  CHECK(down.end_mm == Vector3(10, 20, -1.5));
  CHECK(down.feed_mm_min == 250.5);
  CHECK(down.tool == 5);
  CHECK(down.spindle_rpm == 2000);
  CHECK(down.may_split);
  CHECK(down.may_jump);
  CHECK(!down.exact_stop);
  CHECK(program.operations[down.operation] == "POCKET");
  CHECK(down.orientation->form == OrientationForm::axis);
  CHECK(!down.orientation->by_angles);
  CHECK(down.orientation->end == OrientationNumbers{0, 0.6, 0.8});
  CHECK(across.line == 12);
  CHECK(across.end_mm == Vector3(60, 20, -1.5));
  CHECK(across.feed_mm_min == doctest::Approx(254));
  CHECK(across.orientation->start == OrientationNumbers{0, 0.6, 0.8});
  CHECK(across.orientation->end == OrientationNumbers{0, 0, 1});
  CHECK((turn_of(*down.orientation).end.col(2) - Vector3(0, 0.6, 0.8)).norm() < 1e-15);
}

TEST_CASE("an APT program whose points do not change keeps every byte") {
  for (const std::string& text :
       {apt_milling, std::string("\xEF\xBB\xBFUNITS/INCHES\r\n GOTO / 1, 2 ,3, 0, 0, 1\r\nGOTO/1.5,2,.5\r\n"),
        std::string(
            "UNITS/MM\nGOTO/1,2,3,0,0,1,\nGOTO/1,2\nGOTO/P1\nPAINT/COLOR,3\n\n\nGOTO/1,2,3,.6,0,0.8")}) {
    CAPTURE(text);
    CHECK(unchanged(read_apt(text)) == text);
  }
}

TEST_CASE("changed numbers of APT keep their digits, at least three of mm and six of an axis") {
  const Program program = read_apt(apt_milling);
  MoveEdit rapid = robot_edit(program, 0), down = robot_edit(program, 1), across = robot_edit(program, 2);
  rapid.end_mm += Vector3(0.01, 0, 0);
  down.end_mm += Vector3(0.01234, 0, -0.0004);
  across.end_mm += Vector3(0.001, 0.0006, 0);
  across.orientation = OrientationNumbers{1.04e-6, -0.00123456789, 0.99999924};
  const Rewritten out = rewrite(program, {rapid, down, across}, {});
  CHECK(out.changed_words == 7);
  CHECK(out.text.substr(out.text.find("GOTO/10")) ==
        "GOTO/10.01,20,30.0,0,0.6,.8 $$ above\n"
        "FEDRAT/ 250.5 , MMPM\n"
        "GOTO / 10.012, 20, -1.5\n"
        "FEDRAT/IPM,10\n"
        "goto/+60.001,20.001,$ and the rest\n"
        "  -1.5,0.0000010,-0.0012346,0.9999992\n"
        "FINI\n");
}

TEST_CASE("inserted points of APT are copies of the statement, and get all three numbers of an axis") {
  const Program program = read_apt(apt_milling);
  MoveEdit down = robot_edit(program, 1), across = robot_edit(program, 2);
  down.inserted = {{{10, 20.01, 10}, {}, down.orientation},
                   {{10, 20.02, 5}, {}, OrientationNumbers{0.001, 0.6, 0.799999}}};
  across.jump = Via{{10.02, 20, -1.5}, {}, down.orientation};
  across.inserted = {{{35, 20, -1.499}, {}, OrientationNumbers{0, 0.3, 0.953939}}};
  const Rewritten out = rewrite(program, {down, across}, {});
  CHECK(out.inserted_blocks == 4);
  CHECK(out.blocks_of_edit == std::vector<std::size_t>{2, 2});
  CHECK(out.text.substr(out.text.find("GOTO / ")) ==
        "GOTO / 10.0, 20.01, 10.0\n"
        "GOTO / 10.0, 20.02, 5.0,0.001000,0.600000,0.799999\n"
        "GOTO / 10.0, 20, -1.5,0.000000,0.600000,0.800000\n"
        "FEDRAT/IPM,10\n"
        "goto/+10.02,20.,$ and the rest\n"
        "  -1.5,0.0000000,0.6000000,0.8000000\n"
        "goto/+35,20.,$ and the rest\n"
        "  -1.499,0.0000000,0.300000,0.953939\n"
        "goto/+6E1,20.,$ and the rest\n"
        "  -1.5,0.0000000,0.0000000,1.0000000\n"
        "FINI\n");
}

TEST_CASE("a program without any tool axis has positions alone") {
  const std::string text =
      "UNITS/MM\nFROM/0,0,9,0,0,1\nRAPID\nGOTO/0,0,5\nFEDRAT/100\nGOTO/0,0,-1\nGOTO/10,0,-1\n";
  const Program program = read_apt(text);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.left_alone.size() == 1);
  for (const Move& move : program.moves) {
    CHECK(!move.orientation);
    CHECK(all_known(move.known_end));
  }
  CHECK(program.moves[2].may_split);
  MoveEdit edit = robot_edit(program, 2);
  edit.end_mm.z() = -1.02;
  edit.inserted = {{{5, 0.01, -1}, {}, {}}};
  CHECK(rewrite(program, {edit}, {}).text ==
        "UNITS/MM\nFROM/0,0,9,0,0,1\nRAPID\nGOTO/0,0,5\nFEDRAT/100\nGOTO/0,0,-1\nGOTO/5,0.01,-1\nGOTO/"
        "10,0,-1.02\n");
}

TEST_CASE("a point without an axis keeps the last one, which a program must have given") {
  const Program program = read_apt(
      "UNITS/MM\n"
      "GOTO/0,0,5\n"
      "GOTO/0,0,4,0,0,2\n"
      "GOTO/0,0,3\n"
      "GOTO/0,0,2,0,0,0\n"
      "GOTO/0,0,1\n"
      "FROM/0,0,9,1,0,0\n"
      "GOTO/0,0,0\n");
  REQUIRE(program.moves.size() == 6);
  CHECK(!program.moves[0].known_end[0]);
  CHECK(!program.moves[1].known_start[0]);
  CHECK(all_known(program.moves[2].known_end));
  CHECK(program.moves[2].orientation->end == OrientationNumbers{0, 0, 2});
  CHECK(program.moves[3].fixed[0]);
  CHECK(!program.moves[4].known_end[0]);
  CHECK(!program.moves[5].known_end[0]);  // FROM/ is no point of the path
  CHECK(unchanged(program) == program.text);
}

TEST_CASE("inches are corrected in mm and written in inches") {
  const Program program = read_apt("UNITS/INCHES\nFEDRAT/10\nGOTO/1,2,3\nGOTO/1.5,2,3\n");
  CHECK((program.moves[1].end_mm - Vector3(38.1, 50.8, 76.2)).norm() < 1e-12);
  CHECK(program.moves[1].feed_mm_min == 254);
  MoveEdit edit = robot_edit(program, 1);
  edit.end_mm.y() += 0.0254;
  CHECK(rewrite(program, {edit}, {}).text == "UNITS/INCHES\nFEDRAT/10\nGOTO/1,2,3\nGOTO/1.5,2.001,3\n");
  CHECK(read_apt("GOTO/1,2,3\n", LengthUnit::inches).moves[0].end_mm.x() == 25.4);
  CHECK(
      refusal_of_apt("PARTNO A\nGOTO/1,2,3\n") ==
      "job.cls:2:1: error: a point before the unit is known: write UNITS/MM or UNITS/INCHES, or give --units "
      "mm or --units inch");
  CHECK(refusal_of_apt("UNITS/CM\n") == "job.cls:1:1: error: UNITS/ has an unknown unit; use MM or INCHES");
}

TEST_CASE("feeds per turn need the speed of the spindle, and rapid holds for one point") {
  const Program program = read_apt(
      "UNITS/MM\n"
      "FEDRAT/0.1,MMPR\n"
      "GOTO/0,0,5\n"
      "SPINDL/1000,CLW\n"
      "GOTO/0,0,4\n"
      "RAPID/\n"
      "GOTO/0,0,3\n"
      "GOTO/0,0,2\n"
      "FEDRAT/fast\n"
      "GOTO/0,0,1\n");
  CHECK(program.moves[0].feed_mm_min == 0);
  CHECK(program.moves[1].feed_mm_min == doctest::Approx(100));
  CHECK(program.moves[2].motion == Motion::rapid);
  CHECK(program.moves[3].motion == Motion::feed);
  CHECK(program.moves[4].feed_mm_min == 0);
}

TEST_CASE(
    "a feed or a speed whose value is not a number, has an unknown unit, or may be skipped is unknown") {
  const auto last = [](const std::string& lines) {
    return read_apt("UNITS/MM\nSPINDL/1000,CLW\nFEDRAT/200,MMPM\nGOTO/0,0,5\n" + lines + "GOTO/0,0,4\n")
        .moves.back();
  };
  CHECK(last("SPINDL/SPEED,CLW\n").spindle_rpm == 0);
  CHECK(last("SPINDL/OFF\n").spindle_rpm == 0);
  CHECK(last("SPINDL/ON\n").spindle_rpm == 1000);
  CHECK(last("SPINDL/CCLW\n").spindle_rpm == 1000);
  CHECK(last("SPINDL/RPM,3000,CLW\n").spindle_rpm == 3000);
  CHECK(last("FEDRAT/5,INVERS\n").feed_mm_min == 0);
  CHECK(last("FEDRAT/0.1,PERREV\n").feed_mm_min == doctest::Approx(100));
  CHECK(last("OPSKIP/ON\nSPINDL/3000,CLW\nFEDRAT/100,MMPM\nOPSKIP/OFF\n").spindle_rpm == 0);
  CHECK(last("OPSKIP/ON\nSPINDL/3000,CLW\nFEDRAT/100,MMPM\nOPSKIP/OFF\n").feed_mm_min == 0);
}

TEST_CASE("points between OPSKIP/ON and OPSKIP/OFF may be skipped as blocks with '/'") {
  const Program program = read_apt(
      "UNITS/MM\nLOADTL/1\nFEDRAT/200,MMPM\nGOTO/0,0,5\nOPSKIP/ON\nGOTO/1,0,5\nGOTO/2,0,5\nLOADTL/2\nGOTO/"
      "2,0,4\n"
      "OPSKIP/OFF\nGOTO/3,0,5\nGOTO/4,0,5\n");
  std::vector<bool> skippable, starts;
  for (const Move& move : program.moves) {
    skippable.push_back(move.block_delete);
    starts.push_back(all_known(move.known_start));
    CHECK(all_known(move.known_end));
  }
  CHECK(skippable == std::vector{false, true, true, true, false, false});
  CHECK(starts == std::vector{false, true, false, false, false, true});
  CHECK(program.moves[2].tool == 1);
  CHECK(program.moves[4].tool == 0);
}

TEST_CASE("CUTCOM/ and CYCLE/ that the control may not end still act") {
  const auto is_followed = [](const std::string& lines) {
    return !read_apt("UNITS/MM\nGOTO/0,0,5\n" + lines + "GOTO/1,0,5\n").moves.back().fixed[0];
  };
  for (const std::string word : {"CUTCOM/", "CYCLE/"}) {
    CAPTURE(word);
    CHECK(is_followed(word + "LEFT\n" + word + "OFF\n"));
    CHECK_FALSE(is_followed(word + "LEFT\nOPSKIP/ON\n" + word + "OFF\nOPSKIP/OFF\n"));
    CHECK_FALSE(is_followed("OPSKIP/ON\n" + word + "LEFT\nOPSKIP/OFF\n"));
  }
}

TEST_CASE("the points on the circle of CIRCLE/ are not followed: its centre would not be corrected") {
  const std::string text =
      "UNITS/MM\n"
      "FEDRAT/100\n"
      "GOTO/10,0,0\n"
      "CIRCLE/0,0,0,0,0,1,10\n"
      "GOTO/9.992,0.400,0\n"
      "GOTO/9.968,0.799,0\n"
      "GOTO/20,0.799,0\n"
      "CIRCLE/20,10,0,0,0,1\n"
      "GOTO/29.201,10,0\n"
      "RAPID\n"
      "GOTO/29.201,10,50\n"
      "GOTO/40,10,0\n"
      "CIRCLE/C1\n"
      "GOTO/40,20,0\n"
      "GOTO/60,20,0\n";
  const Program program = read_apt(text);
  std::vector<bool> fixed;
  for (const Move& move : program.moves) fixed.push_back(move.fixed[0]);
  CHECK(fixed == std::vector<bool>{false, true, true, false, true, false, false, true, true});
  CHECK(!program.moves[3].known_start[0]);
  CHECK(all_known(program.moves[3].known_end));
  REQUIRE(program.left_alone.size() == 3);
  CHECK(program.left_alone[0].line == 5);
  CHECK(program.left_alone[1].line == 9);
  CHECK(program.left_alone[2].line == 14);
  CHECK(unchanged(program) == text);
}

TEST_CASE("CYCLE/ and CUTCOM/ of APT are switched off by their own OFF only") {
  const auto read_between = [](const std::string& on, const std::string& other, const std::string& off) {
    return read_apt(fmt::format(
        "UNITS/MM\nFEDRAT/100\nGOTO/0,0,0\n{}{}GOTO/1,0,0\nGOTO/2,0,0\n{}GOTO/3,0,0\n", on, other, off));
  };
  for (const Program& program : {read_between("CYCLE/DRILL,10\n", "CUTCOM/OFF\n", "CYCLE/OFF\n"),
                                 read_between("CUTCOM/LEFT\n", "CYCLE/OFF\n", "CUTCOM/OFF\n")}) {
    REQUIRE(program.moves.size() == 4);
    CHECK(program.moves[1].fixed[0]);
    CHECK(program.moves[2].fixed[0]);
    CHECK(!program.moves[3].fixed[0]);
  }
}

TEST_CASE(
    "words of APT that end the program or select an offset are no moves, and the place behind them is "
    "unknown") {
  const Program program = read_apt(
      "UNITS/MM\n"
      "FEDRAT/100\n"
      "GOTO/0,0,0\n"
      "SWITCH/1,LENGTH\n"
      "GOTO/1,0,0\n"
      "GOTO/2,0,0\n"
      "REWIND/0\n"
      "GOTO/3,0,0\n"
      "END\n"
      "GOTO/4,0,0\n"
      "FINI\n");
  std::vector<bool> known_start;
  for (const Move& move : program.moves) known_start.push_back(move.known_start[0]);
  CHECK(known_start == std::vector<bool>{false, false, true, false, false});
  CHECK(program.left_alone.empty());
}

TEST_CASE("TLAXIS/ states the axis of points without one, and the tool turns where it changes") {
  const Program program = read_apt(
      "UNITS/MM\n"
      "TLAXIS/0,0,1\n"
      "GOTO/0,0,0\n"
      "TLAXIS/0.0,0.0,2.0\n"
      "GOTO/1,0,0\n"
      "CSYS/1,0,0,5,0,1,0,0,0,0,1,0\n"
      "GOTO/1,0,0\n"
      "TLAXIS/0,-0.6,0.8\n"
      "GOTO/2,0,0\n"
      "GOTO/3,0,0\n");
  std::vector<bool> known_start;
  for (const Move& move : program.moves) {
    CHECK(!move.orientation);
    known_start.push_back(move.known_start[0]);
  }
  CHECK(known_start == std::vector<bool>{false, true, false, false, true});
  const auto frame_of = [&](std::size_t move) { return program.frames[program.moves[move].frame]; };
  CHECK(frame_of(1).tool_axis == Vector3(0, 0, 1));
  CHECK(frame_of(2).tool_axis == Vector3(0, 0, 1));
  CHECK(frame_of(3).tool_axis == Vector3(0, -0.6, 0.8));
  CHECK(frame_of(2).work_offset == "CSYS_1");
  CHECK(frame_of(3).work_offset == "CSYS_1");
  const Program turning = read_apt("UNITS/MM\nGOTO/0,0,0,0,0,1\nTLAXIS/0,-0.6,0.8\nGOTO/1,0,0\n");
  CHECK(!turning.moves[1].known_end[0]);
  CHECK(refusal_of_apt("UNITS/MM\nTLAXIS/NORMPS\n")
            .starts_with("job.cls:2:1: error: TLAXIS/ is not an axis of three plain numbers"));
}

TEST_CASE("coordinate systems have names that the machine file can place") {
  const Program program = read_apt(
      "UNITS/MM\nCSYS/1,0,0,5,0,1,0,0,0,0,1,0\nGOTO/0,0,0\nMSYS/WCS1\nGOTO/1,0,0\n"
      "CSYS/1,0,0,7,0,1,0,0,0,0,1,0\nGOTO/2,0,0\nCSYS/1,0,0,5,0,1,0,0,0,0,1,0\nGOTO/3,0,0\n");
  std::vector<std::string> names;
  for (const Move& move : program.moves) names.push_back(program.frames[move.frame].work_offset);
  CHECK(names == std::vector<std::string>{"CSYS_1", "CSYS_WCS1", "CSYS_2", "CSYS_1"});
}

TEST_CASE("PREFUN/ may set any G code: what is behind it is not followed") {
  const Program program = read_apt("UNITS/MM\nGOTO/0,0,0\nPREFUN/91\nGOTO/10,0,0\n");
  CHECK(program.moves.size() == 3);
  CHECK_FALSE(program.moves[2].known_start[0]);
}

TEST_CASE("INSERT puts its text into the program of the machine: what is behind it is not followed") {
  const auto read = [](const std::string& statement) {
    return read_apt("UNITS/MM\nGOTO/0,0,0\n" + statement + "\nGOTO/10,0,0\n");
  };
  for (const char* statement :
       {"INSERT G52 X10", "INSERT/G1 X500", "INSERT TRANS", "INSERT 5 L X+10", "INSERT (A) G52 X10 (B)"}) {
    CAPTURE(statement);
    const Program program = read(statement);
    REQUIRE(program.left_alone.size() >= 1);
    CHECK(program.left_alone[0].why ==
          "INSERT puts its text into the program of the machine: it may move the tool");
    CHECK_FALSE(program.moves.back().known_start[0]);
  }
  for (const char* statement : {"INSERT (TOOL 5)", "INSERT/5MM CRB X10", "INSERT", "PPRINT G52 X10"}) {
    CAPTURE(statement);
    CHECK(read(statement).left_alone.empty());
  }
}

TEST_CASE("a remark of Creo continues in the lines of numbers behind a dollar sign") {
  const std::string text =
      "UNITS / MM\n"
      "FEDRAT / 100\n"
      "GOTO / 0, 0, 0\n"
      "$$-> CSYS / 1.0, 0.0, 0.0, 0.0, $\n"
      "            0.0, 1.0, 0.0, 0.0, $\n"
      "            0.0, 0.0, 1.0, 0.0\n"
      "GOTO / 1, 0, 0\n"
      "$$-> CSYS / 1.0, $\n"
      "GOTO / 2, 0, 0\n";
  const Program program = read_apt(text);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].line == 7);
  CHECK(program.moves[1].known_start[0]);
  CHECK(program.left_alone.empty());
  CHECK(unchanged(program) == text);
}

TEST_CASE("what APT does not give as plain points is not followed, or refused with its line") {
  const Program program = read_apt(
      "UNITS/MM\n"
      "GOTO/0,0,0\n"
      "GOTO/P1\n"
      "GOTO/1,2,3,4\n"
      "GODLTA/0,0,5\n"
      "GOTO/0,0,0\n"
      "CUTCOM/LEFT\n"
      "GOTO/1,0,0\n"
      "CUTCOM/OFF\n"
      "GOTO/2,0,0\n"
      "CYCLE/DRILL,10\n"
      "GOTO/3,0,0\n"
      "CYCLE/OFF\n"
      "GOTO/4,0,0\n"
      "GOHOME\n"
      "GOTO/5,0,0\n"
      "CSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0\n"
      "GOTO/6,0,0\n"
      "MSYS/1,0,0,1,0,0,0,1,0\n"
      "GOTO/7,0,0\n");
  std::vector<bool> fixed, known_start;
  for (const Move& move : program.moves) {
    fixed.push_back(move.fixed[0]);
    known_start.push_back(move.known_start[0]);
  }
  CHECK(fixed ==
        std::vector<bool>{false, true, true, true, false, true, false, true, false, false, false, false});
  CHECK(known_start ==
        std::vector<bool>{false, true, false, false, false, true, false, true, false, false, true, false});
  CHECK(program.frames[program.moves.back().frame].work_offset == "CSYS_1");
  CHECK(unchanged(program) == program.text);
  CHECK(
      refusal_of_apt("UNITS/MM\nTRACUT/M1\n").starts_with("job.cls:2:1: error: TRACUT/ changes the places"));
  CHECK(refusal_of_apt("UNITS/MM\nLOOPST\n").starts_with("job.cls:2:1: error: LOOPST/ is not supported"));
  CHECK(
      refusal_of_apt("UNITS/MM\n<<<<<<< HEAD\n").starts_with("job.cls:2:1: error: '<<<<<<<' is a conflict"));
}

TEST_CASE("texts of APT may have dollar signs") {
  const Program program =
      read_apt("PARTNO COST 5$\nUNITS/MM\nPPRINT/5$ A PIECE\nGOTO/1,2,3 $$ $\nGOTO/1,2,4\n");
  REQUIRE(program.moves.size() == 2);
  CHECK(program.moves[0].line == 4);
}

TEST_CASE("the header of APT follows PARTNO or begins the text") {
  const std::string text = "\xEF\xBB\xBFUNITS/MM\r\nGOTO/1,2,3\r\nFINI\r\nGOTO/4,5,6\r\n";
  const Program program = read_apt(text);
  CHECK(program.moves.size() == 1);
  CHECK(program.remarks.size() == 1);
  const WriteOptions options{.header = {"COUNTERFLEX 1", "second\tline"}};
  const std::string out = rewrite(program, {}, options).text;
  CHECK(out ==
        "\xEF\xBB\xBF$$ COUNTERFLEX 1\r\n$$ second line\r\nUNITS/MM\r\nGOTO/1,2,3\r\nFINI\r\nGOTO/4,5,6\r\n");
  CHECK(is_corrected(read_apt(out)));
  CHECK(!is_corrected(program));
  const std::string named = rewrite(read_apt(apt_milling), {}, options).text;
  CHECK(named.starts_with("PARTNO BRACKET $$ 2 off\n$$ COUNTERFLEX 1\n$$ second line\nUNITS/MM\n"));
  CHECK(is_corrected(read_apt(named)));
}

TEST_CASE("a long APT program is written the same in windows and as a whole") {
  std::string text = "PARTNO\nUNITS/MM\nFEDRAT/100\nGOTO/0,0,0,0,0,1\n";
  for (int i = 1; i < 5000; ++i) {
    text += fmt::format("GOTO/{:.3f},1.5,0\n", 0.1 * i);
    if (i % 7 == 0) text += fmt::format("GOTO/{:.3f},1.5, $\n 0.5,0.6,0,0.8\n", 0.1 * i);
    if (i % 90 == 0) text += "RAPID\nGOTO/0,0,0,0,0,1\n";
    if (i % 5 == 0) text += "$$-> CSYS / 1, 0, 0, 0, $\n  0, 1, 0, 0, $\n  0, 0, 1, 0\n";
  }
  const auto edits_of = [](const Program& program) {
    std::vector<MoveEdit> edits = robot_edits(program);
    for (MoveEdit& edit : edits) {
      edit.end_mm += Vector3(0.125, -0.0625, 0.5);
      (*edit.orientation)[0] += 0.03125;
      const Move& move = program.moves[edit.move];
      if (move.may_split)
        edit.inserted = {{0.5 * (move.start_mm + move.end_mm), {}, numbers_at(*move.orientation, 0.5)}};
    }
    return edits;
  };
  const Program whole = read_apt(text);
  const std::string expected = rewrite(whole, edits_of(whole), {.header = {"COUNTERFLEX 1"}}).text;
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "job", {}, 300);
  Rewriter rewriter({.header = {"COUNTERFLEX 1"}});
  std::string out;
  int windows = 0;
  while (reader.next()) {
    out += rewriter.write(reader.window(), edits_of(reader.window())).text;
    ++windows;
  }
  CHECK(out == expected);
  CHECK(windows > 3);
}

TEST_CASE("each APT program of a folder of real programs is reproduced or refused with its line") {
  for (const std::optional<LengthUnit> unit :
       {std::optional<LengthUnit>(), std::optional(LengthUnit::millimetres)})
    check_corpus(
        [](const std::filesystem::path& path) { return path.filename().string().starts_with("apt_"); },
        text_of_file, {.unit = unit});
}
