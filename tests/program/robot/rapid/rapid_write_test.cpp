// Programs of ABB robots: writing of corrected targets.
#include <doctest/doctest.h>

#include "program/robot/rapid/rapid.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string rest_of_target =
    ",[0,-1,0,1],[0,9E9,9E+09,9E9,9E9,9E9]]";  // of the targets of `with_targets`

/// The statements of a module as they are after `edits`, without its first lines and the last two.
std::string written_statements(const Program& program, const std::vector<MoveEdit>& edits) {
  const std::string text = rewrite(program, edits, {}).text;
  const std::size_t begin = text.find("PROC main()\n") + 12;
  return text.substr(begin, text.find("ENDPROC") - begin);
}

}  // namespace

TEST_CASE("an ABB program whose targets do not change keeps every byte") {
  for (const std::string end : {"\n", "\r\n"}) {
    std::string text = with_targets(
        module_of("\tVAR robtarget p1 := [[2.2E-14,+0,.5], [0,1,0,-9.18454765366783E-17], [0,0,0,0], "
                  "[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
                  "CONST robtarget p2:=[[1,\n 2,3],[0.707,0.707,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n",
                  "MoveJ p1, v1000, z50, tool0;\n"
                  "  movel\tOffs( p1 , 0.1 , 0.2 , 3 ),v50,fine,tool0 ; ! \xE9 comment\n"
                  "MoveL RelTool(p1,1,2,3),v50,z1,tool0;\n"
                  "MoveC <1,2,9>, p2,v50,z1,tool0;\n"
                  "MoveL p2,v50,z1,tool0;\n"));
    for (std::size_t at = 0; end == "\r\n" && (at = text.find('\n', at)) != std::string::npos; at += 2)
      text.insert(at, "\r");
    const Program program = read_rapid(text);
    REQUIRE(program.moves.size() == 5);
    CHECK(rewrite(program, unchanged_edits(program), {}).text == text);
  }
}

TEST_CASE("a quaternion of few digits stays where the unit quaternion is wanted") {
  const Program program = read_rapid(with_targets(module_of(
      "", "MoveJ [[1,2,3],[0.707107,0.5,-0.5,0.0005],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]],v1,z1,t;\n")));
  MoveEdit edit = unchanged_edit(program, 0);
  const double length = std::sqrt(0.707107 * 0.707107 + 0.5 + 0.0005 * 0.0005);
  for (double& number : *edit.orientation) number /= length;
  CHECK(rewrite(program, {edit}, {}).text == program.text);
  (*edit.orientation)[3] += 0.00001;
  const std::string text = rewrite(program, {edit}, {}).text;
  CHECK(text.find("[0.7071068,0.4999999,-0.4999999,0.00051]") != std::string::npos);
}

TEST_CASE("changed numbers keep their style, at least three digits of a length and seven of a quaternion") {
  const Program program = read_rapid(module_of(
      "",
      "MoveJ [[10,+20.0,30.25],[1,0,0,0],[0,-1,0,1],[850,9E9,9E+09,9E9,9E9,9E9]],v100,z10,t; ! down\n"
      "MoveL [[1.5E1 , .5, "
      "2.2E-14],[0,1,-9.1E-17,0],[0,-1,0,1],[850,9E9,9E+09,9E9,9E9,9E9]],v100,fine,t;\n"));
  MoveEdit rapid = unchanged_edit(program, 0), down = unchanged_edit(program, 1);
  rapid.end_mm = {10.0124, 20.01, 30.25};
  rapid.orientation = OrientationNumbers{0.99999999, 0.0001234, 0, -0.00002};
  down.end_mm = {15.02, 0.4964, 0.0126};
  down.orientation = OrientationNumbers{0, 0.9999987, 0.0016, 0.00000004};
  const Rewritten out = rewrite(program, {rapid, down}, {});
  CHECK(out.changed_words == 9);
  CHECK(out.text ==
        module_of(
            "",
            "MoveJ [[10.012,+20.01,30.25],[1,0.0001234,0,-0.00002],[0,-1,0,1],[850,9E9,9E+09,9E9,9E9,9E9]]"
            ",v100,z10,t; ! down\n"
            "MoveL [[15.02 , .496, 0.013],[0,0.9999987,0.0016,0],[0,-1,0,1],"
            "[850,9E9,9E+09,9E9,9E9,9E9]],v100,fine,t;\n"));
}

// Zones below z0.
const std::string tiny = "[FALSE,0.005,0.005,0.005,0.0005,0.005,0.0005]",
                  quarter = "[FALSE,0.25,0.25,0.25,0.025,0.25,0.025]";

TEST_CASE("inserted points are copies of the motion with smaller zones, without its comment") {
  const Program program =
      read_rapid(with_targets(module_of("CONST zonedata own:=[FALSE,12,18,18,1.8,18,1.8];\n",
                                        "MoveJ <0,0,0>,v1000,z100,t;\n"
                                        "  MoveL <40,0,0>, v50\\V:=12, Z50, t\\WObj:=wobj0; ! cut\n"
                                        "MoveL <60,0,0>,v50,own,t;\n"
                                        "MoveL <61,0,0>,v50,z0,t;\n"
                                        "MoveL <80,0,0>,v50,z1,t;\n")));
  std::vector<MoveEdit> edits = unchanged_edits(program);
  edits[1].inserted = {{{10, 0.02, 0}, {}, edits[1].orientation}, {{34, 0.01, 0}, {}, edits[1].orientation}};
  edits[2].jump = Via{{40, 0.01, 0}, {}, edits[1].orientation};
  edits[2].inserted = {{{50, 0, 0.01}, {}, edits[1].orientation}};
  edits[3].inserted = {{{60.5, 0, 0.01}, {}, edits[1].orientation}};
  edits[4].inserted = {{{70, 0, 0.01}, {}, OrientationNumbers{0.9999999, 0.0005, 0, 0}}};
  const Rewritten out = rewrite(program, edits, {});
  CHECK(out.inserted_blocks == 6);
  CHECK(out.blocks_of_edit == std::vector<std::size_t>{0, 2, 2, 1, 1});
  CHECK(written_statements(program, edits) ==
        with_targets("MoveJ <0,0,0>,v1000,z5,t;\n"
                     "  MoveL <10,0.02,0>, v50\\V:=12, z5, t\\WObj:=wobj0;\n"
                     "  MoveL <34,0.01,0>, v50\\V:=12, z1, t\\WObj:=wobj0;\n"
                     "  MoveL <40,0,0>, v50\\V:=12, " +
                     tiny +
                     ", t\\WObj:=wobj0; ! cut\n"
                     "MoveL <40,0.01,0>,v50," +
                     tiny +
                     ",t;\n"
                     "MoveL <50,0,0.01>,v50,z5,t;\n"
                     "MoveL <60,0,0>,v50," +
                     quarter +
                     ",t;\n"
                     "MoveL <60.5,0,0.01>,v50," +
                     quarter +
                     ",t;\n"
                     "MoveL <61,0,0>,v50," +
                     quarter +
                     ",t;\n"
                     "MoveL [[70,0,0.01],[0.9999999,0.0005,0,0]" +
                     rest_of_target +
                     ",v50,z1,t;\n"
                     "MoveL <80,0,0>,v50,z1,t;\n"));
}

TEST_CASE("a named target that all motions want alike is changed where it is declared") {
  const std::string declaration = "CONST robtarget corner := <10,20,30> ; ! of the part\n";
  const std::string statements =
      "MoveJ corner,v1000,z50,t;\nMoveL <40,0,0>,v50,z1,t;\nMoveL CORNER,v50,z1,t;\n";
  const Program program = read_rapid(with_targets(module_of(declaration, statements)));
  std::vector<MoveEdit> edits = unchanged_edits(program);
  edits[0].end_mm.x() = 10.0121;
  edits[2].end_mm.x() = 10.0118;  // the same to the written digit
  CHECK(rewrite(program, edits, {}).text ==
        with_targets(module_of("CONST robtarget corner := <10.012,20,30> ; ! of the part\n", statements)));
}

TEST_CASE("a named target whose motions want different numbers is written into them") {
  const std::string declaration = "CONST robtarget corner := <10,20,30>;\n";
  const std::string statements =
      "MoveJ corner,v1000,z50,t;\nMoveL <40,0,0>,v50,z1,t;\nMoveL CORNER,v50,z1,t\\WObj:=w;\n";
  const Program program = read_rapid(with_targets(module_of(declaration, statements)));
  std::vector<MoveEdit> edits = unchanged_edits(program);
  edits[0].end_mm.x() = 10.012;
  edits[2].end_mm.x() = 10.013;
  CHECK(rewrite(program, edits, {}).text ==
        with_targets(module_of(declaration,
                               "MoveJ <10.012,20,30>,v1000,z50,t;\nMoveL <40,0,0>,v50,z1,t;\n"
                               "MoveL <10.013,20,30>,v50,z1,t\\WObj:=w;\n")));
  // One motion is not corrected.
  edits[2].end_mm.x() = 10;
  const std::string once = with_targets(
      "MoveJ <10.012,20,30>,v1000,z50,t;\nMoveL <40,0,0>,v50,z1,t;\nMoveL CORNER,v50,z1,t\\WObj:=w;\n");
  CHECK(rewrite(program, edits, {}).text == with_targets(module_of(declaration, once)));
  edits.pop_back();
  CHECK(rewrite(program, edits, {}).text == with_targets(module_of(declaration, once)));
}

TEST_CASE("a declaration that other statements use is not changed") {
  const std::string declaration = "CONST robtarget p1:=<10,20,30>;\n";
  for (const std::string use :
       {"MoveL Offs(p1,0,0,h),v50,z1,t;\n", "x:=p1.trans.x;\n", "IF a MoveL p1,v50,z1,t;\n", "drill p1;\n",
        "MoveAbsJ CalcJointT(p1,t),v50,z1,t;\n"}) {
    const Program program = read_rapid(with_targets(module_of(declaration, "MoveJ p1,v50,z1,t;\n" + use)));
    MoveEdit edit = unchanged_edit(program, 0);
    edit.end_mm.z() = 30.02;
    CHECK(rewrite(program, {edit}, {}).text ==
          with_targets(module_of(declaration, "MoveJ <10,20,30.02>,v50,z1,t;\n" + use)));
  }
}

TEST_CASE("a target of a routine is not confused with one of the module") {
  const std::string text = with_targets(
      "MODULE a\nCONST robtarget p1:=<1,2,3>;\nPROC one()\nMoveJ p1,v50,z1,t;\nENDPROC\n"
      "PROC two()\nVAR robtarget p1:=<7,8,9>;\nMoveJ p1,v50,z1,t;\nENDPROC\nENDMODULE\n");
  const Program program = read_rapid(text);
  std::vector<MoveEdit> edits = unchanged_edits(program);
  edits[1].end_mm.x() = 7.01;
  CHECK(rewrite(program, edits, {}).text ==
        with_targets("MODULE a\nCONST robtarget p1:=<1,2,3>;\nPROC one()\nMoveJ p1,v50,z1,t;\nENDPROC\n"
                     "PROC two()\nVAR robtarget p1:=<7.01,8,9>;\nMoveJ p1,v50,z1,t;\nENDPROC\nENDMODULE\n"));
}

TEST_CASE("a declaration in several lines stays, its numbers are written into the motion in one line") {
  const std::string declaration =
      "CONST robtarget p1:=[[1, ! x;\n 2,3],[1,0,0,0],\n [0,-1,0,1],[0,9E9,9E+09,9E9,9E9,9E9]];\n";
  const Program program = read_rapid(module_of(declaration, "MoveJ p1,v50,z1,t;\n"));
  MoveEdit edit = unchanged_edit(program, 0);
  edit.end_mm.y() = 2.01;
  CHECK(rewrite(program, {edit}, {}).text ==
        module_of(declaration, "MoveJ " + target_at("1,2.01,3") + ",v50,z1,t;\n"));
}

TEST_CASE("copies of a motion to a named target have the numbers in its place") {
  const Program program = read_rapid(with_targets(
      module_of("CONST robtarget p1:=<10,20,30>;\n", "MoveJ <0,20,30>,v50,z1,t;\nMoveL p1,v50,z1,t;\n")));
  MoveEdit edit = unchanged_edit(program, 1);
  edit.inserted = {{{5, 20.01, 30}, {}, edit.orientation}};
  CHECK(written_statements(program, {edit}) ==
        with_targets("MoveJ <0,20,30>,v50,z1,t;\nMoveL <5,20.01,30>,v50,z1,t;\nMoveL p1,v50,z1,t;\n"));
  edit.end_mm.z() = 30.01;
  const std::string text = rewrite(program, {edit}, {}).text;
  CHECK(text == with_targets(module_of(
                    "CONST robtarget p1:=<10,20,30.01>;\n",
                    "MoveJ <0,20,30>,v50,z1,t;\nMoveL <5,20.01,30>,v50,z1,t;\nMoveL p1,v50,z1,t;\n")));
  // A point at the original place does not move with the declaration.
  edit.inserted = {{{10, 20, 30}, {}, edit.orientation}};
  CHECK(rewrite(program, {edit}, {}).text ==
        with_targets(module_of("CONST robtarget p1:=<10,20,30.01>;\n",
                               "MoveJ <0,20,30>,v50,z1,t;\nMoveL <10,20,30>,v50," + tiny +
                                   ",t;\nMoveL p1,v50," + tiny + ",t;\n")));
  // Nor does one that differs from the start in its orientation only.
  const Program turning = read_rapid(with_targets(
      module_of("CONST robtarget p1:=<10,20,30>;\n",
                "MoveJ " + target_at("10,20,30", "0,1,0,0") + ",v50,z1,t;\nMoveL p1,v50,z1,t;\n")));
  MoveEdit turn = unchanged_edit(turning, 1);
  turn.inserted = {{{10, 20, 30}, {}, turn.orientation}};
  turn.end_mm.z() = 30.01;
  CHECK(written_statements(turning, {turn}) ==
        with_targets("MoveJ " + target_at("10,20,30", "0,1,0,0") + ",v50," + tiny +
                     ",t;\nMoveL <10,20,30>,v50," + tiny + ",t;\nMoveL p1,v50," + tiny + ",t;\n"));
}

TEST_CASE("a corrected target of Offs or RelTool is written with all its numbers") {
  const std::string declaration = "CONST robtarget p1:=<10.1,20,30>;\n";
  const Program program = read_rapid(
      with_targets(module_of(declaration,
                             "MoveJ Offs(p1,0.2,0,5),v50,fine,t;\nMoveL Offs(p1,9.9,0,5),v50,z1,t;\n"
                             "MoveL RelTool(<50,0,0>,1,0,0),v50,z1,t;\n")));
  std::vector<MoveEdit> edits = unchanged_edits(program);
  edits[0].end_mm.y() = 20.01;
  edits[1].inserted = {{{15, 20, 35.01}, {}, edits[0].orientation}};
  edits[2].orientation = OrientationNumbers{0.9999999, 0.0005, 0, 0};
  CHECK(rewrite(program, edits, {}).text == with_targets(module_of(declaration,
                                                                   "MoveJ <10.3,20.01,35>,v50,fine,t;\n"
                                                                   "MoveL <15.0,20,35.01>,v50,z1,t;\n"
                                                                   "MoveL Offs(p1,9.9,0,5),v50,z1,t;\n"
                                                                   "MoveL [[51,0,0],[0.9999999,0.0005,0,0]" +
                                                                       rest_of_target + ",v50,z1,t;\n")));
}

TEST_CASE("a corrected MoveC is read back as the curve that was written, a named point is shared, too") {
  const std::string statements = "MoveJ <10,0,0>,v50,fine,t;\nMoveC top, <-10.0,0,0>,v50,z1,t;\n";
  const Program program =
      read_rapid(with_targets(module_of("CONST robtarget top:=<0,10.0,0>;\n", statements)));
  MoveEdit start = unchanged_edit(program, 0), circle = unchanged_edit(program, 1);
  start.end_mm = {10.02, 0.01, 0.005};
  circle.end_mm = {-9.99, 0.01, 0.031};
  circle.centre_mm = Vector3(0.015, 0.02, 0.005);
  const std::string text = rewrite(program, {start, circle}, {}).text;
  CHECK(text == with_targets(module_of("CONST robtarget top:=<0.015,10.025,0.018>;\n",
                                       "MoveJ <10.02,0.01,0.005>,v50,fine,t;\n"
                                       "MoveC top, <-9.99,0.01,0.031>,v50,z1,t;\n")));
  const Program back = read_rapid(text);
  TextPosition before;
  before[0] = 10.02, before[1] = 0.01, before[2] = 0.005;
  const Curve curve =
      as_written(program.moves[1], before, {circle.end_mm, circle.centre_mm, circle.orientation}, true, {});
  REQUIRE(curve.arc.has_value());
  CHECK((back.moves[1].arc->centre_mm - curve.arc->centre).norm() < 1e-9);
  CHECK((back.moves[1].end_mm - curve.end).norm() < 1e-9);
  // The point is the end of another motion: each motion gets its own.
  const Program shared = read_rapid(
      with_targets(module_of("CONST robtarget top:=<0,10.0,0>;\n", statements + "MoveL top,v50,z1,t;\n")));
  CHECK(rewrite(shared, {start, circle}, {}).text ==
        with_targets(module_of("CONST robtarget top:=<0,10.0,0>;\n",
                               "MoveJ <10.02,0.01,0.005>,v50,fine,t;\n"
                               "MoveC <0.015,10.025,0.018>, <-9.99,0.01,0.031>,v50,z1,t;\n"
                               "MoveL top,v50,z1,t;\n")));
}

TEST_CASE("a MoveC is split into arcs, or into lines where it has no centre") {
  const std::string declarations = "CONST robtarget top:=<0,10,0>;\nCONST robtarget left:=<-10,0,0>;\n";
  const Program program = read_rapid(with_targets(
      module_of(declarations, "MoveJ <10,0,0>,v50,fine,t;\nMoveC top,left,v50,z50,t; ! half\n")));
  MoveEdit circle = unchanged_edit(program, 1);
  circle.inserted = {{{0, 10, 0}, Vector3(0, 0, 0), circle.orientation}};
  CHECK(rewrite(program, {circle}, {}).text ==
        with_targets(module_of("CONST robtarget top:=<-7.071,7.071,0>;\nCONST robtarget left:=<-10,0,0>;\n",
                               "MoveJ <10,0,0>,v50,fine,t;\n"
                               "MoveC <7.071,7.071,0>,<0,10,0>,v50,z5,t;\n"
                               "MoveC top,left,v50,z5,t; ! half\n")));
  circle.centre_mm.reset();
  circle.inserted[0].centre_mm.reset();
  CHECK(rewrite(program, {circle}, {}).text == with_targets(module_of(declarations,
                                                                      "MoveJ <10,0,0>,v50,fine,t;\n"
                                                                      "MoveL <0,10,0>,v50,z5,t;\n"
                                                                      "MoveL left,v50,z5,t; ! half\n")));
}

TEST_CASE("the header follows MODULE, in comments with the line end of the file") {
  for (const std::string begin :
       {"MODULE Job\r\n", "! by hand\r\n%%%\r\n  VERSION:1\r\n%%%\r\nMODULE a(\r\n SYSMODULE)\r\n"}) {
    const std::string routine = "PROC main()\r\nMoveJ " + target_at("1,2,3") +
                                ",v50,z1,t;\r\nENDPROC\r\nENDMODULE\r\nMODULE b\r\nENDMODULE";
    const Program program = read_rapid(begin + routine);
    CHECK(program.moves.size() == 1);
    CHECK(!is_corrected(program));
    CHECK(program.remarks.size() == 1);
    const std::string out =
        rewrite(program, unchanged_edits(program), {.header = {"COUNTERFLEX 1", "second\tline"}}).text;
    CHECK(out == begin + "! COUNTERFLEX 1\r\n! second line\r\n" + routine);
    CHECK(is_corrected(read_rapid(out)));
  }
}
