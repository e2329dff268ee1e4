// Programs of KUKA robots: writing of corrected targets.
#include <doctest/doctest.h>

#include "counterflex/files/files.hpp"
#include "counterflex/program/program_reader.hpp"
#include "program/robot/kuka/kuka.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a program whose targets do not change keeps every byte") {
  for (const std::string& text : {milling, std::string("DEF a()\r\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\r\nEND")}) {
    const Program program = read_krl(text);
    CHECK(rewrite(program, robot_edits(program), {}).text == text);
  }
}

TEST_CASE("changed numbers keep their digits, at least three of a length and four of an angle") {
  const Program program = read_krl(milling);
  MoveEdit rapid = robot_edit(program, 0), down = robot_edit(program, 1), across = robot_edit(program, 2);
  rapid.end_mm += Vector3(0.01, 0, 0);
  down.end_mm += Vector3(0.01234, 0, -0.0004);
  down.orientation = OrientationNumbers{179.98, 0.00003, 40.00006};
  across.end_mm += Vector3(0, 0.001, 0);
  across.orientation = OrientationNumbers{180, -0.01, 50};
  const Rewritten out = rewrite(program, {rapid, down, across}, {});
  CHECK(out.changed_words == 6);
  const std::size_t begin = out.text.find("PTP {X");
  CHECK(out.text.substr(begin) ==
        "PTP {X 10.01,Y 20.0,Z 30.0,A 40.0,B -0.000,C 180.0,S 2,T 10,E1 850.0}\n"
        "$VEL.CP = 0.05\n"
        "LIN {X 10.012,Y 20.0,Z -1.5,A 40.0001,B -0.000,C 179.98,E1 850.0} C_DIS ;down\n"
        "lin {x 60,y 20.001,z -1.5,a 50,b -0.01,c 180,e1 850} c_dis\n"
        "END\n");
  CHECK(out.text.substr(0, begin) == milling.substr(0, milling.find("PTP {X")));
}

TEST_CASE("inserted points are copies of the statement without its comment") {
  const Program program = read_krl(milling);
  MoveEdit down = robot_edit(program, 1), across = robot_edit(program, 2);
  down.inserted = {{{10, 20.01, 10}, {}, OrientationNumbers{180, 0, 40}}};
  across.jump = Via{{10.02, 20, -1.5}, {}, OrientationNumbers{180, 0, 40}};
  across.inserted = {{{35, 20, -1.499}, {}, OrientationNumbers{180, 0, 45.5}}};
  const Rewritten out = rewrite(program, {down, across}, {});
  CHECK(out.inserted_blocks == 3);
  CHECK(out.blocks_of_edit == std::vector<std::size_t>{1, 2});
  CHECK(out.text.substr(out.text.find("LIN {")) ==
        "LIN {X 10.0,Y 20.01,Z 10.0,A 40.0,B -0.000,C 180.0,E1 850.0} C_DIS\n"
        "LIN {X 10.0,Y 20.0,Z -1.5,A 40.0,B -0.000,C 180.0,E1 850.0} C_DIS ;down\n"
        "lin {x 10.02,y 20,z -1.5,a 40,b 0,c 180,e1 850} c_dis\n"
        "lin {x 35,y 20,z -1.499,a 45.5,b 0,c 180,e1 850} c_dis\n"
        "lin {x 60,y 20,z -1.5,a 50,b 0,c 180,e1 850} c_dis\n"
        "END\n");
}

TEST_CASE(
    "components that a target does not have keep their last value, and are inserted where they change") {
  const Program program = read_statements(
      "PTP {X 1,Y 2,Z 3,A 10,B 20,C 30,E1 5}\n"
      "LIN {Z -1.5} C_DIS\n"
      "LIN { Y 7, E1 5 } C_VEL\n");
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].end_mm == Vector3(1, 2, -1.5));
  CHECK(program.moves[2].end_mm == Vector3(1, 7, -1.5));
  CHECK(program.moves[2].orientation->end == OrientationNumbers{30, 20, 10});
  MoveEdit down = robot_edit(program, 1), across = robot_edit(program, 2);
  down.end_mm = {1.01, 2, -1.49};
  down.orientation = OrientationNumbers{30, 20.01, 10};
  across.end_mm = {1.01, 7, -1.485};
  across.orientation = OrientationNumbers{30, 20.01, 10.5};
  const Rewritten out = rewrite(program, {down, across}, {});
  CHECK(out.inserted_words == 4);
  CHECK(out.text ==
        "DEF job()\n"
        "PTP {X 1,Y 2,Z 3,A 10,B 20,C 30,E1 5}\n"
        "LIN {Z -1.49,X 1.010,B 20.0100} C_DIS\n"
        "LIN { Y 7, Z -1.485, A 10.5000, E1 5 } C_VEL\n"
        "END\n");
}

TEST_CASE("a number whose sign separates it from its name gets a blank if it loses the sign") {
  const Program program = read_statements("LIN {X-0.5,Y-2,Z 3,A 0,B-0.000,C 0}\n");
  MoveEdit edit = robot_edit(program, 0);
  edit.end_mm = {0.25, -2.5, 3};
  edit.orientation = OrientationNumbers{0, 0.01, 0};
  CHECK(rewrite(program, {edit}, {}).text == "DEF job()\nLIN {X 0.25,Y-2.5,Z 3,A 0,B 0.010,C 0}\nEND\n");
}

TEST_CASE("an orientation is known where one target has all of its angles") {
  const Program program = read_statements(
      "LIN {X 1,Y 2,Z 3,A 1,B 2}\n"
      "LIN {C 3}\n"
      "LIN {A 1,B 2,C 3}\n"
      "LIN {X 1,Y 2,Z 3}\n");
  CHECK(!program.moves[1].orientation);
  CHECK(!program.moves[2].known_end[0]);
  CHECK(all_known(program.moves[3].known_end));
  CHECK(rewrite(program, robot_edits(program), {}).text == program.text);
}

TEST_CASE("LIN_REL moves by differences and keeps the orientation") {
  const Program program = read_statements(
      "PTP {X 1,Y 2,Z 3,A 0,B 0,C 0}\n"
      "LIN_REL {X 0,Y 0,Z -1.5,A 0,B 0,C 0} C_DIS\n"
      "LIN_REL {X 10} #BASE\n"
      "LIN_REL {X 10} #TOOL\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].relative);
  CHECK(program.moves[1].end_mm == Vector3(1, 2, 1.5));
  CHECK(program.moves[2].end_mm == Vector3(11, 2, 1.5));
  CHECK(program.moves[3].fixed[0]);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 5);
  CHECK(rewrite(program, robot_edits(program), {}).text == program.text);
  MoveEdit start = robot_edit(program, 0), down = robot_edit(program, 1), across = robot_edit(program, 2);
  start.end_mm = {1, 2, 3.02};
  down.end_mm = {1.01, 2, 1.5};
  down.inserted = {{{1.004, 2, 2}, {}, down.orientation}};
  across.end_mm = {11.01, 2, 1.5};
  CHECK(rewrite(program, {start, down, across}, {}).text ==
        "DEF job()\n"
        "PTP {X 1,Y 2,Z 3.02,A 0,B 0,C 0}\n"
        "LIN_REL {X 0.004,Y 0,Z -1.02,A 0,B 0,C 0} C_DIS\n"
        "LIN_REL {X 0.006,Y 0,Z -0.5,A 0,B 0,C 0} C_DIS\n"
        "LIN_REL {X 10} #BASE\n"
        "LIN_REL {X 10} #TOOL\n"
        "END\n");
}

TEST_CASE("CIRC is an arc through its auxiliary point in any plane") {
  const std::string statements =
      "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"
      "CIRC {X 3,Y 3,Z 4},{X 6.0,Y 0,Z 8.0,A 0,B 0,C 10} C_DIS ;half a turn\n";
  const Program program = read_statements(statements);
  REQUIRE(program.moves.size() == 2);
  const Move& circle = program.moves[1];
  REQUIRE(circle.arc.has_value());
  CHECK(circle.motion == Motion::feed);
  CHECK((circle.arc->centre_mm - Vector3(3, -8.0 / 3, 4)).norm() < 1e-12);  // radius 17/3
  const double radius = (circle.arc->centre_mm - circle.start_mm).norm();
  CHECK((circle.arc->centre_mm - circle.end_mm).norm() == doctest::Approx(radius));
  CHECK((circle.arc->centre_mm - circle.arc->through->p_mm).norm() == doctest::Approx(radius));
  CHECK(std::abs(normal_of(*circle.arc).dot(Vector3(6, 0, 8))) < 1e-12);
  CHECK(rewrite(program, robot_edits(program), {}).text == program.text);
}

TEST_CASE("a corrected CIRC is read back as the curve that was written") {
  const Program program = read_statements(
      "PTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n"
      "CIRC {X 0.0,Y 10.0,Z 0.0,A 0,B 0,C 0}, {X -10.0,Y 0.0,Z 0.0,A 0,B 0,C 0} C_DIS\n");
  MoveEdit start = robot_edit(program, 0), circle = robot_edit(program, 1);
  start.end_mm = {10.02, 0.01, 0.005};
  circle.end_mm = {-9.99, 0.01, 0.031};
  circle.centre_mm = Vector3(0.015, 0.02, 0.005);
  const std::string text = rewrite(program, {start, circle}, {}).text;
  CHECK(text ==
        "DEF job()\n"
        "PTP {X 10.02,Y 0.01,Z 0.005,A 0,B 0,C 0}\n"
        "CIRC {X 0.015,Y 10.025,Z 0.018,A 0,B 0,C 0}, {X -9.99,Y 0.01,Z 0.031,A 0,B 0,C 0} C_DIS\n"
        "END\n");
  const Program back = read_krl(text);
  TextPosition before;
  before[0] = 10.02, before[1] = 0.01, before[2] = 0.005;
  const Curve written =
      as_written(program.moves[1], before, {circle.end_mm, circle.centre_mm, circle.orientation}, true, {});
  REQUIRE(written.arc.has_value());
  const ArcMove& arc = *back.moves[1].arc;
  CHECK((arc.centre_mm - written.arc->centre).norm() < 1e-9);
  CHECK((normal_of(arc) - written.arc->normal).norm() < 1e-9);
  CHECK((back.moves[1].end_mm - written.end).norm() < 1e-9);
}

TEST_CASE("a CIRC is split into arcs, or into lines where it has no centre") {
  const Program program = read_statements(
      "PTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n"
      "$VEL.CP=1\n"
      "CIRC {X 0,Y 10,Z 0}, {X -10,Y 0,Z 0} C_DIS\n");
  MoveEdit circle = robot_edit(program, 1);
  circle.inserted = {{{0, 10, 0}, Vector3(0, 0, 0), circle.orientation}};
  CHECK(rewrite(program, {circle}, {}).text ==
        "DEF job()\n"
        "PTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n"
        "$VEL.CP=1\n"
        "CIRC {X 7.071,Y 7.071,Z 0}, {X 0,Y 10,Z 0} C_DIS\n"
        "CIRC {X -7.071,Y 7.071,Z 0}, {X -10,Y 0,Z 0} C_DIS\n"
        "END\n");
  circle.centre_mm.reset();
  circle.inserted[0].centre_mm.reset();
  CHECK(rewrite(program, {circle}, {}).text ==
        "DEF job()\n"
        "PTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n"
        "$VEL.CP=1\n"
        "LIN {X 0,Y 10,Z 0} C_DIS\n"
        "LIN {X -10,Y 0,Z 0} C_DIS\n"
        "END\n");
}

TEST_CASE("a named target is changed where it is declared, or in the moves if several use it") {
  const Program program = read_statements(
      "DECL E6POS P1={X 0,Y 0,Z 5,A 0,B 0,C 0,S 2,T 10,E1 5}\n"
      "DECL POS once, twice\n"
      "twice = {POS: X 10,Y 0,Z 5,A 0,B 0,C 0}\n"
      "once={X 20,Y 0}\n"
      "PTP P1\n"
      "LIN TWICE C_DIS ; there\n"
      "LIN {X 15} C_DIS\n"
      "LIN twice C_VEL\n"
      "LIN once\n"
      "once.X=3\n");
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[0].end_mm == Vector3(0, 0, 5));
  CHECK(program.moves[1].end_mm == Vector3(10, 0, 5));
  CHECK(program.moves[4].end_mm == Vector3(20, 0, 5));
  CHECK(rewrite(program, robot_edits(program), {}).text == program.text);
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[0].end_mm.x() = 0.01;
  edits[3].end_mm.x() = 10.02;
  edits[3].inserted = {{{12, 0, 5}, {}, edits[3].orientation}};
  CHECK(rewrite(program, edits, {}).text ==
        "DEF job()\n"
        "DECL E6POS P1={X 0.01,Y 0,Z 5,A 0,B 0,C 0,S 2,T 10,E1 5}\n"
        "DECL POS once, twice\n"
        "twice = {POS: X 10,Y 0,Z 5,A 0,B 0,C 0}\n"
        "once={X 20,Y 0}\n"
        "PTP P1\n"
        "LIN TWICE C_DIS ; there\n"
        "LIN {X 15} C_DIS\n"
        "LIN {POS: X 12,Y 0,Z 5,A 0,B 0,C 0} C_VEL\n"
        "LIN {POS: X 10.02,Y 0,Z 5,A 0,B 0,C 0} C_VEL\n"
        "LIN once\n"
        "once.X=3\n"
        "END\n");
  edits = robot_edits(program);
  edits[4].end_mm = {20.01, 0, 5.01};
  const std::string text = rewrite(program, edits, {}).text;
  CHECK(text.find("LIN {X 20.01,Y 0,Z 5.010}\n") != std::string::npos);
  CHECK(text.find("once={X 20,Y 0}\n") != std::string::npos);
}

TEST_CASE("angles at the poles and near a full turn keep their numbers") {
  const Program program = read_statements(
      "PTP {X 0,Y 0,Z 0,A 10,B 90,C 0}\n"
      "LIN {X 5,Y 0,Z 0,A 359.999,B -90.0,C 20} C_DIS\n"
      "LIN {X 9,Y 0,Z 0,A 0.001,B 0,C 0} C_DIS\n"
      "LIN {X 9.5,Y 0,Z 0,A 1.5E-3,B 0,C 0}\n");
  CHECK(rewrite(program, robot_edits(program), {}).text == program.text);
  for (const Move& move : program.moves) {
    CAPTURE(move.line);
    const MoveOrientation& o = *move.orientation;
    const OrientationNumbers again = numbers_of(o.form, turn_of(o).end, o.end);
    for (std::size_t i = 0; i < 3; ++i) CHECK(again[i] == doctest::Approx(o.end[i]).epsilon(1e-9));
  }
  // The control turns the shorter way about one axis: by 0.002 deg, not by 359.998.
  MoveOrientation wrap = *program.moves[2].orientation;
  wrap.start = {0, 0, 359.999};
  CHECK(rotation_between(turn_of(wrap).end, turn_of(wrap).start).norm() * 180 / 3.14159265358979 ==
        doctest::Approx(0.002));
  CHECK(numbers_at(wrap, 0.5)[2] == doctest::Approx(360).epsilon(1e-9));
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[1].orientation = OrientationNumbers{20, -89.99, 360.0005};
  edits[3].orientation = OrientationNumbers{0, 0, 0.0021};
  const std::string text = rewrite(program, edits, {}).text;
  CHECK(text.find("A 360.0005,B -89.99,C 20}") != std::string::npos);
  CHECK(text.find("A 0.0021,B 0,C 0}") != std::string::npos);
}

TEST_CASE("the header follows DEF, in comments with the line end of the file") {
  const std::string text =
      "&ACCESS RVO1\r\n; made by hand\r\nGLOBAL DEF job( )\r\nPTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\r\n"
      "LIN {X 5} C_DIS\r\nEND\r\nDEF other()\r\nLIN {X 5}\r\nEND\r\n";
  const Program program = read_krl(text);
  CHECK(program.moves.size() == 2);
  REQUIRE(program.remarks.size() == 1);
  CHECK(program.remarks[0].line == 6);
  CHECK(!is_corrected(program));
  MoveEdit edit = robot_edit(program, 1);
  edit.inserted = {{{2.5, 0.01, 0}, {}, edit.orientation}};
  const std::string out = rewrite(program, {edit}, {.header = {"COUNTERFLEX 1", "second\tline"}}).text;
  CHECK(out ==
        "&ACCESS RVO1\r\n; made by hand\r\nGLOBAL DEF job( )\r\n; COUNTERFLEX 1\r\n; second line\r\n"
        "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\r\n"
        "LIN {X 2.5,Y 0.010} C_DIS\r\nLIN {X 5,Y 0.000} C_DIS\r\nEND\r\n"
        "DEF other()\r\nLIN {X 5}\r\nEND\r\n");
  CHECK(is_corrected(read_krl(out)));
}
