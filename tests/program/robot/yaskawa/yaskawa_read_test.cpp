// Jobs of Yaskawa robots: reading of positions, frames and steps.
#include <doctest/doctest.h>

#include <numbers>

#include "counterflex/program/program_reader.hpp"
#include "program/robot/corpus.hpp"
#include "program/robot/yaskawa/yaskawa.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string steps =
    "MOVJ C00000 VJ=50.00\nMOVJ C00001 VJ=25.00\nMOVL C00002 V=66.7 PL=0\n"
    "MOVL C00003 V=10.0 PL=1\nMOVJ C00000 VJ=50.00\n";

/// Why the only uncorrected statement is not corrected.
std::string why_of(const Program& program) {
  REQUIRE(program.left_alone.size() == 1);
  return program.left_alone.front().why;
}

/// A job of one MOVL to a position with these angles.
Matrix3 orientation_of_job(const std::string& angles) {
  const Program program = read_job(job_of(
      "///POSTYPE BASE\n///RECTAN\nC00000=1.000,2.000,3.000," + angles + "\n", "MOVL C00000 V=1\n", 1));
  REQUIRE(program.moves.size() == 1);
  return rotation_of(OrientationForm::fixed_axes, program.moves[0].orientation->end);
}

}  // namespace

TEST_CASE("a Yaskawa job has a move for each step with rectangular values") {
  const Program program = read_steps(steps);
  CHECK(program.dialect == "yaskawa");
  REQUIRE(program.moves.size() == 3);
  const Move &approach = program.moves[0], &down = program.moves[1], &cut = program.moves[2];
  CHECK(approach.motion == Motion::rapid);
  CHECK(!all_known(approach.known_start));
  CHECK(approach.end_mm == Vector3(0, 0, 50));
  CHECK(down.motion == Motion::feed);
  CHECK(down.feed_mm_min == doctest::Approx(66.7 * 60));
  CHECK(down.exact_stop);
  CHECK(!down.may_split);
  CHECK(cut.end_mm == Vector3(100, 0, 0));
  CHECK(cut.orientation->end[2] == 10);
  CHECK(cut.may_split);
  CHECK(cut.tool == 2);
  CHECK(program.frames[cut.frame].work_offset == "USER 1");
  CHECK(!program.frames[cut.frame].pose_mm);
  REQUIRE(program.left_alone.size() == 2);
  CHECK(program.left_alone[0].why == "MOVJ moves to pulses of the joints");
  CHECK(program.left_alone[0].machine_position);
}

TEST_CASE("Rx, Ry and Rz turn about the fixed axes X, Y and Z, one after the other") {
  Matrix3 R;
  R << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // X to Y, Y to Z, Z to X: 90 about X, then 90 about Z
  CHECK((orientation_of_job("90.0000,0.0000,90.0000") - R).norm() < 1e-12);
  R << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  CHECK((orientation_of_job("0.0000,90.0000,0.0000") - R).norm() < 1e-12);
  R << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  CHECK((orientation_of_job("0.00,-90.00,0.00") - R).norm() < 1e-12);
  // At 90 degrees about Y the turns about X and Z are about one axis.
  CHECK(
      (orientation_of_job("30.0000,90.0000,10.0000") - orientation_of_job("20.0000,90.0000,0.0000")).norm() <
      1e-12);
  const double step = rotation_between(orientation_of_job("179.9999,0.0000,0.0000"),
                                       orientation_of_job("-179.9999,0.0000,0.0000"))
                          .norm();
  CHECK(step == doctest::Approx(0.0002 * std::numbers::pi / 180).epsilon(1e-6));
}

TEST_CASE("names of positions may have any number of digits, blanks before '=' and a comma at the end") {
  const Program program =
      read_job(job_of("///POSTYPE ROBOT\n///RECTAN\nC000 = 1.0, 2.0 ,3.0,0.0,0.0,0.0\nC1=4,5,6,0,0,0,\n",
                      "\tMOVL C000 V=10\nMOVL  C001  V=10.\n", 2));
  REQUIRE(program.moves.size() == 2);
  CHECK(program.moves[0].end_mm == Vector3(1, 2, 3));
  CHECK(program.moves[1].end_mm == Vector3(4, 5, 6));
}

TEST_CASE("BASE and ROBOT are the robot's world frame while its rail is at zero") {
  const std::string positions =
      "///TOOL 0\n///POSTYPE BASE\n///RECTAN\n"
      "C00000=1.000,2.000,3.000,0.0000,0.0000,0.0000\n"
      "///POSTYPE ROBOT\nC00001=4.000,5.000,6.000,0.0000,0.0000,0.0000\n";
  Program program = read_job(job_of(positions, "MOVL C00000 V=1\nMOVL C00001 V=1\n", 2));
  REQUIRE(program.moves.size() == 2);
  CHECK(program.moves[0].frame == program.moves[1].frame);
  CHECK(program.frames[program.moves[0].frame].pose_mm);
  CHECK(all_known(program.moves[1].known_start));
  program = read_job(job_of(positions + "BC00001=500.000\n", "MOVL C00001 BC00001 V=1\n", 2));
  CHECK(program.frames[program.moves[0].frame].work_offset == "ROBOT");
  CHECK(!program.frames[program.moves[0].frame].pose_mm);
}

TEST_CASE("a rail or a station that moves from step to step is reported with its line") {
  const std::string positions =
      "///POSTYPE BASE\n///RECTAN\nC00000=1,2,3,0,0,0\nC00001=4,5,6,0,0,0\n"
      "BC00000=10.000\nBC00001=10.000\n///POSTYPE PULSE\n///PULSE\nEC00000=1,2\n"
      "EC00001=1,3\n";
  CHECK(!read_job(job_of(positions, "MOVL C00000 BC00000 V=1\nMOVL C00001 BC00001 V=1\n", 2))
             .external_axes_move);
  const Program moved =
      read_job(job_of(positions, "MOVL C00000 BC00000 EC00000 V=1\nMOVL C00001 BC00001 EC00001 V=1\n", 2));
  REQUIRE(moved.external_axes_move);
  CHECK(moved.external_axes_move->line == 21);
}

TEST_CASE("steps without a target that is known are not followed") {
  const std::pair<std::string, std::string> jobs[] = {
      {"MOVL LP000 V=10\n", "the target 'LP000' is set at run time"},
      {"MOVL P[I000] V=10\n", "the target 'P[I000]' is set at run time"},
      {"MOVL P00100 V=10\n", "the position variable 'P00100' is not in this file"},
      {"IMOV P000 V=10 RF\n", "IMOV moves relative to the place of the robot at run time"},
      {"MOVL C00002 V=10 UNTIL IN#(1)=ON\n", "UNTIL ends the step at run time"},
      {"MOVL C00002 V=10 SRCH RIN#(1)=ON\n", "the word 'SRCH' of MOVL is not supported"},
      {"MOVL C00002 V=10 +MOVL C00003 V=10\n", "the step moves a second group"},
      {"SMOVL C00002 V=10\n", "SMOVL moves a second group or together with a station"},
      {"SFTON P000 UF#(1)\nMOVL C00002 V=10\n", "SFTON shifts the positions at run time"},
      {"MFRAME UF#(1) P000 P001 P002\nMOVL C00002 V=10\n",
       "MFRAME changes the user coordinate system 1 at run time"},
      {"IFTHENEXP B000=0\nMOVL C00002 V=10\nENDIF\n",
       "a loop or a condition may run the step never or several times"},
      {"IF ( IN#(1)=ON ) THEN\nMOVL C00002 V=10\nENDIF\n",
       "a loop or a condition may run the step never or several times"},
  };
  for (const auto& [text, why] : jobs) {
    const auto& instructions = text;
    CAPTURE(instructions);
    const Program program = read_steps(text);
    REQUIRE(program.moves.size() == 1);
    CHECK(program.moves[0].fixed[0]);
    CHECK(why_of(program) == why);
  }
}

TEST_CASE("steps behind SFTOF are followed, but not behind a label to which a shifted part may jump") {
  CHECK(read_steps("SFTON P000\nSFTOF\nMOVL C00002 V=10\n").left_alone.empty());
  CHECK(why_of(read_steps("SFTON P000\nSFTOF\n*AGAIN\nMOVL C00002 V=10\nJUMP *AGAIN\n")) ==
        "SFTON shifts the positions at run time");
  CHECK(why_of(read_steps("SFTON P000\nIFTHENEXP B000=0\nSFTOF\nENDIF\nMOVL C00002 V=10\n")) ==
        "SFTON shifts the positions at run time");
}

TEST_CASE("the place of the robot is unknown behind a label, a call and an unknown instruction") {
  for (const std::string between : {"*AGAIN\n", "CALL JOB:OTHER\n", "MYMACRO 3\n"}) {
    CAPTURE(between);
    const Program program = read_steps("MOVL C00001 V=10\n" + between + "MOVL C00002 V=10\nJUMP *AGAIN\n");
    REQUIRE(program.moves.size() == 2);
    CHECK(!all_known(program.moves[1].known_start));
    CHECK(all_known(program.moves[1].known_end));
    const bool calls = !between.starts_with("*");
    CHECK((!program.left_alone.empty() && program.left_alone.back().feeds) == calls);
    CHECK((!program.remarks.empty() && program.remarks[0].what.starts_with("assumed from here on")) == calls);
  }
  for (const std::string between : {"DOUT OT#(1) ON\n", "TIMER T=1.00\n", "WAIT IN#(1)=ON\n", "SET B000 1\n"})
    CHECK(all_known(read_steps("MOVL C00001 V=10\n" + between + "MOVL C00002 V=10\n").moves[1].known_start));
}

TEST_CASE("the place of the tool is unknown behind an instruction that sets the numbers of a tool") {
  const auto is_known_behind = [](const std::string& instruction) {
    CAPTURE(instruction);
    const Program program = read_steps("MOVL C00001 V=50.0\n" + instruction + "MOVL C00002 V=50.0\n");
    CHECK(program.moves.back().tool == 2);
    return program.moves.back().known_start[0];
  };
  CHECK_FALSE(is_known_behind("SETTOOL TL#(1) P001\n"));
  CHECK_FALSE(is_known_behind("SETFILE TOOL#(1).X 5\n"));
  CHECK(is_known_behind("SETFILE WEV#(1).AMP 5\n"));
  CHECK(is_known_behind("GETTOOL P001 TL#(1)\n"));
}

TEST_CASE("a position variable is followed until an instruction of the job or a called job may change it") {
  const std::string positions = jbi_positions_text + "P00100=5.000,0.000,0.000,180.0000,0.0000,0.0000\n";
  const auto left_alone = [&](const std::string& instructions) {
    const Program program = read_job(job_of(positions, instructions));
    return program.left_alone.empty() ? "" : program.left_alone.back().why;
  };
  CHECK(left_alone("MOVL P100 V=10\n") == "");
  CHECK(left_alone("SET LP000 P100\nGETE D000 P100 (1)\nMOVL P100 V=10\n") == "");
  const std::string changed = "the position variable 'P100' is changed at run time";
  for (const std::string change : {"SET P100 P001\n", "SETE P100 (1) D000\n", "ADD P100 P001\n",
                                   "GETS PX100 $PX000\n", "CNVRT PX100 PX001 BF\n", "SET P[I000] P001\n"}) {
    CAPTURE(change);
    CHECK(left_alone("MOVL P100 V=10\n" + change) == changed);
  }
  CHECK(left_alone("CALL JOB:A\nMOVL P100 V=10\n") ==
        "the call in line 22 may change the position variable 'P100'");
}

TEST_CASE("a step passes its target with PL=1 to 8 or without PL, and has the speed of SPEED without V") {
  const Program program = read_steps(
      "SPEED V=20.0\nMOVL C00001 PL=8\nMOVL C00002\nMOVL C00003 PL=0\n"
      "MOVL C00001 V=I000 PL=I001\nMOVL C00002 VR=30.0 CR=5.0\n");
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[0].feed_mm_min == 1200);
  CHECK(!program.moves[0].exact_stop);
  CHECK(!program.moves[1].exact_stop);
  CHECK(program.moves[2].exact_stop);
  CHECK(program.moves[3].feed_mm_min == 0);
  CHECK(program.moves[3].exact_stop);
  CHECK(program.moves[4].feed_mm_min == 0);
}

TEST_CASE("a step with NWAIT is not divided: the next instruction starts with it") {
  const Program program = read_steps(
      "MOVL C00001 V=10\nMOVL C00002 V=10 NWAIT\nDOUT OT#(1) ON\n"
      "MOVL C00003 V=10\n");
  CHECK(!program.moves[1].may_split);
  CHECK(program.moves[2].may_split);
}

namespace {

const std::string circle_positions =
    "///USER 1\n///TOOL 2\n///POSTYPE USER\n///RECTAN\n"
    "C00000=0.000,0.000,0.000,180.0000,0.0000,0.0000\nC00001=10.000,0.000,0.000,180.0000,0.0000,0.0000\n"
    "C00002=20.000,10.000,0.000,180.0000,0.0000,0.0000\nC00003=30.000,0.000,0.000,180.0000,0.0000,0.0000\n"
    "C00004=40.000,-10.000,0.000,180.0000,0.0000,0.0000\nC00005=50.000,0.000,0.000,180.0000,0.0000,0.0000\n";

Program read_circles(const std::string& instructions) {
  return read_job(job_of(circle_positions, instructions, 6));
}

}  // namespace

TEST_CASE("three MOVC are a line to the start of a circle, a point on it, and its end") {
  const Program program = read_circles(
      "MOVL C00000 V=10\nMOVC C00001 V=10\nMOVC C00002 V=10\nDOUT OT#(1) ON\nMOVC C00003 V=10\n");
  CHECK(program.left_alone.empty());
  REQUIRE(program.moves.size() == 3);
  CHECK(!program.moves[1].arc);
  CHECK(!program.moves[1].may_split);
  REQUIRE(program.moves[2].arc);
  CHECK((program.moves[2].arc->centre_mm - Vector3(20, 0, 0)).norm() < 1e-9);
  CHECK(program.moves[2].arc->clockwise);
  CHECK(!program.moves[2].may_split);
}

TEST_CASE("the points of a circle are at one place of the rail") {
  const std::string positions = circle_positions + "BC00000=10.000\nBC00001=20.000\n";
  const auto circle = [&](const std::string& point) {
    return read_job(job_of(positions,
                           "MOVL C00000 BC00000 V=10\nMOVC C00001 BC00000 V=10\nMOVC C00002" + point +
                               " V=10\nMOVC C00003 V=10\n",
                           6));
  };
  CHECK(circle("").left_alone.empty());
  CHECK(circle(" BC00000").left_alone.empty());
  CHECK(why_of(circle(" BC00001")) == "the points of a MOVC circle differ in frame, tool or external axes");
}

TEST_CASE("FPT ends a circle and begins the next one at its point") {
  const Program program = read_circles(
      "MOVC C00001 V=10\nMOVC C00002 V=10\nMOVC C00003 V=10 FPT\nMOVC C00004 V=10\nMOVC C00005 V=10\n");
  CHECK(program.left_alone.empty());
  REQUIRE(program.moves.size() == 3);
  CHECK((program.moves[1].arc->centre_mm - Vector3(20, 0, 0)).norm() < 1e-9);
  CHECK((program.moves[2].arc->centre_mm - Vector3(40, 0, 0)).norm() < 1e-9);
}

TEST_CASE("MOVC whose circle is not known are not followed") {
  const std::string unknown =
      "the circle of these MOVC is not known: write three MOVC one after the other, and FPT where a circle "
      "ends and the next one begins";
  CHECK(why_of(read_circles("MOVC C00001 V=10\nMOVC C00002 V=10\n")) == unknown);
  CHECK(why_of(read_circles("MOVC C00001 V=10\nMOVC C00002 V=10\nMOVC C00003 V=10\nMOVC C00004 V=10\n")) ==
        unknown);
  CHECK(why_of(read_circles("MOVC C00001 V=10\nMOVC C00002 V=10\nMOVC C00003 V=10\nMOVC C00004 V=10\n"
                            "MOVC C00005 V=10\n")) == unknown);
  CHECK(why_of(read_circles("MOVC C00001 V=10\n*A\nMOVC C00002 V=10\nMOVC C00003 V=10\n")) == unknown);
}

TEST_CASE("bad jobs are refused with line, column and what to do") {
  const auto refusal = [](const std::string& positions, const std::string& instructions) {
    return refusal_of_job(job_of(positions, instructions, 1));
  };
  const std::string base = "///POSTYPE BASE\n///RECTAN\n";
  CHECK(refusal_of_job("/JOB\n//NAME A\n") ==
        "part.jbi:2:1: error: the job has no //INST: its instructions are missing");
  CHECK(refusal_of_job(job_of(jbi_positions_text, "MOVL C00000 V=10\n")) ==
        "part.jbi:21:6: error: MOVL moves to 'C00000', whose values in line 9 are pulses: their place is not "
        "known; post or convert the job with rectangular positions (///RECTAN)");
  CHECK(refusal_of_job(job_of(jbi_positions_text, "MOVS C00001 V=10\n")) ==
        "part.jbi:21:1: error: MOVS is a spline motion, which is not supported; post the job with MOVL, MOVC "
        "and MOVJ");
  CHECK(refusal(base + "C00000=1,2,3,0,0,0\n", "MOVL C00001 V=10\n") ==
        "part.jbi:13:6: error: the position 'C00001' has no values above //INST; give it a line there");
  CHECK(refusal(base + "C00000=1,2,3,0,0,0\n", "MOVL V=10\n") ==
        "part.jbi:13:1: error: MOVL has no position; write MOVL C00001");
  CHECK(refusal(base + "C00000=1,2,3,0,0\n", "") ==
        "part.jbi:7:1: error: the position 'C00000' has 5 numbers; it needs 6: X, Y, Z, Rx, Ry, Rz");
  CHECK(refusal(base + "C00000=1,2,x3,0,0,0\n", "") ==
        "part.jbi:7:12: error: 'C00000=1,2,x3,0,0,0' is not a position; write "
        "C00001=1.000,2.000,3.000,0.0000,0.0000,0.0000");
  CHECK(refusal(base + "C00000=1,2,3,0,0,0\nC000=1,2,3,0,0,0\n", "") ==
        "part.jbi:8:1: error: the position 'C000' has values in line 7 already; give each position once");
  CHECK(refusal("///RECTAN\nC00000=1,2,3,0,0,0\n", "") ==
        "part.jbi:6:1: error: the position 'C00000' has ///RECTAN but no ///POSTYPE above it: write "
        "///POSTYPE BASE, ROBOT or USER");
  CHECK(refusal("///POSTYPE USER\n///RECTAN\nC00000=1,2,3,0,0,0\n", "") ==
        "part.jbi:7:1: error: the position 'C00000' has ///POSTYPE USER but no ///USER above it; write the "
        "number of the user coordinate system");
  CHECK(refusal("///POSTYPE WORLD\n", "") ==
        "part.jbi:5:12: error: 'WORLD' is not a type of positions; use PULSE, BASE, ROBOT or USER");
  CHECK(refusal("///USER x\n", "") ==
        "part.jbi:5:9: error: 'x' is not the number of ///USER; write ///USER 1");
}

TEST_CASE("the positions of a relative job are in the frame that it names") {
  const std::string text = job_of(jbi_positions_text, "MOVL C00001 V=10\n");
  const auto with_frame = [&](const std::string& frame) {
    std::string relative = text;
    return relative.replace(relative.find("SC,RW\n"), 6, "SC,RW,RJ\n////FRAME " + frame + "\n");
  };
  CHECK(refusal_of_job(with_frame("USER 1")) == "none");
  CHECK(refusal_of_job(with_frame("USER 2")) ==
        "part.jbi:19:16: error: the frame of this relative job is USER 2, but the position in line 13 is in "
        "USER 1; use one user coordinate system");
}

TEST_CASE("text above the instructions and behind END stays, and is not read as instructions") {
  const std::string text =
      "/JOB\r\n//NAME it's\r\n//POS\r\n///NPOS 0,0,0,0,0,0\r\n//ARGINFO\r\n"
      "///ARGTYPE B,,\r\n///COMMENT\r\nC00001 'Arg\r\n//INST\r\n///ATTR SC,RW\r\nNOP\r\n"
      "'\x83\x5C\x83\x8B COMMENT\r\nEND\r\nMOVL C1\r\n";
  const Program program = read_job(text);
  CHECK(program.moves.empty());
  CHECK(rewrite(program, {}, {}).text == text);
}

TEST_CASE("each Yaskawa job of a folder of real programs is reproduced or refused with its line") {
  check_corpus([](const std::filesystem::path& path) { return path.extension() == ".jbi"; }, text_of_file);
}
