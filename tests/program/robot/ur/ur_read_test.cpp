// Programs of Universal Robots: reading.
#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/files/files.hpp"
#include "counterflex/program/overview.hpp"
#include "program/robot/ur/ur.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string refusal_of_ur(const std::string& statements) {
  return diagnostic_of([&] { read_ur_statements(statements); });
}

}  // namespace

TEST_CASE("the targets of movej, movel and movep are read in mm, with rotation vector, feed and stop") {
  const Program program = read_ur(ur_milling);
  CHECK(program.dialect == "ur");
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.left_alone.size() == 1);
  CHECK(program.left_alone[0].line == 8);
  CHECK(program.left_alone[0].machine_position);
  const Move &rapid = program.moves[0], &down = program.moves[1], &across = program.moves[2];
  CHECK(rapid.line == 9);
  CHECK(rapid.motion == Motion::rapid);
  CHECK(!rapid.known_start[0]);
  CHECK(all_known(rapid.known_end));
  CHECK(!rapid.may_split);
  CHECK((rapid.end_mm - Vector3(700, 250, 600)).norm() < 1e-9);
  CHECK(rapid.unit == LengthUnit::metres);
  CHECK(down.motion == Motion::feed);
  CHECK((down.start_mm - Vector3(700, 250, 600)).norm() < 1e-9);
  CHECK((down.end_mm - Vector3(700, 250, 500)).norm() < 1e-9);
  CHECK(down.feed_mm_min == doctest::Approx(3000));
  CHECK(down.may_split);
  CHECK(down.may_jump);
  CHECK(!down.exact_stop);
  CHECK(program.operations[down.operation] == "POCKET");
  CHECK(across.feed_mm_min == doctest::Approx(6000));
  CHECK((across.end_mm - Vector3(800, 250, 500)).norm() < 1e-9);
  CHECK(across.orientation->form == OrientationForm::rotation_vector);
  CHECK(!across.orientation->by_angles);
  CHECK(across.orientation->start == OrientationNumbers{-1.2092, -1.2092, -1.2092});
  CHECK(across.orientation->end == OrientationNumbers{0, 3.1415927, 0});
  CHECK(program.frames[across.frame] == ProgramFrame{});
  CHECK(zones_in_words(program.zones) == "round 2 targets, largest 2 mm, line 10");
  CHECK(program.remarks.empty());
}

TEST_CASE("a rotation vector of URScript is the axis and angle of the tool's orientation") {
  // Equal components of 120 degrees in length: X goes to Y, Y to Z, Z to X.
  const Program program =
      read_ur_statements("movel(p[0, 0, 0, 1.2091995761561452, 1.2091995761561452, 1.2091995761561452])\n");
  const Matrix3 R = turn_of(*program.moves[0].orientation).end;
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-12);
  CHECK((R * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-12);
  CHECK((R * Vector3::UnitZ() - Vector3::UnitX()).norm() < 1e-12);
}

TEST_CASE("a move that stops, that states its time or that follows an unknown zone is not split") {
  const Program program = read_ur_statements(
      "movel(p[0,0,0,0,0,0])\n"
      "movel(p[1,0,0,0,0,0])\n"
      "movel(p[2,0,0,0,0,0],r=0)\n"
      "movel(p[3,0,0,0,0,0],1.2,0.25,2,0.01)\n"
      "movel(p[4,0,0,0,0,0],r=read_zone())\n"
      "movel(p[5,0,0,0,0,0],r=0.01)\n"
      "movel(p[6,0,0,0,0,0],r=0.01,v=fast)\n"
      "movel(p[7,0,0,0,0,0],r=0.01,t=later)\n");
  REQUIRE(program.moves.size() == 8);
  CHECK(program.moves[1].exact_stop);
  CHECK(program.moves[1].feed_mm_min == 15000);  // the default of 0.25 m/s
  CHECK(!program.moves[1].may_split);
  CHECK(program.moves[2].exact_stop);
  CHECK(!program.moves[3].exact_stop);
  CHECK(!program.moves[3].may_split);
  CHECK(program.moves[3].feed_mode == FeedMode::inverse_time);
  CHECK(program.moves[3].feed_per_min == doctest::Approx(30));  // in 2 s
  CHECK(!program.moves[4].may_split);
  CHECK(!program.moves[5].may_split);
  CHECK(program.moves[6].may_split);
  CHECK(program.moves[6].feed_mm_min == 0);
  CHECK(!program.moves[6].may_jump);
  CHECK(!program.moves[7].may_split);
  CHECK(program.moves[7].feed_mm_min == 0);
}

TEST_CASE("a pose that is not a constant before its use is not followed") {
  const Program program = read_ur_statements(
      "movel(late)\n"
      "late = p[0,0,0,0,0,0]\n"
      "loop = p[0,0,0,0,0,0]\n"
      "movel(loop)\n"
      "while (a):\n"
      "  loop = p[1,0,0,0,0,0]\n"
      "end\n"
      "part = p[0,0,0,0,0,0]\n"
      "part[2] = 0.5\n"
      "movel(part)\n"
      "movel(p[x,0,0,0,0,0])\n"
      "movel(pose_add(late, late))\n"
      "if (a):\n"
      "  maybe = p[0,0,0,0,0,0]\n"
      "end\n"
      "movel(maybe)\n"
      "movej(maybe)\n");
  REQUIRE(program.moves.size() == 6);
  for (const Move& move : program.moves) CHECK(move.fixed[0]);
  REQUIRE(program.left_alone.size() == 2);
  CHECK(program.left_alone[0].line == 2);
  CHECK(program.left_alone[0].why == "the target of movel is computed at run time");
  CHECK(program.left_alone[1].line == 18);
}

TEST_CASE("a variable of straight code has the value of its last assignment before the use") {
  const Program program = read_ur_statements(
      "zone = 0\n"
      "P = p[0,0,0,0,0,0]\n"
      "P = p[1,0,0,0,0,0]\n"
      "movel(P,r=zone)\n"
      "zone = 0.002\n"
      "P = p[2,0,0,0,0,0]\n"
      "movel(P,r=zone)\n"
      "def local_names():\n"
      "  other = p[9,0,0,0,0,0]\n"
      "end\n"
      "local_names()\n"
      "movel(P)\n"
      "grip()\n"
      "movel(P)\n"
      "P = p[3,0,0,0,0,0]\n"
      "movel(P)\n");
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[0].end_mm.x() == 1000);
  CHECK(program.moves[0].exact_stop);
  CHECK(program.moves[1].end_mm.x() == 2000);
  CHECK(program.moves[1].zone->length_mm == 2);
  CHECK(program.moves[2].end_mm.x() == 2000);
  CHECK(program.moves[3].fixed[0]);  // grip might assign P
  CHECK(program.moves[4].end_mm.x() == 3000);
}

TEST_CASE("circles that are not known are not followed") {
  const Program program = read_ur_statements(
      "movec(p[0,0.01,0,0,0,0], p[-0.01,0,0,0,0,0])\n"
      "movel(p[0.01,0,0,0,0,0])\n"
      "movec(p[0,0.01,0,0,0,0], p[-0.01,0,0,0,0,0], mode=1)\n"
      "movel(p[0.01,0,0,0,0,0])\n"
      "movec(p[0.005,0,0,0,0,0], p[0,0,0,0,0,0])\n");
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[0].fixed[0]);
  CHECK(program.moves[2].fixed[0]);
  CHECK(program.moves[4].fixed[0]);
}

TEST_CASE("joint positions, calls, loops and conditions leave the position unknown") {
  const Program program = read_ur_statements(
      "movel(p[0,0,0,0,0,0])\n"
      "movel([0,0,0,0,0,0])\n"
      "movel(p[0.1,0,0,0,0,0])\n"
      "set_digital_out(1, True)\n"
      "movel(p[0.2,0,0,0,0,0])\n"
      "grip(20)\n"
      "movel(p[0.3,0,0,0,0,0])\n"
      "while (True):\n"
      "  if get_digital_in(1):\n"
      "    movel(p[0.4,0,0,0,0,0])\n"
      "  else:\n"
      "    movej(p[0.5,0,0,0,0,0])\n"
      "  end\n"
      "end\n"
      "movel(p[0.6,0,0,0,0,0])\n"
      "def helper():\n"
      "  movel(p[0.7,0,0,0,0,0])\n"
      "end\n"
      "movel(p[0.8,0,0,0,0,0])\n"
      "x = helper()\n"
      "movel(p[0.9,0,0,0,0,0])\n");
  std::vector<std::pair<bool, bool>> known;
  for (const Move& move : program.moves)
    known.emplace_back(all_known(move.known_start), all_known(move.known_end));
  const std::vector<std::pair<bool, bool>> expected{{false, true}, {false, true}, {true, true},
                                                    {false, true}, {true, false}, {false, true},
                                                    {true, false}, {false, true}, {false, true}};
  CHECK(known == expected);
  CHECK(unchanged(program) == program.text);
}

TEST_CASE("a function of the program in a condition or in an argument makes the position unknown") {
  const std::string probe = "def probe():\n  movel(p[0.5,0,0,0,0,0])\n  return True\nend\n";
  const auto is_known_behind = [&](const std::string& statements) {
    CAPTURE(statements);
    const Program program = read_ur_statements(probe + "movel(p[0,0,0,0,0,0])\n" + statements);
    return all_known(program.moves.back().known_start);
  };
  const std::string line = "movel(p[0.1,0,0,0,0,0])\n";
  CHECK(is_known_behind("if is_steady():\nsync()\nend\n" + line));
  CHECK(is_known_behind("movel(p[0.1,0,0,0,0,0], v=speed)\n"));
  CHECK(!is_known_behind("if probe():\nsync()\nend\n" + line));
  CHECK(!is_known_behind("while not probe():\nsync()\nend\n" + line));
  CHECK(!is_known_behind("movel(p[0.1,0,0,0,0,0], v=probe())\n"));
  CHECK(!is_known_behind("sleep(probe())\n" + line));
  CHECK(!is_known_behind("ok = probe()\n" + line));
}

TEST_CASE("a function or a thread of the program that does not move the robot leaves the position known") {
  const auto is_known_behind = [](const std::string& functions, const std::string& call) {
    CAPTURE(functions);
    const Program program =
        read_ur_statements(functions + "movel(p[0,0,0,0,0,0])\n" + call + "movel(p[0.1,0,0,0,0,0])\n");
    return all_known(program.moves.back().known_start) && program.left_alone.empty();
  };
  const auto body = [](const std::string& statements) { return "def part(n):\n" + statements + "end\n"; };
  const std::string call = "part(3)\n";
  CHECK(
      is_known_behind(body("set_digital_out(1, True)\nif (n > 0):\nsleep(sqrt(n))\nend\nreturn n\n"), call));
  CHECK(is_known_behind(body("textmsg(\"call movel(p) now\")\n"), call));
  CHECK(is_known_behind(body("inner()\n") + "def inner():\nset_flag(1, True)\nend\n", call));
  CHECK(is_known_behind(body("sync()\n"), "x = part(3)\n"));
  CHECK(is_known_behind("thread blink():\nwhile True:\nset_flag(1, True)\nsleep(1)\nend\nend\n",
                        "t = run blink()\n"));
  CHECK_FALSE(
      is_known_behind(body("inner()\n") + "def inner():\nif n:\nmovej([0,0,0,0,0,0])\nend\nend\n", call));
  CHECK_FALSE(is_known_behind(body("set_tcp(p[0,0,0.1,0,0,0])\n"), call));
  CHECK_FALSE(is_known_behind(body("elsewhere(3)\n"), call));
  CHECK_FALSE(is_known_behind(body("x = 3 + elsewhere (3)\n"), call));
}

TEST_CASE("a function that is named as poses begin is called by its brackets alone") {
  for (const char* name : {"p", "prog"}) {
    const Program program =
        read_ur(std::string("def ") + name + "():\nmovel(p[0,0,0,0,0,0])\nmovel(p[0.1,0,0,0,0,0])\nend\n");
    CHECK(program.left_alone.empty());
    REQUIRE(program.moves.size() == 2);
    CHECK(all_known(program.moves[1].known_start));
  }
}

TEST_CASE("another tool makes the position unknown, the same tool does not") {
  const Program program = read_ur_statements(
      "tool = p[0,0,0.1,0,0,0]\n"
      "set_tcp(tool)\n"
      "movel(p[0,0,0,0,0,0])\n"
      "set_tcp(p[0,0,0.1,0,0,0])\n"
      "movel(p[0.1,0,0,0,0,0])\n"
      "set_tcp(p[0,0,0.2,0,0,0])\n"
      "movel(p[0.2,0,0,0,0,0])\n"
      "set_tcp(measured)\n"
      "movel(p[0.3,0,0,0,0,0])\n");
  CHECK(all_known(program.moves[1].known_start));
  CHECK(!program.moves[2].known_start[0]);
  CHECK(!program.moves[3].known_start[0]);
}

TEST_CASE("a function that is not in the script may cut, and the report shows what it must not change") {
  const auto read = [](const std::string& call) {
    return read_ur_statements("def own():\nmovej([0,0,0,0,0,0])\nend\nmovel(p[0,0,0,0,0,0])\n" + call +
                              "\nmovel(p[0.1,0,0,0,0,0])\n");
  };
  const Program own = read("own()"), other = read("other()");
  CHECK_FALSE(own.left_alone.back().feeds);
  CHECK(own.remarks.empty());
  CHECK(other.left_alone.back().feeds);
  REQUIRE(other.remarks.size() == 1);
  CHECK(other.remarks[0].what.starts_with(
      "assumed from here on: called programs do not change features and the tool centre point"));
}

TEST_CASE("a function that is not in the script may cut in an expression, too") {
  const std::string move = "movel(p[0,0,0.1,0,0,0], r=0.001)\n";
  const auto calls_of = [&](const std::string& statement) {
    CAPTURE(statement);
    const Program program = read_ur_statements(move + statement + move);
    return std::ranges::count_if(program.left_alone, [](const LeftAlone& block) { return block.feeds; });
  };
  for (const char* statement : {"ok = f(3)\n", "ok = server.next(3)\n", "local ok = 1 + f (3)\n",
                                "ok[f(3)] = 1\n", "if f(3) == 2:\nend\n", "while not f(3):\nend\n",
                                "return f(3)\n", "textmsg(f(3))\n", "ok = [1, f(3)]\n", "ok = norm(f(3))\n"})
    CHECK(calls_of(statement) == 1);
  for (const char* statement :
       {"x = sin(a) + cos(1e-3) * (2 + b) - .5\n", "x = get_actual_tcp_pose()\n",
        "x = pose_trans(p[0,0,0,0,0,0], y)\n", "x = [1, 2, norm(y), -1]\n",
        "if (a == 1) and not (b) or (c):\nend\n", "textmsg(\"f(3) of\", a)\n", "x = y[1].z[2]\n",
        "x = y.length() xor True\n", "x = normalize(wrench_trans(a, b))\n", "x = \"a b\"\n",
        "x = not is_steady()\n", "x = binary_list_to_integer([True, False])\n",
        "x = struct(a = 1, b = [2])\n"})
    CHECK(calls_of(statement) == 0);
}

TEST_CASE("a motion or another tool is a statement of its own") {
  const std::string part = " is a part of another statement; write each statement into a line of its own";
  const std::string pose = "(p[0,0,0.1,0,0,0])";
  const auto refusal = [](const std::string& statement) {
    return diagnostic_of([&] { read_ur_statements("x = 1\n" + statement + "\n"); });
  };
  CHECK(refusal("x=movel" + pose) == "job.script:3:3: error: the call of movel" + part);
  CHECK(refusal("x = [1, movel" + pose + "]") == "job.script:3:9: error: the call of movel" + part);
  CHECK(refusal("x = 1 set_tcp" + pose) == "job.script:3:7: error: the call of set_tcp" + part);
  CHECK(refusal("if movel" + pose + ":") == "job.script:3:4: error: the call of movel" + part);
  CHECK(refusal("x = freedrive_mode()") == "job.script:3:5: error: the call of freedrive_mode" + part);
  CHECK(
      refusal("x = force_mode" + pose)
          .starts_with("job.script:3:5: error: force_mode shifts the tool away from the programmed targets"));
  CHECK(refusal("x = 1 y = p[0.6,0,0,0,0,0]") ==
        "job.script:3:7: error: unexpected text behind the value of x; write each statement into a line of "
        "its own");
  CHECK(refusal("x = a(1) b").starts_with("job.script:3:10: error: unexpected text behind the value of x"));
}

TEST_CASE("what URScript shifts at run time, and text that is not a program, is refused with its line") {
  CHECK(refusal_of_ur("\nforce_mode(p[0,0,0,0,0,0])\n")
            .starts_with("job.script:3:1: error: force_mode shifts"));
  CHECK(refusal_of_ur("movel(p[0,0,0,0,0,0]\n")
            .starts_with("job.script:2:6: error: the arguments of movel have"));
  CHECK(refusal_of_ur("movel(p[0,0,0,0,0,0]) movel(P1)\n")
            .starts_with("job.script:2:22: error: unexpected text"));
  CHECK(refusal_of_ur("movel()\n").starts_with("job.script:2:1: error: movel has no target"));
  CHECK(refusal_of_ur("movec(, p[0,0,0,0,0,0])\n") ==
        "job.script:2:7: error: argument 1 of movec is empty; write its value, or remove its comma");
  CHECK(refusal_of_ur("movel(p[0,0,0,0,0,0], a=1.0,, 0.1)\n")
            .starts_with("job.script:2:29: error: argument 3"));
  CHECK(refusal_of_ur("set_tcp(p[0,0,0,0,0,0],)\n").starts_with("job.script:2:24: error: argument 2"));
  CHECK(refusal_of_ur("movel(p[0,0,0,0,0,0], v=)\n").find("argument 2 of movel is empty") !=
        std::string::npos);
  CHECK(refusal_of_ur("if x: movel(P1)\nend\n").starts_with("job.script:2:1: error: the line of 'if'"));
  CHECK(refusal_of_ur("end\ndef other():\n").starts_with("job.script:3:1: error: this is a second function"));
  CHECK(refusal_of_ur("<<<<<<< HEAD\n").starts_with("job.script:2:1: error: '<<<<<<<' is a conflict marker"));
  CHECK(refusal_of_ur("+5\n").starts_with("job.script:2:1: error: the statement is not URScript"));
  CHECK(diagnostic_of([] { read_ur("movel(p[0,0,0,0,0,0])\nend\n"); }) ==
        "job.script:2:1: error: 'end' closes nothing");
}
