// Programs of FANUC robots: reading.
#include <doctest/doctest.h>

#include "program/robot/fanuc/fanuc.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string tp_milling =
    "  !POCKET ;\n"
    "  UFRAME_NUM=1 ;\n"
    "  UTOOL_NUM=2 ;\n"
    "J P[1] 50% CNT100    ;\n"
    "L P[2:DOWN] 20mm/sec FINE    ;\n"
    "L P[3] 240cm/min CNT60 ACC80    ;\n"
    "//L P[1] 100mm/sec FINE    ;\n"
    "   ;\n"
    "L P[4] 10inch/min CNT0    ;\n";

Matrix3 tp_rotation_at_end(const Program& program, std::size_t move) {
  return rotation_of(OrientationForm::fixed_axes, program.moves[move].orientation->end);
}

}  // namespace

TEST_CASE("the positions of J and L are read with their orientation, frame, tool and speed") {
  const Program program = read_tp_statements(tp_milling);
  CHECK(program.dialect == "fanuc_tp");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.left_alone.empty());
  const Move &rapid = program.moves[0], &down = program.moves[1], &across = program.moves[2],
             &last = program.moves[3];
  CHECK(rapid.motion == Motion::rapid);
  CHECK(rapid.line == 9);
  CHECK(!rapid.known_start[0]);
  CHECK(rapid.end_mm == Vector3(0, 0, 50));
  CHECK(!rapid.may_split);
  CHECK(down.motion == Motion::feed);
  CHECK(down.start_mm == Vector3(0, 0, 50));
  CHECK(down.end_mm == Vector3(0, 0, 0));
  CHECK(down.feed_mm_min == doctest::Approx(1200));
  CHECK(down.exact_stop);
  CHECK(!down.may_split);
  CHECK(across.feed_mm_min == doctest::Approx(2400));
  CHECK(across.may_split);
  CHECK(across.may_jump);
  CHECK(across.tool == 2);
  CHECK(program.frames[across.frame].work_offset == "UF 1");
  CHECK(!program.frames[across.frame].pose_mm);
  CHECK(across.orientation->form == OrientationForm::fixed_axes);
  CHECK(!across.orientation->by_angles);
  CHECK(across.orientation->start == OrientationNumbers{180, 0, 0});
  CHECK(across.orientation->end == OrientationNumbers{180, 0, 10});
  CHECK(program.operations[across.operation] == "POCKET");
  CHECK(last.feed_mm_min == doctest::Approx(254));
  CHECK(last.exact_stop);  // CNT0
  CHECK(last.line == 14);
}

TEST_CASE("W, P and R turn about the fixed axes X, Y and Z") {
  const Program program =
      read_tp_statements("L P[1] 9mm/sec CNT100 ;\nL P[2] 9mm/sec CNT100 ;\n",
                         tp_position(1, {0, 0, 0, 90, 0, 90}) + tp_position(2, {1, 0, 0, 30, 90, 0}));
  // Rz(90) Rx(90): X goes to Y, Y to Z, Z to X.
  const Matrix3 R = tp_rotation_at_end(program, 0);
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-12);
  CHECK((R * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-12);
  CHECK((R * Vector3::UnitZ() - Vector3::UnitX()).norm() < 1e-12);
  // Ry(90) Rx(30): X goes to -Z; Z turns by 30 degrees about X first: (0, -1/2, sqrt(3)/2), then Z goes to X.
  const Matrix3 G = tp_rotation_at_end(program, 1);
  CHECK((G * Vector3::UnitX() + Vector3::UnitZ()).norm() < 1e-12);
  CHECK((G * Vector3::UnitZ() - Vector3(std::sqrt(3.0) / 2, -0.5, 0)).norm() < 1e-12);
}

TEST_CASE("the tool turns the shorter way from 179.999 to -179.999 degrees, and through P = 90") {
  const Program program = read_tp_statements(
      "L P[1] 9mm/sec CNT100 ;\nL P[2] 9mm/sec CNT100 ;\nL P[3] 9mm/sec CNT100 ;\nL P[4] 9mm/sec CNT100 ;\n",
      tp_position(1, {0, 0, 0, 179.999, 0, 0}) + tp_position(2, {1, 0, 0, -179.999, 0, 0}) +
          tp_position(3, {2, 0, 0, 0, 80, 0}) + tp_position(4, {3, 0, 0, 180, 80, 180}));
  const auto turned = [&](std::size_t move) {
    const Turn turn = turn_of(*program.moves[move].orientation);
    return rotation_between(turn.end, turn.start).norm();
  };
  CHECK(turned(1) == doctest::Approx(0.002 * deg));
  // Rz(180) Ry(80) Rx(180) = Ry(100): 20 degrees behind Ry(80).
  CHECK(turned(3) == doctest::Approx(20 * deg));
  const Matrix3 middle =
      rotation_of(OrientationForm::fixed_axes, numbers_at(*program.moves[3].orientation, 0.5));
  CHECK((middle * Vector3::UnitX() + Vector3::UnitZ()).norm() < 1e-9);  // Ry(90)
}

TEST_CASE("C goes through its auxiliary point, also in a continuation line") {
  const std::string positions = tp_position(1, {0, 0, 0, 0, 0, 0}) + tp_position(2, {10, 10, 0, 0, 0, 0}) +
                                tp_position(3, {20, 0, 0, 0, 0, 0}) + tp_position(4, {20, 0, 0, 0, 0, 90});
  for (const char* statement :
       {"C P[2]    \n:  P[3] 50mm/sec CNT80    ;\n", "C P[2] P[3] 50mm/sec CNT80 ;\n"}) {
    const Program program = read_tp_statements(
        std::string("L P[1] 9mm/sec CNT10 ;\n") + statement + "L P[1] 9mm/sec CNT10 ;\n", positions);
    REQUIRE(program.moves.size() == 3);
    const Move& arc = program.moves[1];
    REQUIRE(arc.arc);
    CHECK((arc.arc->centre_mm - Vector3(10, 0, 0)).norm() < 1e-9);
    CHECK(arc.end_mm == Vector3(20, 0, 0));
    CHECK(arc.feed_mm_min == doctest::Approx(3000));
    CHECK(arc.may_split);
    CHECK(program.moves[2].line == (std::string(statement).find("\n:") < 20 ? 9 : 8));
  }
  const Program turning =
      read_tp_statements("L P[1] 9mm/sec CNT10 ;\nC P[2] P[4] 50mm/sec CNT80 ;\n", positions);
  CHECK(!turning.moves[1].arc);  // the tool would turn by 90 degrees, but not at the auxiliary point
  CHECK(turning.left_alone[0].why ==
        "the orientation at the auxiliary point of C is not on the turn to its end");
  CHECK(
      tp_refusal("C P[2] 50mm/sec FINE ;\n", positions).starts_with("job.ls:6:6: error: C has no end point"));
}

TEST_CASE("other layouts of a position: no blanks, other decimals, two groups, a comment, joint angles") {
  const Program program = read_tp_statements(
      "UFRAME_NUM=1 ;\nL P[1:A B] 9mm/sec CNT10 ;\nL P[2]9mm/sec CNT10 ;\nL P[ 3 ] 9mm/sec CNT10 ;\n"
      "J P[4] 10% FINE ;\n",
      "P[1:\"A B\"]{\r\n   GP1:\r\n UF:1,UT:2,CONFIG:'N U T, 0, 0, 0',X=1mm,Y=-.5mm,Z=+3. "
      "mm,W=0deg,P=0deg,R=0deg\r\n};\r\n"
      "P[2] { GP1: UF : F, UT : F, CONFIG: 'NUT000', X =\t4.0\tmm, Y = 5 mm, Z = 6 mm,\n"
      " W = 0 deg, P = -0.000 deg, R = 0 deg, E1= 12.5 mm\n  GP2:\n UF : 1, UT : 2,\n J1 = 0.0 deg, J2 = 0.0 "
      "deg\n};\n"
      "P[3]{GP1: UF : F, UT : 2, CONFIG : 'F U T, 0, 0, 0', X = 7 mm, Y = 8 mm, Z = 9 mm, W = 0 deg, P = 0 "
      "deg, R = 0 deg};\n"
      "P[4]{\n   GP1:\n\tUF : 1, UT : 2,\n\tJ1= 0.000 deg, J2= 0.000 deg, J3= 0 deg,\n\tJ4= 0 deg, J5= -90 "
      "deg, J6= 0 deg,\n\tE1= 3 mm\n};\n");
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[0].end_mm == Vector3(1, -0.5, 3));
  CHECK(program.moves[1].end_mm == Vector3(4, 5, 6));
  CHECK(program.moves[2].end_mm == Vector3(7, 8, 9));
  CHECK(!program.moves[2].may_split);  // another configuration
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 10);
  CHECK(program.left_alone[0].why == "the target P[4] is in joint angles");
  CHECK(program.left_alone[0].machine_position);
}

TEST_CASE("external axes and a second group that move are noted with the line") {
  const auto moved = [](const std::string& first, const std::string& second) {
    const Program program = read_tp_statements(
        "L P[1] 9mm/sec FINE ;\nL P[2] 9mm/sec FINE ;\n",
        tp_position(1, {0, 0, 0, 0, 0, 0}, first) + tp_position(2, {1, 0, 0, 0, 0, 0}, second));
    return program.external_axes_move ? program.external_axes_move->line : 0;
  };
  CHECK(moved(",\n\tE1= 850.0 mm", ",\n\tE1= 850.000 mm") == 0);
  CHECK(moved(",\n\tE1= 850.0 mm", ",\n\tE1= 851.0 mm") == 7);
  const std::string still = "\n   GP2:\n\tUF : 1, UT : 1,\n\tJ1= 0.0 deg,\tJ2= 5.0 deg";
  CHECK(moved(still, still) == 0);
  CHECK(moved(still, "\n   GP2:\n\tUF : 1, UT : 1,\n\tJ1= 0.0 deg,\tJ2= 6.0 deg") == 7);
}

TEST_CASE("UF 0 is the world frame, and a frame that the program sets with numbers has their place") {
  const std::string positions = tp_position(1, {0, 0, 0, 0, 0, 0}, "", "UF : 0, UT : 1") +
                                tp_position(2, {1, 0, 0, 0, 0, 0}, "", "UF : 9, UT : 1");
  const Program program = read_tp_statements(
      "PR[9,1]=100 ;\nPR[9,2]=(-5.5) ;\nPR[9,3]=0 ;\nPR[9,4]=0 ;\nPR[9,5]=0 ;\nPR[9,6]=90 ;\n"
      "UFRAME[9]=PR[9] ;\nL P[1] 9mm/sec FINE ;\nUFRAME_NUM=9 ;\nL P[2] 9mm/sec FINE ;\n",
      positions);
  REQUIRE(program.moves.size() == 2);
  const ProgramFrame &world = program.frames[program.moves[0].frame],
                     &own = program.frames[program.moves[1].frame];
  CHECK(world.work_offset == "UF 0");
  CHECK(world.pose_mm->p == Vector3(0, 0, 0));
  CHECK(own.work_offset == "UF 9");
  REQUIRE(own.pose_mm);
  CHECK((*own.pose_mm * Vector3(1, 0, 0) - Vector3(100, -4.5, 0)).norm() < 1e-12);
  CHECK(!program.moves[1].known_start[0]);  // another frame
}

TEST_CASE("a frame that the program may set at run time is not followed") {
  const std::string positions = tp_position(1, {0, 0, 0, 0, 0, 0}, "", "UF : 8, UT : 1") +
                                tp_position(2, {1, 0, 0, 0, 0, 0}, "", "UF : 9, UT : 1");
  const std::string set =
      "PR[9,1]=100 ;\nPR[9,2]=0 ;\nPR[9,3]=0 ;\nPR[9,4]=0 ;\nPR[9,5]=0 ;\nPR[9,6]=90 ;\n"
      "UFRAME[9]=PR[9] ;\n";
  const auto read = [&](const std::string& statements, const std::string& behind = "") {
    return read_tp_statements(statements + "L P[1] 9mm/sec FINE ;\nL P[2] 9mm/sec FINE ;\n" + behind,
                              positions);
  };
  for (const char* statement :
       {"UFRAME[9]=PR[3] ;\n", "UFRAME[9]=UFRAME[1] ;\n", "IF R[1]=2,UFRAME[9]=PR[9] ;\n",
        "IF (R[1]=2) THEN ;\nUFRAME[9]=PR[9] ;\nENDIF ;\n", "CALL SETUF(9,1) ;\n",
        "PR[9]=LPOS ;\nUFRAME[9]=PR[9] ;\n", "RUN SETUF ;\n", "IF R[1]=2,RUN SETUF ;\n",
        "IF (DI[1]),SETUF ;\n", "MONITOR SETUF ;\n"}) {
    CAPTURE(statement);
    const Program program = read(set + statement);
    CHECK(!program.moves[0].fixed[0]);  // of another frame
    CHECK(program.moves[1].fixed[0]);
    CHECK(program.left_alone.back().why.starts_with("UFRAME[9] may be set at run time in line 1"));
  }
  for (const char* statement : {"UFRAME[R[1]]=PR[9] ;\n", "$MNUFRAME[1,R[1]]=PR[9] ;\n"}) {
    CAPTURE(statement);
    const Program program = read(set + statement);
    CHECK(program.moves[0].fixed[0]);
    CHECK(program.left_alone.back().why == "UFRAME[9] may be set at run time in line 13");
  }
  for (const char* action : {"TB .50sec,CALL SETUF(9,1)", "TA 1sec,CALL SETUF", "DB 10mm,SETUF"}) {
    CAPTURE(action);
    const Program program = read(set + "L P[2] 9mm/sec FINE " + action + " ;\n");
    CHECK(!program.moves[0].fixed[0]);
    CHECK(program.moves[2].fixed[0]);
    CHECK(program.left_alone.back().why == "UFRAME[9] may be set at run time in line 13");
  }
  CHECK(!read(set + "L P[2] 9mm/sec FINE TB .50sec,DO[1]=ON ;\n").moves[2].fixed[0]);
  CHECK(!read(set + "UFRAME[8]=PR[1] ;\n").moves[1].fixed[0]);
  CHECK(!read(set + "PR[1]=UFRAME[9] ;\nR[1]=1 ;\n").moves[1].fixed[0]);
  CHECK(!read("CALL GRIP ;\n" + set).moves[1].fixed[0]);
  // A jump may lead to the label from behind the assignment, or from before it.
  CHECK(!read(set + "LBL[1] ;\n", "JMP LBL[1] ;\n").moves[1].fixed[0]);
  CHECK(read(set + "LBL[1] ;\n", "UFRAME[9]=PR[2] ;\nJMP LBL[1] ;\n").moves[1].fixed[0]);
  CHECK(read(set + "LBL[1] ;\n", "CALL SETUF ;\nJMP LBL[1] ;\n").moves[1].fixed[0]);
  CHECK(read(set + "LBL[1] ;\n", "J P[2] 9% FINE TB .50sec,CALL SETUF ;\nJMP LBL[1] ;\n").moves[1].fixed[0]);
  CHECK(read("LBL[1] ;\n", "IF R[1]=2,UFRAME[9]=PR[2] ;\nJMP LBL[1] ;\n").moves[1].fixed[0]);
  CHECK(read("LBL[1] ;\n", "UFRAME[R[2]]=PR[2] ;\nJMP LBL[1] ;\n").moves[0].fixed[0]);
  CHECK(read("IF R[1]=3,JMP LBL[1] ;\n" + set + "LBL[1] ;\n").moves[1].fixed[0]);
  CHECK(!read("IF R[1]=3,JMP LBL[1] ;\n" + set).moves[1].fixed[0]);
}

TEST_CASE("a tool that the program sets under a condition makes the position unknown") {
  const Program program =
      read_tp_statements("L P[1] 9mm/sec CNT50 ;\nIF R[1]=2,UTOOL[2]=PR[2] ;\nL P[2] 9mm/sec CNT50 ;\n");
  CHECK(!program.moves[1].known_start[0]);
}

TEST_CASE(
    "UF F is the selected frame: the world frame before any selection, else not followed where unknown") {
  const std::string positions = tp_position(1, {0, 0, 0, 0, 0, 0}, "", "UF : 1, UT : 1") +
                                tp_position(2, {1, 0, 0, 0, 0, 0}, "", "UF : F, UT : F") +
                                tp_position(3, {2, 2, 0, 0, 0, 0}, "", "UF : F, UT : F");
  const auto frame_of = [&](const std::string& before) -> std::string {
    const Program program = read_tp_statements(
        before + "J P[2] 9% FINE ;\nL P[2] 9mm/sec FINE ;\nC P[3] P[2] 9mm/sec FINE ;\n", positions);
    if (program.moves.front().motion == Motion::rapid)
      return "'" + program.frames[program.moves.front().frame].work_offset + "'";
    CHECK(program.moves.back().fixed[0]);
    return program.left_alone.back().why;
  };
  const std::string unknown =
      "UF : F is the selected frame, which is not known; program UFRAME_NUM=1 or another number before the "
      "motion, behind calls and labels";
  CHECK(frame_of("") == "''");
  CHECK(frame_of("R[1]=2 ;\n") == "''");
  CHECK(frame_of("UFRAME_NUM=3 ;\n") == "'UF 3'");
  CHECK(frame_of("CALL GRIP ;\nUFRAME_NUM=3 ;\n") == "'UF 3'");
  for (const char* before :
       {"CALL GRIP ;\n", "UFRAME_NUM=R[1] ;\n", "LBL[1] ;\n", "UFRAME_NUM=3 ;\nLBL[1] ;\n",
        "UFRAME_NUM=3 ;\nIF R[1]=2,UFRAME_NUM=1 ;\n", "UFRAME_NUM=3 ;\nGRIP ;\n",
        "UFRAME_NUM=3 ;\nRUN GRIP ;\n", "UFRAME_NUM=3 ;\n$MNUFRAMENUM[1]=2 ;\n"}) {
    CAPTURE(before);
    CHECK(frame_of(before) == unknown);
  }
  // The control stops at P[1] unless another frame than the world frame is selected.
  const Program numbered = read_tp_statements("J P[1] 9% FINE ;\nL P[2] 9mm/sec FINE ;\n", positions);
  CHECK(numbered.moves[1].fixed[0]);
  CHECK(numbered.left_alone.back().why == unknown);
}

TEST_CASE("the positions behind a label, a call and in a loop are not known") {
  const std::string line = "L P[2] 9mm/sec CNT50 ;\n";
  for (const char* before :
       {"LBL[1] ;\n", "RUN GRIP ;\n", "CALL GRIP ;\n", "CALL GRIP(1,R[2]) ;\n", "OPEN_HAND ;\n",
        "IF DI[1]=ON,CALL GRIP ;\n", "SELECT R[1]=1,CALL A ;\n       =2,JMP LBL[1] ;\n"}) {
    CAPTURE(before);
    const Program program = read_tp_statements("L P[1] 9mm/sec CNT50 ;\n" + std::string(before) + line);
    CHECK(!program.moves[1].known_start[0]);
    CHECK(all_known(program.moves[1].known_end));
    if (std::string_view(before).starts_with("LBL")) continue;
    CHECK(program.left_alone.back().feeds);
    REQUIRE(program.remarks.size() == 1);
    CHECK(program.remarks[0].what.starts_with(
        "assumed from here on: called programs do not change the numbers of user frames and tools"));
  }
  for (const char* before :
       {"WAIT   1.00(sec) ;\n", "DO[1]=ON ;\n", "R[1]=R[1]+1 ;\n", "JMP LBL[1] ;\n",
        "IF R[1]=1,JMP LBL[2] ;\n", "IF R[1:CALLS]=1,R[2]=5 ;\n", "Arc Start[1] ;\n", "PAYLOAD[1] ;\n",
        "$MNUFRAMENUM[1]=1 ;\n", "--eg:a remark ;\n", ": DO[2]=ON;\n"}) {
    CAPTURE(before);
    const Program program = read_tp_statements("L P[1] 9mm/sec CNT50 ;\n" + std::string(before) + line);
    CHECK(all_known(program.moves[1].known_start));
  }
  const Program loop =
      read_tp_statements("L P[1] 9mm/sec CNT50 ;\nFOR R[1]=1 TO 5 ;\n" + line +
                         "J P[1] 10% FINE ;\nENDFOR ;\nIF (R[1]=1) THEN ;\nELSE ;\nENDIF ;\n" + line);
  REQUIRE(loop.moves.size() == 3);
  CHECK(loop.moves[1].fixed[0]);
  CHECK(!loop.moves[2].known_start[0]);
  CHECK(!loop.moves[2].fixed[0]);
  CHECK(loop.left_alone[0].why == "a loop or a condition may run the statement never or several times");
}

TEST_CASE("a motion with a word that acts at its end or gives its time is not split") {
  for (const char* words :
       {"5.0sec CNT50", "500msec CNT50", "9mm/sec CNT50 TB .50sec,CALL GRIP", "9mm/sec FINE", "9mm/sec CR0",
        "9mm/sec CNT50 DB 10mm,DO[1]=ON", "9mm/sec CNT50 Arc End[1]", "R[3]sec CNT50"}) {
    CAPTURE(words);
    const Program program =
        read_tp_statements("L P[1] 9mm/sec CNT50 ;\nL P[2] " + std::string(words) + " ;\n");
    CHECK(all_known(program.moves[1].known_start));
    CHECK(!program.moves[1].may_split);
    CHECK(!program.moves[1].may_jump);
  }
  for (const char* words : {"9mm/sec CNT50 ACC 80", "9mm/sec CNT R[2] PTH", "9 mm/sec CNT50 EV50%",
                            "R[3]mm/sec CNT50", "WELD_SPEED CNT100 PTH", "30deg/sec CNT50", "9mm/sec CD20",
                            "9mm/sec CR5 ACC80", "9mm/sec CNT100 CR5", "9mm/sec cnt50"}) {
    CAPTURE(words);
    const Program program =
        read_tp_statements("L P[1] 9mm/sec CNT50 ;\nL P[2] " + std::string(words) + " ;\n");
    CHECK(program.moves[1].may_split);
    CHECK(program.left_alone.empty());
  }
  const Program unknown = read_tp_statements("L P[1] 9mm/sec CNT50 ;\nL P[2] 9mm/sec CNT50 FROB[1] ;\n");
  CHECK(unknown.moves[1].fixed[0]);
  CHECK(unknown.left_alone[0].why == "the word 'FROB[1]' is not supported");
}

TEST_CASE("a position without '{' is refused with its place") {
  std::string positions = tp_square();
  positions.erase(positions.find("P[3]{") + 4, 1);
  CHECK(tp_refusal("L P[3] 9mm/sec CNT10 ;\n", positions) ==
        "job.ls:20:1: error: the position has no '{' before its '}'; write P[1]{ ... };");
}
