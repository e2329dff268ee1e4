// Programs of KUKA robots: reading.
#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/files/files.hpp"
#include "counterflex/program/program_reader.hpp"
#include "program/robot/kuka/kuka.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The refusal of `statements`; "none" if they are read.
std::string refusal_of(const std::string& statements) {
  return diagnostic_of([&] { read_statements(statements); });
}

}  // namespace

TEST_CASE("the targets of LIN and PTP are read with their orientations, base, tool and feed") {
  const Program program = read_krl(milling);
  CHECK(program.dialect == "kuka");
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 7);
  CHECK(program.left_alone[0].machine_position);
  const Move &rapid = program.moves[0], &down = program.moves[1], &across = program.moves[2];
  CHECK(rapid.motion == Motion::rapid);
  CHECK(rapid.line == 8);
  CHECK(!rapid.known_start[0]);
  CHECK(all_known(rapid.known_end));
  CHECK(!rapid.may_split);
  CHECK(!rapid.may_jump);
  CHECK(down.motion == Motion::feed);
  CHECK(down.start_mm == Vector3(10, 20, 30));
  CHECK(down.end_mm == Vector3(10, 20, -1.5));
  CHECK(down.feed_mm_min == doctest::Approx(3000));
  CHECK(down.tool == 5);
  CHECK(down.may_split);
  CHECK(down.may_jump);
  CHECK(down.may_insert_words);
  CHECK(program.operations[down.operation] == "POCKET");
  CHECK(across.orientation->form == OrientationForm::fixed_axes);
  CHECK(!across.orientation->by_angles);
  CHECK(across.orientation->start == OrientationNumbers{180, 0, 40});
  CHECK(across.orientation->end == OrientationNumbers{180, 0, 50});
  const ProgramFrame& base = program.frames[across.frame];
  CHECK(base.work_offset == "$BASE");
  REQUIRE(base.pose_mm.has_value());
  CHECK(base.pose_mm->p == Vector3(100, 0, 0));
  CHECK((*base.pose_mm * Vector3(1, 0, 0) - Vector3(100, 1, 0)).norm() < 1e-12);
}

TEST_CASE("A, B and C of KRL turn about Z, Y and X") {
  const Program program = read_statements("LIN {X 1,Y 2,Z 3,A 90,B 0,C 90}\n");
  const Matrix3 R = turn_of(*program.moves[0].orientation).end;
  // Rz(90) Rx(90): X goes to Y, Y to Z, Z to X.
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-12);
  CHECK((R * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-12);
  CHECK((R * Vector3::UnitZ() - Vector3::UnitX()).norm() < 1e-12);
}

TEST_CASE("a position is known only with its orientation") {
  const Program program = read_statements(
      "LIN {X 1,Y 2,Z 3}\n"
      "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\n"
      "LIN {X 5}\n"
      "PTP {A1 5}\n"
      "LIN {X 5}\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(!program.moves[0].known_end[0]);
  CHECK(!program.moves[1].known_start[0]);
  CHECK(all_known(program.moves[1].known_end));
  CHECK(all_known(program.moves[2].known_start));
  CHECK(!program.moves[3].known_start[0]);
  CHECK(!program.moves[3].known_end[0]);
}

TEST_CASE("a CIRC whose circle is not known is not followed, and is listed once") {
  const Program program = read_statements(
      "CIRC {X 0,Y 10,Z 0}, {X -10,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n"
      "PTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n"
      "CIRC {X 0,Y 0,Z 0}, {X -10,Y 0,Z 0} C_DIS\n"
      "LIN {X 5}\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[0].fixed[0]);
  CHECK(program.moves[2].fixed[0]);
  CHECK(!program.moves[3].known_start[0]);
  REQUIRE(program.left_alone.size() == 3);
  CHECK(program.left_alone[0].line == 2);
  CHECK(program.left_alone[1].line == 4);
  CHECK(program.left_alone[2].line == 5);
}

TEST_CASE("a line that stops at its target, or whose external axes move, is not split") {
  const Program program = read_statements(
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0,E1 0}\n"
      "LIN {X 1,E1 0}\n"
      "LIN {X 2,E1 5} C_DIS\n"
      "LIN {X 3,E1 5} C_DIS\n");
  CHECK(program.moves[1].exact_stop);
  CHECK(!program.moves[1].may_split);
  CHECK(!program.moves[2].exact_stop);
  CHECK(!program.moves[2].may_split);
  CHECK(program.moves[3].may_split);
  REQUIRE(program.external_axes_move);
  CHECK(program.external_axes_move->line == program.moves[2].line);
  CHECK(program.external_axes_move->what.find("from 0 to 5") != std::string::npos);
}

TEST_CASE("a motion behind a TRIGGER stays whole: it acts at a place of this motion") {
  const Program program = read_statements(
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n$VEL.CP=0.1\n"
      "LIN {X 1} C_DIS\n"
      "TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE\n"
      "LIN {X 2} C_DIS\n"
      "LIN {X 3} C_DIS\n");
  CHECK(program.moves[1].may_split);
  CHECK_FALSE(program.moves[2].may_split);
  CHECK_FALSE(program.moves[2].may_jump);
  CHECK(program.moves[3].may_split);
}

TEST_CASE("the program gives its external axes with their first lines, also from a joint target before it") {
  const Program program = read_statements(
      "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E1 850}\n"
      "LIN {X 1,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n"
      "LIN {X 2,E2 -30} C_DIS\n");
  REQUIRE(program.external_axes[0]);
  CHECK(program.external_axes[0]->value == 850);
  CHECK(program.external_axes[0]->line == program.moves[0].line);
  REQUIRE(program.external_axes[1]);
  CHECK(program.external_axes[1]->value == -30);
  CHECK(!program.external_axes[2]);
  CHECK(!program.external_axes_move);
}

TEST_CASE(
    "an external axis that a joint target moves has moved, though the targets after it do not have it") {
  const Program program = read_statements(
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0,E1 0}\n"
      "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E1 850}\n"
      "LIN {X 1,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n");
  REQUIRE(program.external_axes_move);
  CHECK(program.external_axes_move->line == program.moves[1].line);
}

TEST_CASE("forces and operations are read from comments, folds are not operations") {
  const Program program = read_statements(
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"
      ";FOLD LIN P1 CONT Vel=0.1 m/s CPDAT1 Tool[1] Base[0];%{PE}\n"
      "; FORCE FX=215 FY=-10 FZ=-25 MX=1 MY=21.5\n"
      "LIN {X 5} C_DIS\n"
      ";ENDFOLD\n"
      "; SLOT 2\n"
      "LIN {X 6} C_DIS ; FORCE OFF\n");
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.moves[1].force.has_value());
  CHECK((*program.moves[1].force)[0] == 215);
  CHECK(program.operations[program.moves[1].operation] == "");
  CHECK(!program.moves[2].force);
  CHECK(program.operations[program.moves[2].operation] == "SLOT 2");
}

TEST_CASE("bases, tools and speeds of KRL and of BAS are followed") {
  const Program program = read_statements(
      "BASE_DATA[3]={X 1,Y 2,Z 3,A 0,B 0,C 0}\n"
      "$BASE=BASE_DATA[3]\n"
      "$TOOL = TOOL_DATA[ 4 ]\n"
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"
      "$base = base_data[3]\n"
      "BAS (#VEL_CP,0.5)\n"
      "LIN {X 5}\n"
      "FDAT_ACT={TOOL_NO 7,BASE_NO 2,IPO_FRAME #BASE}\n"
      "BAS(#CP_PARAMS,2)\n"
      "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n"
      "$BASE=$WORLD:offset\n"
      "$VEL.CP=speed\n"
      "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n");
  REQUIRE(program.moves.size() == 4);
  const auto frame = [&](std::size_t m) { return program.frames[program.moves[m].frame]; };
  CHECK(frame(0).work_offset == "BASE_DATA[3]");
  CHECK(frame(0).pose_mm->p == Vector3(1, 2, 3));
  CHECK(program.moves[0].tool == 4);
  CHECK(all_known(program.moves[1].known_start));
  CHECK(program.moves[1].frame == program.moves[0].frame);
  CHECK(program.moves[1].feed_mm_min == 30000);
  CHECK(frame(2).work_offset == "BASE_DATA[2]");
  CHECK(!frame(2).pose_mm);
  CHECK(program.moves[2].tool == 7);
  CHECK(program.moves[2].feed_mm_min == 120000);
  CHECK(!program.moves[2].known_start[0]);
  CHECK(frame(3).work_offset == "$BASE 1");
  CHECK(!frame(3).pose_mm);
  CHECK(!program.moves[3].known_start[0]);
  CHECK(program.moves[3].feed_mm_min == 0);
}

TEST_CASE("what is computed at run time is left alone or refused with its line") {
  const Program program = read_statements(
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"
      "LIN {X depth,Y 0,Z 0}\n"
      "LIN {X 1,Y 0,Z 0,A 0,B 0,C 0}\n"
      "LIN P1:{Z 5}\n"
      "PTP XHOME\n"
      "FOR i=1 TO 3\n"
      "  LIN {X 1,Y 0,Z 0,A 0,B 0,C 0}\n"
      "ENDFOR\n");
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[1].fixed[0]);
  CHECK(!program.moves[2].known_start[0]);
  CHECK(all_known(program.moves[2].known_end));
  CHECK(program.moves[3].fixed[0]);
  CHECK(program.moves[4].fixed[0]);
  REQUIRE(program.left_alone.size() == 4);
  CHECK(program.left_alone[0].line == 3);
  CHECK(program.left_alone[1].line == 5);
  CHECK(program.left_alone[2].line == 6);
  CHECK(program.left_alone[3].line == 8);
  CHECK(
      refusal_of("LIN P1 C_DIS\n") ==
      "job.src:2:5: error: the target 'P1' of LIN is neither in this file nor in a data list; give the list "
      "that has it with --data FILE.dat");
  CHECK(refusal_of("FOR i=1 TO 9\nP[i].A=-30\nLIN P[i]\nENDFOR\n")
            .starts_with("job.src:3:1: error: 'P[i].A' is computed at run time"));
}

TEST_CASE("a frame that a condition, a routine or an expression gives is not known") {
  const auto frame_behind = [](const std::string& statements, const std::string& routines) {
    const Program program = read_krl("DEF job()\nBAS(#BASE,4)\n" + statements +
                                     "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\nEND\n" + routines);
    REQUIRE(!program.moves.empty());
    return program.frames[program.moves.back().frame].work_offset;
  };
  CHECK(frame_behind("IF x THEN\nBAS(#BASE,5)\nENDIF\n", "") == "$BASE 1");
  CHECK(frame_behind("IF x THEN\nBAS(#BASE,4)\nENDIF\n", "") == "BASE_DATA[4]");
  CHECK(frame_behind("frames()\n", "DEF frames()\nBAS(#BASE,5)\nEND\n") == "$BASE 1");
  CHECK(frame_behind("first()\n", "DEF first()\nsecond()\nEND\nDEF second()\n$BASE=BASE_DATA[1]\nEND\n") ==
        "$BASE 1");
  CHECK(frame_behind("x=frames()\n", "DEFFCT INT frames()\n$BASE=BASE_DATA[1]\nRETURN 1\nENDFCT\n") ==
        "$BASE 1");
  CHECK(frame_behind("speed()\n", "DEF speed()\nBAS(#VEL_CP,0.5)\nEND\n") == "BASE_DATA[4]");
  CHECK(frame_behind("$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}:{X 2,Y 0,Z 0,A 0,B 0,C 0}\n", "") == "$BASE 1");
  CHECK(frame_behind("BASE_DATA[5]=BASE_DATA[6]\n$BASE=BASE_DATA[5]\n", "") == "$BASE 1");
  CHECK(frame_behind("BASE_DATA[5].X=BASE_DATA[5].X+1\nBAS(#BASE,5)\n", "") == "$BASE 1");
  CHECK(frame_behind("BASE_DATA[n]=other\nBAS(#BASE,5)\n", "") == "$BASE 2");
  CHECK(frame_behind("BAS(#BASE,5)\n", "DEF set()\nBASE_DATA[5].Z=2\nEND\n") == "$BASE 1");
}

TEST_CASE("the names of computed bases count on in the program, whatever lines are before them") {
  const std::string motion = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  const std::string text = "$BASE=BASE_DATA[n]\n" + motion + "BAS(#BASE,2)\n" + motion + "x=f($BASE.X)\n" +
                           "$BASE=BASE_DATA[n]\n" + motion;
  for (const char* const before : {"", ";COUNTERFLEX 1\n;HASH\n"}) {
    const Program program = read_statements(before + text);
    REQUIRE(program.moves.size() == 3);
    const auto name = [&](std::size_t m) { return program.frames[program.moves[m].frame].work_offset; };
    CHECK(name(0) == "$BASE 1");
    CHECK(name(1) == "BASE_DATA[2]");
    CHECK(name(2) == "$BASE 2");
  }
  const Program program = read_statements(text);
  REQUIRE(!program.left_alone.empty());
  CHECK(program.left_alone[0].why.find("[work.\"$BASE 1\"]") != std::string::npos);
}

TEST_CASE("base 0 is the world frame") {
  for (const char* const selects : {"$BASE=BASE_DATA[0]\n", "BAS(#BASE,0)\n",
                                    "FDAT_ACT={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE}\nBAS(#FRAMES)\n"}) {
    CAPTURE(selects);
    const Program program = read_statements(std::string(selects) + "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n");
    REQUIRE(program.moves.size() == 1);
    const ProgramFrame& frame = program.frames[program.moves[0].frame];
    CHECK(frame.work_offset == "$NULLFRAME");
    REQUIRE(frame.pose_mm);
    CHECK(frame.pose_mm->p == Vector3::Zero());
  }
}

TEST_CASE("a motion whose tool is not known is refused with the line that selects it") {
  const std::string motion = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  CHECK(refusal_of("BAS(#TOOL,1)\nIF x THEN\nBAS(#TOOL,2)\nENDIF\n" + motion)
            .starts_with("job.src:6:1: error: the tool of this motion is not known: line 4 selects it"));
  CHECK(refusal_of("BAS(#TOOL,1)\nIF x THEN\nBAS(#TOOL,1)\nENDIF\n" + motion) == "none");
  CHECK(refusal_of("IF x THEN\nBAS(#TOOL,2)\nENDIF\nBAS(#TOOL,1)\n" + motion) == "none");
  CHECK(refusal_of("TOOL_DATA[2].Z=x\nBAS(#TOOL,2)\n" + motion).starts_with("job.src:4:1: error: the tool"));
  CHECK(diagnostic_of([&] {
          read_krl("DEF job()\nhead()\n" + motion + "END\nDEF head()\n$TOOL=TOOL_DATA[2]\nEND\n");
        }).starts_with("job.src:3:1: error: the tool of this motion is not known: line 2 selects it"));
}

TEST_CASE("a target that a routine, an argument or a computed index may change is computed at run time") {
  const auto refusal = [](const std::string& statements, const std::string& routines) {
    return diagnostic_of([&] {
      read_krl("DEF job()\nP[1]={X 5,Y 0,Z 0,A 0,B 0,C 0}\n" + statements + "LIN P[1]\nEND\n" + routines);
    });
  };
  const std::string why = ": error: the target 'P[1]' of LIN in line 4 is computed at run time";
  CHECK(refusal("deeper()\n", "DEF deeper()\nP[1].Z=P[1].Z-2\nEND\n").starts_with("job.src:7:1" + why));
  CHECK(refusal("lower(P[1],2)\n", "").starts_with("job.src:3:1" + why));
  CHECK(refusal("ok=lower(P[],2)\n", "DEFFCT BOOL lower(t:OUT,d:IN)\nENDFCT\n")
            .starts_with("job.src:3:1" + why));
  CHECK(refusal("P[n].Z=0\n", "").starts_with("job.src:3:1" + why));
  CHECK(refusal("DECL POS P[2]\nP[n].Z=0\n", "").starts_with("job.src:4:1: error: the target 'P[1]' of LIN"));
  CHECK(refusal("show(P[1],2)\n", "DEF show(t:IN,d:IN)\nt.Z=0\nEND\n") == "none");
  CHECK(refusal("other()\n", "DEF other()\nDECL POS P[2]\nP[1].Z=0\nEND\n") == "none");
  CHECK(refusal("other()\n", "DEF other()\nP[2].Z=0\nEND\n") == "none");
}

TEST_CASE("a routine of the file without motions leaves the position, and one that cuts is a feed move") {
  const std::string line = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  const auto read = [&](const std::string& routines) {
    return read_krl("DEF job()\n" + line + "part()\n" + line + "END\n" + routines);
  };
  const Program quiet = read("DEF part()\n$OUT[7]=TRUE\nWAIT SEC 0.5\nEND\n");
  CHECK(quiet.left_alone.empty());
  CHECK(all_known(quiet.moves[1].known_start));
  const Program cuts = read("DEF part()\ninner()\nEND\nDEF inner()\n" + line + "END\n");
  REQUIRE(cuts.left_alone.size() == 1);
  CHECK(cuts.left_alone[0].feeds);
  CHECK(cuts.left_alone[0].why == "'part' is not followed: its motions are not corrected");
  CHECK_FALSE(all_known(cuts.moves[1].known_start));
}

TEST_CASE("behind a KRL routine that sets how motions run, its values are not followed until they are set") {
  const auto read = [](const std::string& body, const std::string& behind) {
    return read_krl("DEF job()\n$VEL.CP=0.1\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 0}\npart()\n" + behind +
                    "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n"
                    "CIRC {X 10,Y 5,Z 0},{X 15,Y 0,Z 0,A 0,B 0,C 0}\nEND\n"
                    "DEF part()\ninner()\nEND\nDEF inner()\n" +
                    body + "END\n");
  };
  for (const std::string body : {"$VEL.CP=0.5\n", "$VEL={CP 2}\n", "BAS(#VEL_CP,0.5)\n"}) {
    CAPTURE(body);
    const Program slower = read(body, "");
    CHECK(slower.left_alone.empty());
    CHECK(slower.moves.at(1).feed_mm_min == 0);
    CHECK(read(body, "$VEL.CP=0.2\n").moves.at(1).feed_mm_min == doctest::Approx(12'000));
  }
  const auto reason = [](const Program& program) {
    return program.left_alone.empty() ? "" : program.left_alone.front().why;
  };
  CHECK(reason(read("$ORI_TYPE=#CONSTANT\n", "")) == "'part' may set $ORI_TYPE; set it behind the call");
  CHECK(reason(read("$ORI_TYPE=#CONSTANT\n", "$ORI_TYPE=#VAR\n")).empty());
  const Program turning = read("$CIRC_TYPE=#PATH\n", "");
  CHECK(reason(turning) == "'part' may set $CIRC_TYPE; set it behind the call");
  CHECK(turning.left_alone.front().line == 6);
  CHECK(reason(read("$CIRC_TYPE=#PATH\n", "$CIRC_TYPE=#BASE\n")).empty());
  CHECK(read("$OUT[7]=TRUE\n", "").moves.at(1).feed_mm_min == 6000);
}

TEST_CASE("a routine of another KRL file may cut, and the report shows what it must not change") {
  const std::string line = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  for (const std::string routine : {"", "DEF part()\nSPINDLE(1)\nEND\n"}) {
    CAPTURE(routine);
    const Program program = read_krl("DEF job()\n" + line + "part()\n" + line + "END\n" + routine);
    REQUIRE(program.left_alone.size() == 1);
    CHECK(program.left_alone[0].feeds);
    CHECK(program.left_alone[0].why == "the call of 'part' may move the robot");
    REQUIRE(!program.remarks.empty());
    CHECK(program.remarks[0].line == 3);
    CHECK(program.remarks[0].what ==
          "assumed from here on: called programs do not change $BASE, $TOOL, $VEL, $ORI_TYPE and $CIRC_TYPE; "
          "see that their text agrees");
  }
  const std::string joint = "DEF part()\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nEND\n";
  const Program own = read_krl("DEF job()\n" + line + "part()\n" + line + "END\n" + joint);
  REQUIRE(own.left_alone.size() == 1);
  CHECK_FALSE(own.left_alone[0].feeds);
  for (const Remark& remark : own.remarks) CHECK_FALSE(remark.what.starts_with("assumed"));
}

TEST_CASE("a routine of the file in an expression, TRIGGER or INTERRUPT acts as in a call") {
  const std::string line = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  for (const char* statement :
       {"x=part()\n", "IF part() THEN\nENDIF\n", "WAIT FOR NOT part()\n", "REPEAT\nUNTIL part()\n",
        "TRIGGER WHEN DISTANCE=0 DELAY=0 DO part() PRIO=-1\n",
        "INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO part()\n"}) {
    CAPTURE(statement);
    const auto is_known = [&](const std::string& body) {
      const Program program = read_krl("DEF job()\n" + line + statement + line + "END\nDEFFCT BOOL part()\n" +
                                       body + "RETURN TRUE\nENDFCT\n");
      return all_known(program.moves.at(1).known_start);
    };
    CHECK(is_known("DECL INT n\nn=1\n"));
    CHECK(is_known("$OUT[7]=TRUE\n"));
    CHECK_FALSE(is_known(line));
  }
}

TEST_CASE("a KRL function of another file in an expression may cut, as a call of it does") {
  const std::string line = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n";
  const auto calls_of = [&](const std::string& statement) {
    CAPTURE(statement);
    const Program program = read_krl("DEF job()\nEXTFCT INT f(INT:IN)\n" + line + statement + line + "END\n");
    return std::ranges::count_if(program.left_alone, [](const LeftAlone& block) { return block.feeds; });
  };
  for (const char* statement :
       {"f(1)\n", "x=f(1)\n", "x = 1+f (1)\n", "IF f(1)==2 THEN\nENDIF\n", "WAIT FOR f(1)\n",
        "WHILE f(1)>2\nENDWHILE\n", "RETURN f(1)\n", "$OUT[f(1)]=TRUE\n", "$VEL.CP=f(2)\n",
        "SWITCH f(1)\nCASE 1\nENDSWITCH\n", "FOR k=1 TO f(3)\nENDFOR\n",
        "PTP {X f(1),Y 0,Z 60,A 0,B 0,C 0}\n", "TRIGGER WHEN PATH=0 DELAY=0 DO f(1) PRIO=-1\n",
        "ret=RSI_ON(#RELATIVE)\n", "INTERRUPT DECL 5 WHEN $IN[1]==TRUE DO f(1)\n", "P=INV_POS(f(1))\n"})
    CHECK(calls_of(statement) == 1);
  for (const char* statement :
       {"x=a[1]\n", "x=ABS(SIN(a)+COS(b))*(1+2)\n", "P=INV_POS(Q):R\n", "F={X (1+2),Y 0,Z (k),A 0,B 0,C 0}\n",
        "IF (a) AND NOT (b) OR ($IN[1]) THEN\nENDIF\n", "WAIT SEC (2)\n", "REPEAT\nUNTIL (a)\n",
        "MSG(\"call f(1)\")\n", "s[]=\"f(1)\"\n", "INTERRUPT DECL 3 WHEN ($STOPMESS==TRUE) DO IR_STOPM ( )\n",
        "ok=EKI_OPEN(\"Sensor\")\n", "n=STRLEN(s[])\n", "x=VARSTATE(\"P\")\n",
        "h=Set_KrlMsg(#INFO,m,p[],o)\n"})
    CHECK(calls_of(statement) == 0);
}

TEST_CASE("the expressions of a KRL routine are judged as its calls are") {
  const auto feeds = [](const std::string& condition) {
    const Program program =
        read_krl("DEF job()\nIF " + condition + " THEN\nENDIF\npart()\nEND\nDEF part()\nIF " + condition +
                 " THEN\n$OUT[1]=TRUE\nENDIF\nEND\n");
    return std::ranges::count_if(program.left_alone, [](const LeftAlone& block) { return block.feeds; });
  };
  CHECK(feeds("ABS(x)>2") == 0);
  CHECK(feeds("other(x)>2") == 2);
}

TEST_CASE("behind an external base, and a value read into $BASE or $TOOL, these are not known") {
  const std::string line = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n";
  const std::string start = "DEF job()\n$TOOL=TOOL_DATA[3]\n$BASE=BASE_DATA[1]\n" + line;
  const auto base_behind = [&](const std::string& statement, const std::string& routines = "") {
    const Program program = read_krl(start + statement + line + "END\n" + routines);
    return program.frames[program.moves.back().frame].work_offset;
  };
  CHECK(base_behind("BAS(#EX_BASE,1)\n") == "$BASE 1");
  CHECK(base_behind("BAS(what,1)\n$TOOL=TOOL_DATA[3]\n") == "$BASE 1");
  CHECK(base_behind("SREAD(a,b,$BASE)\n") == "$BASE 1");
  CHECK(base_behind("CREAD(1,s,m,t,o,\"%r\",$BASE.X)\n") == "$BASE 1");
  CHECK(base_behind("ok=EKI_GetFrame(\"S\",\"F\",$BASE)\n") == "$BASE 1");
  CHECK(base_behind("part()\n", "DEF part()\nSREAD(a,b,$BASE)\nEND\n") == "$BASE 1");
  CHECK(base_behind("SWRITE(s[],t,o,\"%r\",$BASE.X)\n") == "BASE_DATA[1]");
  CHECK(base_behind("BAS(#VEL_PTP,100)\nBAS(#ACC_CP,50)\n") == "BASE_DATA[1]");
  const auto refusal = [&](const std::string& statement) {
    return diagnostic_of([&] { read_krl(start + statement + line + "END\n"); });
  };
  CHECK(
      refusal("SREAD(a,b,$TOOL)\n").starts_with("job.src:6:1: error: the tool of this motion is not known"));
  CHECK(refusal("SREAD(a,b,c)\n") == "none");
}

TEST_CASE("a member of FDAT_ACT selects the base of its number, and a computed one another base") {
  const auto bases = [](const std::string& first, const std::string& second) {
    const std::string select = "BAS(#FRAMES)\nLIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
    const Program program = read_statements("FDAT_ACT={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE}\n" + first +
                                            select + second + select);
    std::vector<std::string> names;
    for (const Move& move : program.moves) names.push_back(program.frames[move.frame].work_offset);
    CHECK(program.moves.back().tool == 1);
    return names;
  };
  using Names = std::vector<std::string>;
  CHECK(bases("", "FDAT_ACT.BASE_NO=3\n") == Names{"BASE_DATA[2]", "BASE_DATA[3]"});
  CHECK(bases("FDAT_ACT.BASE_NO=3\n", "FDAT_ACT.BASE_NO = 4\n") == Names{"BASE_DATA[3]", "BASE_DATA[4]"});
  CHECK(bases("FDAT_ACT.BASE_NO=n\n", "FDAT_ACT.BASE_NO=n\n") == Names{"$BASE 1", "$BASE 2"});
  CHECK(bases("FDAT_ACT.IPO_FRAME=#BASE\n", "") == Names{"BASE_DATA[2]", "BASE_DATA[2]"});
  const std::string move = "BAS(#FRAMES)\nLIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  for (const std::string data :
       {"FDAT_ACT={TOOL_NO t,BASE_NO 2,IPO_FRAME #BASE}\n", "FDAT_ACT.TOOL_NO=2\n", "FDAT_ACT.IPO_FRAME=f\n",
        "FDAT_ACT=FP1\nIF a THEN\nFDAT_ACT=FP2\nENDIF\n"}) {
    CAPTURE(data);
    CHECK(refusal_of(data + move).find("the tool of this motion is not known") != std::string::npos);
  }
}

TEST_CASE("splines, jumps and a moved workpiece are refused with their line") {
  CHECK(refusal_of("\nSPLINE\n  SPL P1\nENDSPLINE\n").starts_with("job.src:3:1: error: SPLINE is a spline"));
  CHECK(refusal_of("SLIN {X 1}\n").starts_with("job.src:2:1: error: SLIN is a spline motion"));
  CHECK(refusal_of("GOTO again\n").starts_with("job.src:2:1: error: GOTO is not supported"));
  CHECK(refusal_of("$IPO_MODE=#TCP\n").starts_with("job.src:2:1: error: $IPO_MODE=#TCP moves the workpiece"));
  const std::string act = "FDAT_ACT={TOOL_NO 1,BASE_NO 2,IPO_FRAME ";
  CHECK(refusal_of(act + "#TCP}\nBAS(#CP_PARAMS,0.02)\n")
            .starts_with("job.src:3:1: error: IPO_FRAME=#TCP moves the workpiece"));
  CHECK(refusal_of("FDAT_ACT.IPO_FRAME = #TCP\n").starts_with("job.src:2:1: error: FDAT_ACT.IPO_FRAME=#TCP"));
  CHECK(refusal_of(act + "#BASE}\nBAS(#CP_PARAMS,0.02)\n") == "none");
  CHECK(refusal_of("$BASE.X = 5\n").starts_with("job.src:2:1: error: '$BASE.X' changes one number"));
  CHECK(refusal_of("<<<<<<< HEAD\n").starts_with("job.src:2:1: error: '<<<<<<<' is a conflict marker"));
  CHECK(diagnostic_of([] {
          read_krl("DEFDAT job\nENDDAT\n");
        }).starts_with("job.src:1:1: error: this is a data list"));
}
