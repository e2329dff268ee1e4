// Programs of Universal Robots: writing of corrected targets.
#include <doctest/doctest.h>

#include "counterflex/files/files.hpp"
#include "counterflex/program/overview.hpp"
#include "program/robot/corpus.hpp"
#include "program/robot/ur/ur.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a URScript program whose targets do not change keeps every byte") {
  for (const std::string& text :
       {ur_milling,
        std::string("def a():\r\n\tmovel(p[1,2,3e-1,0,0,0])\r\n  movel( p[ 1 , 2,3 ,0, 0,0 ] )\r\nend")})
    CHECK(unchanged(read_ur(text)) == text);
}

TEST_CASE("changed numbers of URScript keep their digits, at least six of metres and radians") {
  const Program program = read_ur(ur_milling);
  MoveEdit rapid = robot_edit(program, 0), down = robot_edit(program, 1), across = robot_edit(program, 2);
  rapid.end_mm += Vector3(0.01, 0, 0);
  down.end_mm += Vector3(0.01234, 0, -0.0004);
  down.orientation = OrientationNumbers{-1.2092004, -1.2092006, -1.21};
  across.end_mm += Vector3(0, -0.001, 0.002);
  across.orientation = OrientationNumbers{-0.00012349, 3.14159271, 0};
  const Rewritten out = rewrite(program, {rapid, down, across}, {});
  CHECK(out.changed_words == 7);
  const std::size_t begin = out.text.find("movej(p");
  CHECK(out.text.substr(begin) ==
        "movej(p[0.70001, 0.25, 0.6, -1.2092, -1.2092, -1.2092], a=1, v=0.3)\n"
        "  movel(p[0.700012, 0.25, .5, -1.2092, -1.209201, -1.2100], a=2.5, v=slow, r=zone) # down\n"
        "  movep(p[+0.8, 0.249999, 0.500002, -0.000123, 3.1415927, 0], 1.2, 0.1, 0.001)\n"
        "end\n");
  CHECK(out.text.substr(0, begin) == ur_milling.substr(0, begin));
}

TEST_CASE(
    "inserted points of URScript are copies of the statement, with zones of less than half their spacing") {
  const Program program = read_ur(ur_milling);
  MoveEdit down = robot_edit(program, 1), across = robot_edit(program, 2);
  across.jump = Via{{700.02, 250, 500}, {}, OrientationNumbers{-1.2092, -1.2092, -1.2092}};
  across.inserted = {{{701.02, 250, 500}, {}, OrientationNumbers{-1, -1, -1}},
                     {{750, 250, 500.001}, {}, OrientationNumbers{0, 1, 0}}};
  down.inserted = {{{700, 250.01, 550}, {}, down.orientation}};
  const Rewritten out = rewrite(program, {down, across}, {});
  CHECK(out.inserted_blocks == 4);
  CHECK(out.blocks_of_edit == std::vector<std::size_t>{1, 3});
  CHECK(out.text.substr(out.text.find("  movel(")) ==
        "  movel(p[0.7, 0.25001, .55, -1.2092, -1.2092, -1.2092], a=2.5, v=slow, r=zone)\n"
        "  movel(p[0.7, 0.25, .5, -1.2092, -1.2092, -1.2092], a=2.5, v=slow, r=0.000009) # down\n"
        "  movep(p[+0.70002, 0.25, 5e-1, -1.2092, -1.2092000, -1.2092], 1.2, 0.1, 0.000009)\n"
        "  movep(p[+0.70102, 0.25, 5e-1, -1.0, -1.000000, -1], 1.2, 0.1, 0.00049)\n"
        "  movep(p[+0.75, 0.25, 0.500001, 0.0, 1.000000, 0], 1.2, 0.1, 0.001)\n"
        "  movep(p[+0.8, 0.25, 5e-1, 0.0, 3.1415927, 0], 1.2, 0.1, 0.001)\n"
        "end\n");
}

TEST_CASE("zones that touch do not overlap when their targets come nearer") {
  const Program program = read_ur_statements(
      "movel(p[0,0,0,0,0,0])\n"
      "movel(p[0.01,0,0,0,0,0],r=0.003)\n"
      "movel(p[0.02,0,0,0,0,0],r=0.007)\n"
      "movel(p[0.05,0,0,0,0,0],r=0.001)\n");
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[2].end_mm.x() -= 0.01;
  CHECK(rewrite(program, {edits[2]}, {}).text == ur_program_of("movel(p[0,0,0,0,0,0])\n"
                                                               "movel(p[0.01,0,0,0,0,0],r=0.003)\n"
                                                               "movel(p[0.01999,0,0,0,0,0],r=0.004895)\n"
                                                               "movel(p[0.05,0,0,0,0,0],r=0.001)\n"));
  edits[2].end_mm.x() += 0.02;  // farther: nothing to do
  CHECK(rewrite(program, edits, {}).text.find("r=0.007") != std::string::npos);
}

TEST_CASE("pose_trans gives a target in the frame of a constant pose") {
  const std::string statements =
      "plane = p[0.1, 0.2, 0.3, 0, 0, 1.5707963267948966]\n"
      "movel(pose_trans(plane, p[0.01, 0, 0, 0, 0, 0]), v=0.1, r=0.001)\n"
      "movel(pose_trans(plane, p[0.02, 0, 0, 0, 0, 0]), v=0.1, r=0.001)\n"
      "movel(pose_trans(p[1, 0, 0, 0, 0, 0], p[0.02, 0, 0, 0, 0, 0]))\n"
      "movel(p[0.02, 0, 0, 0, 0, 0])\n"
      "movel(pose_trans(later, p[0.02, 0, 0, 0, 0, 0]))\n"
      "movel(pose_trans(plane, get_actual_tcp_pose()))\n"
      "later = p[1, 0, 0, 0, 0, 0]\n";
  const Program program = read_ur_statements(statements);
  REQUIRE(program.moves.size() == 6);
  const ProgramFrame& frame = program.frames[program.moves[0].frame];
  CHECK(frame.work_offset == "plane");
  CHECK((*frame.pose_mm * Vector3(10, 0, 0) - Vector3(100, 210, 300)).norm() < 1e-9);
  CHECK(program.moves[1].frame == program.moves[0].frame);
  CHECK(program.moves[1].may_split);
  CHECK((program.moves[1].end_mm - Vector3(20, 0, 0)).norm() < 1e-12);
  CHECK(!program.moves[2].known_start[0]);
  CHECK((program.frames[program.moves[2].frame].pose_mm->p - Vector3(1000, 0, 0)).norm() < 1e-12);
  CHECK(program.frames[program.moves[3].frame] == ProgramFrame{});
  CHECK(program.moves[4].fixed[0]);
  CHECK(program.moves[5].fixed[0]);
  MoveEdit edit = robot_edit(program, 1);
  edit.end_mm.y() = 0.01;
  edit.inserted = {{{15, 0.02, 0}, {}, edit.orientation}};
  const std::string text = rewrite(program, {edit}, {}).text;
  CHECK(text.find("movel(pose_trans(plane, p[0.015, 0.00002, 0, 0, 0, 0]), v=0.1, r=0.001)\n"
                  "movel(pose_trans(plane, p[0.02, 0.00001, 0, 0, 0, 0]), v=0.1, r=0.001)\n") !=
        std::string::npos);
}

TEST_CASE("the frame of pose_trans may be a feature of the installation, which the text never assigns") {
  const std::string move = "movel(pose_trans(table, p[0.02, 0, 0, 0, 0, 0]), v=0.1)\n";
  const Program program = read_ur_statements(move);
  REQUIRE(program.moves.size() == 1);
  CHECK(all_known(program.moves[0].known_end));
  CHECK(program.frames[program.moves[0].frame].work_offset == "table");
  CHECK_FALSE(program.frames[program.moves[0].frame].pose_mm);
  CHECK(rewrite(program, shifted(program, {1, 0, 0}), {}).text.find("pose_trans(table, p[0.021, 0, 0,") !=
        std::string::npos);
  for (const std::string computed :
       {"table = get_feature(1)\n" + move, move + "table = p[1, 0, 0, 0, 0, 0]\n", "table[2] = 0.1\n" + move,
        std::string("movel(pose_trans(get_feature(1), p[0.02, 0, 0, 0, 0, 0]), v=0.1)\n"),
        std::string("movel(pose_trans(table, pose_trans(part, p[0.02, 0, 0, 0, 0, 0])), v=0.1)\n")}) {
    CAPTURE(computed);
    CHECK_FALSE(any_axis(read_ur_statements(computed).moves.at(0).known_end));
  }
}

TEST_CASE("a named pose is rewritten where it is declared if all its uses want the same") {
  const std::string statements =
      "global P1=p[0.1,0,0.2,0,0,0]\n"
      "P2 = p[0.2,0,0.2,0,0,0]\n"
      "Q1 = [0,0,0,0,0,0]\n"
      "movej(get_inverse_kin(P1, qnear=Q1), a=1.4, v=1.05)\n"
      "movel(P2, a=1.2, v=0.25, r=0.01)\n"
      "movel(P1, a=1.2, v=0.25)\n";
  const Program program = read_ur_statements(statements);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[0].motion == Motion::rapid);
  CHECK((program.moves[2].end_mm - Vector3(100, 0, 200)).norm() < 1e-9);
  CHECK(unchanged(program) == program.text);
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[0].end_mm.x() = edits[2].end_mm.x() = 100.01;
  edits[2].end_mm.y() = 0.0003;  // below the digits
  edits[1].end_mm.z() = 200.02;
  edits[1].inserted = {{{150, 0, 200}, {}, edits[1].orientation}, {{200, 0, 200}, {}, edits[1].orientation}};
  CHECK(rewrite(program, edits, {}).text ==
        ur_program_of("global P1=p[0.10001,0,0.2,0,0,0]\n"
                      "P2 = p[0.2,0,0.20002,0,0,0]\n"
                      "Q1 = [0,0,0,0,0,0]\n"
                      "movej(get_inverse_kin(P1, qnear=Q1), a=1.4, v=1.05)\n"
                      "movel(p[0.15,0,0.2,0,0,0], a=1.2, v=0.25, r=0.01)\n"
                      "movel(p[0.2,0,0.2,0,0,0], a=1.2, v=0.25, r=0.000009)\n"
                      "movel(P2, a=1.2, v=0.25, r=0.000009)\n"
                      "movel(P1, a=1.2, v=0.25)\n"));
}

TEST_CASE("a named pose that two moves want at different places is not rewritten with one correction") {
  const std::string statements =
      "P1=p[0.1,0,0.2,0,0,0]\n"
      "P2=p[0.2,0,0.2,0,0,0]\n"
      "movej(P1)\n"
      "movel(P2)\n"
      "movel(P1)\n"
      "x = pose_add(P2, P1)\n";
  const Program program = read_ur_statements(statements);
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[0].end_mm.x() = 100.01;
  edits[1].end_mm.x() = 200.01;
  CHECK(rewrite(program, edits, {}).text == ur_program_of("P1=p[0.1,0,0.2,0,0,0]\n"
                                                          "P2=p[0.2,0,0.2,0,0,0]\n"
                                                          "movej(p[0.10001,0,0.2,0,0,0])\n"
                                                          "movel(p[0.20001,0,0.2,0,0,0])\n"
                                                          "movel(P1)\n"
                                                          "x = pose_add(P2, P1)\n"));
  // One of two uses is edited: the other keeps its numbers.
  const Program twice = read_ur_statements("P1=p[0.1,0,0.2,0,0,0]\nmovel(P1)\nmovel(P1)\n");
  edits = robot_edits(twice);
  edits[1].end_mm.x() = 100.01;
  const std::string inline_use =
      ur_program_of("P1=p[0.1,0,0.2,0,0,0]\nmovel(P1)\nmovel(p[0.10001,0,0.2,0,0,0])\n");
  CHECK(rewrite(twice, edits, {}).text == inline_use);
  CHECK(rewrite(twice, {edits[1]}, {}).text == inline_use);
}

TEST_CASE("a named pose is rewritten in the assignment whose value a move uses") {
  const Program program = read_ur_statements(
      "P=p[0,0,0,0,0,0]\n"
      "P=p[0.1,0,0,0,0,0]\n"
      "movel(P)\n"
      "movel(P)\n");
  std::vector<MoveEdit> edits = robot_edits(program);
  for (MoveEdit& edit : edits) edit.end_mm.x() = 100.01;
  CHECK(rewrite(program, edits, {}).text == ur_program_of("P=p[0,0,0,0,0,0]\n"
                                                          "P=p[0.10001,0,0,0,0,0]\n"
                                                          "movel(P)\n"
                                                          "movel(P)\n"));
  const Program twice = read_ur_statements(
      "P=p[0,0,0,0,0,0]\n"
      "movel(P)\n"
      "P=p[0.1,0,0,0,0,0]\n"
      "movel(P)\n");
  edits = robot_edits(twice);
  edits[0].end_mm.x() = 0.01;
  edits[1].end_mm.x() = 100.01;
  CHECK(rewrite(twice, edits, {}).text == ur_program_of("P=p[0,0,0,0,0,0]\n"
                                                        "movel(p[0.00001,0,0,0,0,0])\n"
                                                        "P=p[0.1,0,0,0,0,0]\n"
                                                        "movel(p[0.10001,0,0,0,0,0])\n"));
}

TEST_CASE("movec is an arc through pose_via, whose rotation is not used") {
  const std::string statements =
      "movel(p[0.01,0,0,0,0,0])\n"
      "movec(p[0,0.01,0,9,9,9], p[-0.01,0,0,0,0,0.1], a=1, v=0.1, r=0.001, mode=0) # half\n";
  const Program program = read_ur_statements(statements);
  REQUIRE(program.moves.size() == 2);
  const Move& circle = program.moves[1];
  REQUIRE(circle.arc.has_value());
  CHECK(circle.arc->centre_mm.norm() < 1e-12);
  CHECK((normal_of(*circle.arc) - Vector3::UnitZ()).norm() < 1e-12);
  CHECK(circle.may_split);
  CHECK(unchanged(program) == program.text);
  MoveEdit edit = robot_edit(program, 1);
  edit.end_mm = {-10.01, 0, 0.02};
  edit.centre_mm = Vector3(-0.005, 0, 0);
  const std::string out = rewrite(program, {edit}, {}).text;
  const Program back = read_ur(out);
  CHECK((back.moves[1].end_mm - Vector3(-10.01, 0, 0.02)).norm() < 1e-9);
  CHECK((back.moves[1].arc->centre_mm - Vector3(-0.005, 0, 0)).norm() < 0.02);
  CHECK(out.find("9,9,9], p[-0.01001,0,0.00002,0,0,0.1], a=1, v=0.1, r=0.001, mode=0) # half\n") !=
        std::string::npos);
  edit = robot_edit(program, 1);
  edit.centre_mm.reset();
  edit.inserted = {{{0, 10, 0}, {}, edit.orientation}};
  CHECK(rewrite(program, {edit}, {}).text ==
        ur_program_of("movel(p[0.01,0,0,0,0,0])\n"
                      "movel(p[0.00,0.01,0,0,0,0.1], a=1, v=0.1, r=0.001)\n"
                      "movel(p[-0.01,0,0,0,0,0.1], a=1, v=0.1, r=0.001) # half\n"));
  const Program by_position = read_ur_statements(
      "via = p[0,0.01,0,0,0,0]\nmovel(p[0.01,0,0,0,0,0])\nmovec(via, p[-0.01,0,0,0,0,0], 1, 0.1, 0.001, "
      "0)\n");
  edit = robot_edit(by_position, 1);
  edit.inserted = {{{0, 10, 0}, Vector3(0, 0, 0), edit.orientation}};
  CHECK(rewrite(by_position, {edit}, {}).text ==
        ur_program_of("via = p[0,0.01,0,0,0,0]\n"
                      "movel(p[0.01,0,0,0,0,0])\n"
                      "movec(p[0.007071,0.007071,0,0,0,0], p[0.00,0.01,0,0,0,0], 1, 0.1, 0.001, 0)\n"
                      "movec(p[-0.007071,0.007071,0,0,0,0], p[-0.01,0,0,0,0,0], 1, 0.1, 0.001, 0)\n"));
  edit.centre_mm.reset();
  edit.inserted = {};
  CHECK(rewrite(by_position, {edit}, {}).text.find("movel(p[-0.01,0,0,0,0,0], 1, 0.1, r=0.001)\n") !=
        std::string::npos);
}

TEST_CASE("vectors of half a turn, and beyond it, keep their numbers") {
  const Program program = read_ur_statements(
      "movel(p[0,0,0,3.141592653589793,0,0])\n"
      "movel(p[0.1,0,0,-3.141592653589793,0,0],r=0.001)\n"
      "movel(p[0.2,0,0,0,4.0,0],r=0.001)\n"
      "movel(p[0.3,0,0,1.5E-3,+.5,-0.],r=0.001)\n");
  CHECK(unchanged(program) == program.text);
  for (const Move& move : program.moves) {
    const MoveOrientation& o = *move.orientation;
    const OrientationNumbers again = numbers_of(o.form, turn_of(o).end, o.end);
    for (std::size_t i = 0; i < 3; ++i) CHECK(again[i] == doctest::Approx(o.end[i]).epsilon(1e-9));
  }
  // From pi to -pi about X is no turn at all.
  CHECK(rotation_between(turn_of(*program.moves[1].orientation).end,
                         turn_of(*program.moves[1].orientation).start)
            .norm() < 1e-9);
  MoveEdit edit = robot_edit(program, 3);
  edit.orientation = OrientationNumbers{0.00151, 0.5, 0.0001};
  CHECK(rewrite(program, {edit}, {}).text.find("p[0.3,0,0,0.00151,+.5,0.0001],") != std::string::npos);
}

TEST_CASE("the header of URScript is in its function, with the line end of the file") {
  const std::string text = "# job\r\ndef job():\r\n  movel(p[0,0,0,0,0,0])\r\nend\r\njob()\r\n";
  const Program program = read_ur(text);
  CHECK(!is_corrected(program));
  REQUIRE(program.remarks.size() == 1);
  CHECK(program.remarks[0].line == 4);
  MoveEdit edit = robot_edit(program, 0);
  edit.end_mm.x() = 0.5;
  const std::string out = rewrite(program, {edit}, {.header = {"COUNTERFLEX 1", "second\tline"}}).text;
  CHECK(out ==
        "# job\r\ndef job():\r\n# COUNTERFLEX 1\r\n# second line\r\n  movel(p[0.0005,0,0,0,0,0])\r\nend\r\n"
        "job()\r\n");
  CHECK(is_corrected(read_ur(out)));
}

TEST_CASE("each URScript program of a folder of real programs is reproduced or refused with its line") {
  check_corpus([](const std::filesystem::path& path) { return path.extension() == ".script"; }, text_of_file);
}
