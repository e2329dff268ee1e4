// Programs of ABB robots: reading.
#include <doctest/doctest.h>

#include "program/robot/rapid/rapid.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string milling_job =
    "MODULE Job\n"
    "  PERS tooldata spindle := [TRUE,[[0,0,200],[1,0,0,0]],[5,[0,0,1],[1,0,0,0],0,0,0]];\n"
    "  TASK PERS wobjdata "
    "table:=[FALSE,TRUE,\"\",[[100,0,0],[0.70710678,0,0,0.70710678]],[[0,5,0],[1,0,0,0]]];\n"
    "  VAR speeddata slow := [12.5, 500, 5000, 1000];\n"
    "  CONST zonedata stop := [TRUE,0,0,0,0,0,0];\n"
    "PROC main()\n"
    "  ! -- POCKET\n"
    "  MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, z5, tool0;\n"
    "  MoveJ [[10,20,30],[0,0.6,0.8,0],[-1,0,1,4],[850,9E+09,9E9,9E9,9E9,9E9]], v1000, z10, "
    "spindle\\WObj:=table;\n"
    "  MoveL "
    "[[10.0,20,-1.5],[0,0.6,0.8,0],[-1,0,1,4],[850,9E9,9E9,9E9,9E9,9E9]],v100,z1,Spindle\\WObj:=Table; ! "
    "down\n"
    "  movel [[60,+20.,-.5E+0],[1,0,0,0],[-1,0,1,4],[850,9E9,9E9,9E9,9E9,9E9]], slow, fine, spindle \\WObj "
    ":= table ;\n"
    "ENDPROC\n"
    "ENDMODULE\n";

}  // namespace

TEST_CASE("a UTF-8 byte order mark before MODULE hides no declaration") {
  const std::string job =
      "MODULE Job\n"
      "  CONST robtarget p1:=[[0,0,60],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "PROC main()\n"
      "  MoveL p1,v20,fine,tool1;\n"
      "ENDPROC\n"
      "ENDMODULE\n";
  for (const std::string& text : {job, "\xEF\xBB\xBF" + job}) {
    const Program program = read_rapid(text);
    CHECK(program.left_alone.empty());
    REQUIRE(program.moves.size() == 1);
    CHECK(program.moves[0].end_mm == Vector3(0, 0, 60));
  }
}

TEST_CASE(
    "the place of MoveAbsJ is known with NoEOffs, too, which only leaves out offsets of external axes") {
  ReadOptions options;
  options.kinematics = [](const JointPlace& place, std::int32_t, const ProgramFrame&) {
    CHECK(place.external[0] == 850);
    return std::optional(Pose{Matrix3::Identity(), Vector3(1, 2, 3)});
  };
  for (const std::string option : {"", "\\NoEOffs"}) {
    CAPTURE(option);
    const std::string start = "MoveAbsJ [[0,0,0,0,30,0],[850,9E9,9E9,9E9,9E9,9E9]]" + option;
    const std::string target = "[[10,20,30],[1,0,0,0],[0,0,0,0],[850,9E9,9E9,9E9,9E9,9E9]]";
    const Program program =
        read_program(module_of("", start + ",v100,fine,tool0;\nMoveL " + target + ",v100,fine,tool0;\n"),
                     "job.mod", options);
    REQUIRE(program.moves.size() == 1);
    CHECK(program.moves[0].starts_uncorrected);
    CHECK(program.moves[0].start_mm == Vector3(1, 2, 3));
  }
}

TEST_CASE("the targets of MoveL and MoveJ are read with their quaternions, frames, feeds and zones") {
  const Program program = read_rapid(milling_job);
  CHECK(program.dialect == "abb");
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 8);
  CHECK(program.left_alone[0].machine_position);
  const Move &rapid = program.moves[0], &down = program.moves[1], &across = program.moves[2];
  CHECK(rapid.motion == Motion::rapid);
  CHECK(rapid.line == 9);
  CHECK(!rapid.known_start[0]);
  CHECK(all_known(rapid.known_end));
  CHECK(!rapid.may_split);
  CHECK(!rapid.may_jump);
  CHECK(down.motion == Motion::feed);
  CHECK(down.start_mm == Vector3(10, 20, 30));
  CHECK(down.end_mm == Vector3(10, 20, -1.5));
  CHECK(down.feed_mm_min == 6000);
  CHECK(down.may_split);
  CHECK(down.may_jump);
  CHECK(!down.exact_stop);
  CHECK(program.operations[down.operation] == "POCKET");
  CHECK(across.end_mm == Vector3(60, 20, -0.5));
  CHECK(across.feed_mm_min == 750);
  CHECK(across.exact_stop);
  CHECK(!across.may_split);
  CHECK(across.frame == down.frame);
  CHECK(across.orientation->form == OrientationForm::quaternion);
  CHECK(!across.orientation->by_angles);
  CHECK(across.orientation->start == OrientationNumbers{0, 0.6, 0.8, 0});
  CHECK(across.orientation->end == OrientationNumbers{1, 0, 0, 0});
  const ProgramFrame& frame = program.frames[across.frame];
  CHECK(frame.work_offset == "table");
  REQUIRE(frame.pose_mm.has_value());
  // The object frame is 5 mm along Y of the user frame, which is turned by 90 degrees about Z.
  CHECK((frame.pose_mm->p - Vector3(95, 0, 0)).norm() < 1e-9);
  CHECK((*frame.pose_mm * Vector3(1, 0, 0) - Vector3(95, 1, 0)).norm() < 1e-9);
}

TEST_CASE("q1 of a RAPID quaternion is w, then x, y and z") {
  // 90 degrees about X: Y goes to Z.
  const Program program = read_routine(
      "MoveL [[1,2,3],[0.70710678,0.70710678,0,0],[0,0,0,0],"
      "[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\n");
  const Matrix3 R = turn_of(*program.moves[0].orientation).end;
  CHECK((R * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-7);
  CHECK((R * Vector3::UnitX() - Vector3::UnitX()).norm() < 1e-7);
}

TEST_CASE("named targets are found before and after their use, in the routine first") {
  const Program program = read_rapid(
      "MODULE a\n"
      "CONST robtarget p1:=" +
      target_at("1,2,3") +
      ";\n"
      "PROC one()\n"
      "MoveJ P1,v100,fine,tool0;\n"
      "MoveL p2,v100,z1,tool0;\n"
      "MoveL p1,v100,z1,tool0;\n"
      "ENDPROC\n"
      "PROC two(robtarget p2)\n"
      "VAR robtarget p1:=" +
      target_at("7,8,9") +
      ";\n"
      "MoveL p1,v100,z1,tool0;\n"
      "MoveL p2,v100,z1,tool0;\n"
      "ENDPROC\n"
      "PROC three()\n"
      "MoveL p1,v100,z1,tool0;\n"
      "ENDPROC\n"
      "LOCAL PERS robtarget p2:=" +
      target_at("4,5,6") +
      ";\n"
      "ENDMODULE\n");
  REQUIRE(program.moves.size() == 6);
  CHECK(program.moves[0].end_mm == Vector3(1, 2, 3));
  CHECK(program.moves[1].end_mm == Vector3(4, 5, 6));
  CHECK(program.moves[2].start_mm == Vector3(4, 5, 6));
  CHECK(all_known(program.moves[2].known_start));
  CHECK(program.moves[3].end_mm == Vector3(7, 8, 9));
  CHECK(!program.moves[3].known_start[0]);  // the robot may be anywhere at the begin of a routine
  CHECK(program.moves[4].fixed[0]);
  CHECK(program.moves[5].end_mm == Vector3(1, 2, 3));
  CHECK(!program.moves[5].known_start[0]);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].why == "the target 'p2' is a parameter of the routine");
}

TEST_CASE("declarations may continue in further lines, and a line may have several statements") {
  const Program program = read_rapid(
      "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n"
      "MODULE a(SYSMODULE,\n  NOSTEPIN)\n"
      "RECORD pair\n num x; num y;\nENDRECORD\n"
      "CONST robtarget p1:=[[1, ! x; of the corner\n 2,3],[1,0,0,0],\n "
      "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "VAR num i; VAR string s := \"MoveL ! ; \";\n"
      "PROC main() i := 1; TPWrite \"a;\";; SetDO do1, 1;\n"
      "MoveJ p1,v100,fine,tool0;\n"
      "ENDPROC ENDMODULE\n");
  REQUIRE(program.moves.size() == 1);
  CHECK(program.moves[0].line == 15);
  CHECK(program.moves[0].end_mm == Vector3(1, 2, 3));
  CHECK(program.left_alone.empty());
}

TEST_CASE("speeds and zones are predefined, declared, inline or unknown") {
  const auto feed_of = [](const std::string& speed) {
    const Program program =
        read_routine("MoveL <0,0,0>," + speed + ",z1,tool0;\n",
                     "VAR speeddata quick:=[2000,500,5000,1000];\nVAR speeddata made;\nVAR num k;\n");
    return program.moves[0].feed_mm_min;
  };
  CHECK(feed_of("v5") == 300);
  CHECK(feed_of("V7000") == 420000);
  CHECK(feed_of("v123") == 0);
  CHECK(feed_of("vmax") == 0);
  CHECK(feed_of("quick") == 120000);
  CHECK(feed_of("made") == 0);
  CHECK(feed_of("[7.5,1,1,1]") == 450);
  CHECK(feed_of("[k,1,1,1]") == 0);
  CHECK(feed_of("v100\\V:=20.5") == 1230);
  CHECK(feed_of("v100\\V:=k") == 0);
  CHECK(feed_of("v100\\T:=2") == 0);
  const auto passes = [](const std::string& zone) {
    const Program program = read_routine(
        "MoveJ <0,0,0>,v10,z1,tool0;\nMoveL <5,0,0>,v10," + zone + ",tool0;\n",
        "CONST zonedata own:=[FALSE,2,3,3,.3,3,.3];\nCONST zonedata stop:=[TRUE,2,3,3,.3,3,.3];\n");
    CHECK(program.moves[1].exact_stop == !program.moves[1].may_split);
    return !program.moves[1].exact_stop;
  };
  for (const char* zone : {"z0", "Z1", "z200", "own", "[FALSE,2,3,3,.3,3,.3]"}) CHECK(passes(zone));
  for (const char* zone : {"fine", "z2", "other", "stop", "[TRUE,2,3,3,.3,3,.3]", "z10\\Inpos:=inpos50"})
    CHECK(!passes(zone));
}

TEST_CASE("copies of a statement with a time, an ID, \\Conc or a moving external axis are not inserted") {
  const auto may_split = [](const std::string& before, const std::string& speed, const std::string& zone) {
    const Program program = read_routine("MoveJ <0,0,0>,v10,z1,tool0;\nMoveL " + before + "<5,0,0>" + speed +
                                         "," + zone + ",tool0;\n");
    CHECK(program.moves[1].may_jump == program.moves[1].may_split);
    return program.moves[1].may_split;
  };
  CHECK(may_split("", ",v10", "z10"));
  CHECK(!may_split("", ",v10\\T:=5", "z10"));
  CHECK(!may_split("", "\\ID:=10,v10", "z10"));
  CHECK(!may_split("\\Conc,", ",v10", "z10"));
  CHECK(!may_split("", ",v10", "z10\\Z:=4"));
  const Program program = read_routine(
      "MoveJ <0,0,0>,v10,z1,tool0;\n"
      "MoveL [[5,0,0],[1,0,0,0],[0,-1,0,1],[0.5,9E9,9E9,9E9,9E9,9E9]],v10,z10,tool0;\n"
      "MoveL [[9,0,0],[1,0,0,0],[0,-1,0,1],[0.5,9E9,9E9,9E9,9E9,9E9]],v10,z10,tool0;\n");
  CHECK(!program.moves[1].may_split);
  CHECK(program.moves[2].may_split);
}

TEST_CASE(
    "copies of a statement are not inserted where the configuration changes, unless ConfL\\Off allows it") {
  const auto may_split = [](const std::string& mode, const std::string& configuration) {
    const Program program = read_routine(mode + "MoveJ <0,0,0>,v10,z1,tool0;\nMoveL [[5,0,0],[1,0,0,0],[" +
                                         configuration + "],[0,9E9,9E9,9E9,9E9,9E9]],v10,z10,tool0;\n");
    CHECK(program.moves[1].may_jump == program.moves[1].may_split);
    return program.moves[1].may_split;
  };
  CHECK(may_split("", "0, -1, 0, 1"));
  CHECK(!may_split("", "0,-1,1,1"));
  CHECK(may_split("ConfL\\Off;\n", "0,-1,1,1"));
  CHECK(!may_split("ConfL\\Off;\nConfL \\On;\n", "0,-1,1,1"));
  CHECK(!may_split("IF a=1 ConfL\\Off;\n", "0,-1,1,1"));
  CHECK(!may_split("ConfL\\Off;\nprepare;\n", "0,-1,1,1"));
}

TEST_CASE("another tool or work object makes the position unknown") {
  const Program program = read_routine(
      "MoveJ <0,0,0>,v10,z1,t1;\n"
      "MoveL <1,0,0>,v10,z1,T1\\WObj:=WObj0;\n"
      "MoveL <2,0,0>,v10,z1,t2;\n"
      "MoveL <3,0,0>,v10,z1,t2\\WObj:=other;\n"
      "MoveL <4,0,0>,v10,z1,t2\\WObj:=OTHER;\n");
  CHECK(all_known(program.moves[1].known_start));
  CHECK(!program.moves[2].known_start[0]);
  CHECK(!program.moves[3].known_start[0]);
  CHECK(all_known(program.moves[4].known_start));
  CHECK(program.frames[program.moves[0].frame].work_offset == "wobj0");
  CHECK(program.frames[program.moves[0].frame].pose_mm == Pose{});
  CHECK(program.frames[program.moves[4].frame].work_offset == "other");
  CHECK(!program.frames[program.moves[4].frame].pose_mm);
}

TEST_CASE("MoveC is an arc through its point where the tool does not turn with the path") {
  const auto read_arc = [](const std::string& before, const std::string& statement) {
    return read_routine(before + "MoveJ <0,0,0>,v100,fine,tool0;\n" + statement);
  };
  const Program program = read_arc("", "MoveC <3,3,4>,<6,0,8>,v100,z1,tool0;\n");
  const Move& circle = program.moves[1];
  REQUIRE(circle.arc.has_value());
  CHECK((circle.arc->centre_mm - Vector3(3, -8.0 / 3, 4)).norm() < 1e-12);
  CHECK(circle.may_split);
  CHECK(circle.feed_mm_min == 6000);
  // Half a turn about the normal, from X to Y: a tool that turns with the path or keeps its orientation.
  const std::string end = "[[0,20,0],[0.9238795,0,0,0.3826834],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]]";
  const std::string tilted = "[[0,20,0],[0.9238795,0.3826834,0,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]]";
  const auto followed = [&](const std::string& mode, const std::string& point, const std::string& target) {
    const Program p = read_arc(mode, "MoveC " + point + "," + target + ",v100,z1,tool0;\n");
    return p.moves[1].arc.has_value();
  };
  const auto point = [](const std::string& quaternion) {
    return "[[10,10,0],[" + quaternion + "],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]]";
  };
  const std::string half_way = point("0.9807853,0,0,0.1950903"), tilting = point("0.9807853,0.1950903,0,0");
  CHECK(followed("", half_way, end));
  CHECK(!followed("", "<10,10,0>", end));  // the point does not show the direction of the turn
  CHECK(followed("", "<10,10,0>", "<0,20,0>"));
  CHECK(followed("", "<10,10,0>", "<-10,10,0>"));
  CHECK(!followed("", "<0.5,0.01,0>", "<0,20,0>"));  // the point is too near to the start
  CHECK(!followed("", tilting, tilted));
  CHECK(followed("CirPathMode\\ObjectFrame;\n", tilting, tilted));
  CHECK(followed("CirPathMode \\PathFrame;\n", half_way, end));
  CHECK(!followed("CirPathMode\\Wrist45;\n", half_way, end));
  CHECK(!followed("IF a=1 CirPathMode\\ObjectFrame;\n", half_way, end));
  CHECK(!followed("", "<1,0,0>", "<2,0,0>"));  // on a line
}

TEST_CASE("Offs and RelTool with numbers displace a target") {
  const std::string turned = "[[10,20,30],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";  // Z downwards
  const Program program = read_routine(
      "MoveJ Offs(p1, 1, -2, .5),v100,fine,tool0;\n"
      "MoveL RelTool(p1,1,2,-3),v100,z1,tool0;\n"
      "MoveL offs(" +
          turned +
          ",0,0,1E1),v100,z1,tool0;\n"
          "MoveL Offs(p1,0,0,h),v100,z1,tool0;\n"
          "MoveL RelTool(p1,0,0,1\\Rz:=5),v100,z1,tool0;\n"
          "MoveL Offs(Offs(p1,0,0,1),0,0,1),v100,z1,tool0;\n",
      "VAR num h:=3;\nCONST robtarget p1:=" + turned + ";\n");
  REQUIRE(program.moves.size() == 6);
  CHECK(program.moves[0].end_mm == Vector3(11, 18, 30.5));
  CHECK((program.moves[1].end_mm - Vector3(11, 18, 33)).norm() < 1e-12);
  CHECK(program.moves[2].end_mm == Vector3(10, 20, 40));
  for (const std::size_t m : {3U, 4U, 5U}) CHECK(program.moves[m].fixed[0]);
  REQUIRE(program.left_alone.size() == 3);
  CHECK(program.left_alone[0].line == 8);
  CHECK(program.left_alone[0].why == "the displacement of Offs is computed at run time");
  CHECK(program.left_alone[1].why == "the displacement of RelTool is computed at run time");
  CHECK(program.left_alone[2].why == "the target is computed at run time");
}
