// Programs of KUKA robots whose targets are in data lists.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/program/program_files.hpp"
#include "counterflex/program/program_reader.hpp"
#include "program/reading.hpp"
#include "program/robot/corpus.hpp"
#include "program/robot/edits.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string loop_program =
    "DEF job()\n"
    "INT n\n"
    "$VEL.CP=0.1\n"
    "FOR n = 1 TO 3\n"
    "  speed(POINTS[n].f)\n"
    "  LIN POINTS[n].at C_DIS\n"
    "ENDFOR\n"
    "END\n"
    "\n"
    "DEF speed(f:IN)\n"
    "REAL f\n"
    "$VEL.CP=f\n"
    "END\n";

const std::string loop_list =
    "DEFDAT job PUBLIC\n"
    "STRUC target FRAME at, REAL f\n"
    "DECL target POINTS[3]\n"
    "POINTS[1]={at {X 0,Y 0,Z 5,A 0,B 0,C 180},f 0.1}\n"
    "POINTS[2]={at {X 10,Y 0,Z 5,A 0,B 0,C 180},f 0.1}\n"
    "POINTS[ 3 ]={at {X 10,Y 20,Z 5,A 0,B 0,C 180},f 0.2}\n"
    "ENDDAT";

std::string joined(const std::string& program, const std::string& list) {
  return program + "\n&FILE job.dat\n" + list;
}

Program read_joined(const std::string& program, const std::string& list) {
  return read_program(joined(program, list), "job.src", {});
}

std::string refusal_of(const std::string& program, const std::string& list) {
  return diagnostic_of([&] { read_joined(program, list); });
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), by);
}

}  // namespace

TEST_CASE("a loop over an array moves to the targets of the data list") {
  const Program program = read_joined(loop_program, loop_list);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.left_alone.empty());
  CHECK(!program.moves[0].known_start[0]);
  CHECK(program.moves[1].start_mm == Vector3(0, 0, 5));
  CHECK(program.moves[2].end_mm == Vector3(10, 20, 5));
  CHECK(program.moves[2].orientation->end[0] == 180);
  CHECK(program.moves[2].feed_mm_min == 0);  // the loop sets the speed of each target
  CHECK(!program.moves[2].exact_stop);
  CHECK(program.moves[2].may_split);
}

TEST_CASE("targets are changed in the data list, and a program without changes keeps all bytes") {
  const Program program = read_joined(loop_program, loop_list);
  CHECK(rewrite(program, robot_edits(program), {}).text == program.text);
  auto edits = robot_edits(program);
  edits[1].end_mm.x() += 0.25;
  CHECK(rewrite(program, edits, {}).text ==
        joined(loop_program, replaced(loop_list, "X 10,Y 0", "X 10.25,Y 0")));
}

TEST_CASE("inserted targets change the indices behind them, the size of the array and the end of the loop") {
  const Program program = read_joined(loop_program, loop_list);
  auto edits = robot_edits(program);
  edits[1].inserted.push_back({Vector3(5, 0, 5.1), {}, edits[1].orientation});
  std::string list = replaced(loop_list, "POINTS[2]={at {X 10",
                              "POINTS[2]={at {X 5,Y 0,Z 5.1,A 0,B 0,C 180},f 0.1}\nPOINTS[3]={at {X 10");
  list = replaced(list, "POINTS[ 3 ]", "POINTS[ 4 ]");
  list = replaced(list, "DECL target POINTS[3]", "DECL target POINTS[4]");
  const std::string text = rewrite(program, edits, {}).text;
  CHECK(text == joined(replaced(loop_program, "1 TO 3", "1 TO 4"), list));
  const Program again = read_program(text, "job.src", {});
  REQUIRE(again.moves.size() == 4);
  CHECK(again.moves[1].end_mm == Vector3(5, 0, 5.1));
}

TEST_CASE("an array that is larger than its loop keeps its size") {
  const std::string list = replaced(loop_list, "DECL target POINTS[3]", "DECL target POINTS[10]");
  const Program program = read_joined(loop_program, list);
  auto edits = robot_edits(program);
  edits[1].inserted.push_back({Vector3(5, 0, 5.1), {}, edits[1].orientation});
  const std::string text = rewrite(program, edits, {}).text;
  CHECK(text.find("POINTS[10]") != std::string::npos);
  CHECK(text.find("1 TO 4") != std::string::npos);
}

TEST_CASE("a loop that cannot be followed is refused or not corrected") {
  const auto with_statement = [](const std::string& statement) {
    return replaced(loop_program, "  LIN POINTS", "  " + statement + "\n  LIN POINTS");
  };
  CHECK(refusal_of(with_statement("POINTS[n].A=-30"), loop_list)
            .find("job.src:6:3: error: 'POINTS[n].A' is "
                  "computed at run time") == 0);
  CHECK(refusal_of(with_statement("POINTS[n].at.X=1"), loop_list).find("computed at run time") !=
        std::string::npos);
  CHECK(read_joined(with_statement("unknown_routine()"), loop_list).moves[0].fixed[0]);
  CHECK(read_joined(with_statement("x=unknown_function(1)"), loop_list).moves[0].fixed[0]);
  CHECK_FALSE(read_joined(with_statement("x=ABS(1)"), loop_list).moves[0].fixed[0]);
  CHECK(read_joined(with_statement("$BASE=BASE_DATA[n]"), loop_list).moves[0].fixed[0]);
  CHECK(read_joined(with_statement("IF f>1 THEN"), loop_list).moves[0].fixed[0]);
  CHECK(refusal_of(loop_program, replaced(loop_list, "POINTS[2]={", "POINTS[4]={"))
            .find("are not in the order of their indices") != std::string::npos);
  CHECK(refusal_of(replaced(loop_program, "TO 3", "TO 4"), loop_list)
            .find("are not all in the data list: it has 1 to 3") != std::string::npos);
  CHECK(refusal_of(loop_program, "DEFDAT job\nENDDAT\n").find("--data FILE.dat") != std::string::npos);
  CHECK(refusal_of(loop_program, replaced(loop_list, "={at {X 10,Y 0,Z 5,A 0,B 0,C 180},f 0.1}", "=OTHER"))
            .find("does not give 'POINTS[2]' of this loop as a target") != std::string::npos);
  CHECK(refusal_of(loop_program, replaced(loop_list, "X 10,Y 0", "X n,Y 0"))
            .find("is not a target of plain numbers") != std::string::npos);
}

TEST_CASE("no target is inserted into a loop whose statements would do something else in more passes") {
  const auto divides = [](const std::string& statement) {
    const Program program =
        read_joined(replaced(loop_program, "  LIN POINTS", "  " + statement + "\n  LIN POINTS"), loop_list);
    REQUIRE(program.moves.size() == 3);
    return program.moves[2].may_split;
  };
  CHECK(divides("BAS(#VEL_CP,0.5)"));
  CHECK(divides("$VEL.CP=POINTS[n].f"));
  CHECK_FALSE(divides("$VEL.CP=SPEEDS[n]"));
  CHECK_FALSE(divides("IF n==2 THEN\n$VEL.CP=1\nENDIF"));
  CHECK_FALSE(divides("$OUT[8]=TRUE"));
  CHECK_FALSE(divides("TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[8]=TRUE"));
  CHECK_FALSE(divides("count=count+1"));
  CHECK(read_joined(replaced(loop_program, "ENDFOR", "n=n+1\nENDFOR"), loop_list).moves[0].fixed[0]);
  CHECK(read_joined(replaced(loop_program, "ENDFOR", "BAS(#BASE,5)\nENDFOR"), loop_list).moves[0].fixed[0]);
  CHECK(read_joined(replaced(loop_program, "ENDFOR", "next(n)\nENDFOR"), loop_list).moves[0].fixed[0]);
}

TEST_CASE("motion parameters of a data list give base, tool and the turn of the tool") {
  const std::string program =
      "DEF job()\nFDAT_ACT=FP1\nLDAT_ACT=LCPDAT1\nBAS(#CP_PARAMS,0.05)\nLIN XP1\nLDAT_ACT=LCPDAT2\n"
      "BAS(#CP_PARAMS,0.05)\nLIN XP1\nEND\n";
  const Program read = read_joined(program,
                                   "DEFDAT job\n"
                                   "DECL E6POS XP1={X 0,Y 0,Z 5,A 0,B 0,C 180,S 2,T 10}\n"
                                   "DECL FDAT FP1={TOOL_NO 3,BASE_NO 4,IPO_FRAME #BASE,POINT2[] \" \"}\n"
                                   "DECL LDAT LCPDAT1={VEL 2.0,ACC 100.0,APO_DIST 1.0,ORI_TYP #VAR}\n"
                                   "DECL LDAT LCPDAT2={VEL 2.0,ACC 100.0,APO_DIST 1.0,ORI_TYP #CONSTANT}\n"
                                   "ENDDAT\n");
  REQUIRE(read.moves.size() == 2);
  CHECK(read.frames[read.moves[0].frame].work_offset == "BASE_DATA[4]");
  CHECK(read.moves[0].tool == 3);
  CHECK_FALSE(read.moves[0].fixed[0]);
  CHECK(read.moves[1].fixed[0]);  // the control keeps the orientation
}

TEST_CASE("an array that other statements use is not corrected") {
  const std::string program = replaced(loop_program, "ENDFOR\n", "ENDFOR\nLIN POINTS[2].at\n");
  const Program read = read_joined(program, loop_list);
  REQUIRE(!read.moves.empty());
  CHECK(read.moves[0].fixed[0]);
}

TEST_CASE("the moves of a loop are between those before and behind it") {
  std::string program =
      replaced(loop_program, "FOR n", "$BASE=BASE_DATA[2]\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 180}\nFOR n");
  program =
      replaced(program, "ENDFOR\n", "ENDFOR\nLIN {X 4,Y 5,Z 6,A 0,B 0,C 180}\n$BASE=BASE_DATA[3]\nEND\n");
  const Program read = read_joined(program, loop_list);
  REQUIRE(read.moves.size() == 5);
  for (const Move& move : read.moves) CHECK(read.frames[move.frame].work_offset == "BASE_DATA[2]");
  CHECK(read.moves[1].start_mm == Vector3(1, 2, 3));
  CHECK(read.moves[2].start_mm == Vector3(0, 0, 5));
  CHECK(read.moves[4].start_mm == Vector3(10, 20, 5));
  CHECK(unchanged(read) == read.text);
  const std::string behind_home = replaced(program, "FOR n", "PTP HOME\nFOR n");
  CHECK(!read_joined(behind_home, loop_list).moves[1].known_start[0]);
}

TEST_CASE("a target that a data list names is changed there, or in the statement if others use it") {
  const std::string program = "DEF job()\nPTP XHOME\nLIN XP1\nLIN XP2 C_DIS\nLIN XP1\nEND\n";
  const std::string list =
      "DEFDAT job\nDECL E6POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 180,S 2,T 10,E1 0}\nDECL FDAT FP1={TOOL_NO 1}\n"
      "DECL E6POS XP2={X 5,Y 2,Z 3,A 0,B 0,C 180,S 2,T 10,E1 0}\nENDDAT\n";
  const Program read = read_joined(program, list);
  REQUIRE(read.moves.size() == 3);
  CHECK(read.moves[1].end_mm == Vector3(5, 2, 3));
  auto edits = robot_edits(read);
  edits[0].end_mm.z() += 0.1;
  edits[1].end_mm.z() += 0.2;
  const std::string text = rewrite(read, edits, {}).text;
  CHECK(text.find("LIN {X 1,Y 2,Z 3.1,A 0,B 0,C 180,S 2,T 10,E1 0}\nLIN XP2 C_DIS\nLIN XP1\n") !=
        std::string::npos);
  CHECK(text.find("XP1={X 1,Y 2,Z 3,") != std::string::npos);
  CHECK(text.find("XP2={X 5,Y 2,Z 3.2,") != std::string::npos);
}

TEST_CASE("a target in no list is refused with its cure") {
  CHECK(refusal_of("DEF job()\nLIN XP9\nEND\n", loop_list).find("--data FILE.dat") != std::string::npos);
}

TEST_CASE("the size of an array grows where it is declared, and without a declaration nothing is inserted") {
  const std::string list = replaced(loop_list, "DECL target POINTS[3]\n", "");
  const auto with_point = [](const Program& program) {
    std::vector<MoveEdit> edits = robot_edits(program);
    edits[1].inserted.push_back({.end_mm = {5, 0, 5}, .orientation = program.moves[1].orientation->end});
    return rewrite(program, edits, {}).text;
  };
  const std::string declaring = replaced(loop_program, "INT n\n", "INT n\nDECL target POINTS[3]\n");
  CHECK(with_point(read_joined(declaring, list)).find("DECL target POINTS[4]\n") != std::string::npos);
  const Program program = read_joined(loop_program, list);
  CHECK(rewrite(program, robot_edits(program), {}).text == joined(loop_program, list));
  CHECK(
      diagnostic_of([&] { with_point(program); }) ==
      "job.src:6:1: error: targets are inserted into the array POINTS, but neither the program nor its data "
      "lists declare its size; give the list that declares it with --data FILE.dat, or allow a larger "
      "--tolerance-mm");
}

TEST_CASE("a program with a list that is longer than what is read at once is one window") {
  std::string list = "DEFDAT job\nDECL target POINTS[8000]\n";
  for (int i = 1; i <= 8000; ++i)
    list +=
        "POINTS[" + std::to_string(i) + "]={at {X " + std::to_string(i) + ",Y 0,Z 5,A 0,B 0,C 180},f 0.1}\n";
  FileReader bytes = FileReader::of_bytes(joined(replaced(loop_program, "TO 3", "TO 8000"), list));
  ProgramReader reader(bytes, "job.src", {});
  REQUIRE(reader.next());
  CHECK(reader.window().moves.size() == 8000);
  CHECK(!reader.next());
}

TEST_CASE("a list of joint targets alone is read with a program that is longer than what is read at once") {
  std::string program = "DEF job()\nPTP XSTART\nLIN {X 1,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n";
  for (int i = 0; i < 8000; ++i) program += ";" + std::string(40, '-') + "\n";
  FileReader bytes = FileReader::of_bytes(joined(
      program + "END\n", "DEFDAT job\nDECL E6AXIS XSTART={A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}\nENDDAT\n"));
  ReadOptions options;
  options.kinematics = [](const JointPlace& place, std::int32_t, const ProgramFrame&) {
    CHECK(place.joints[1] == doctest::Approx(-1.5707963267948966));
    return std::optional(Pose{});
  };
  ProgramReader reader(bytes, "job.src", options);
  REQUIRE(reader.next());
  REQUIRE(reader.window().moves.size() == 1);
  CHECK(bool(reader.window().moves[0].starts_uncorrected));
}

TEST_CASE("joined files are divided into the same bytes") {
  for (const std::string first : {"a\nb", "a\nb\n", "", "a\r\n"})
    for (const std::string second : {"c", "c\n", "\n", "d\r\n"}) {
      std::string files[3];
      FileSplitter splitter([&](std::size_t file, std::string_view bytes) { files[file] += bytes; });
      const std::string text = first + "\n&FILE x.dat\n" + second + "\n&FILE y.dat\n" + second;
      for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        splitter.add(std::string_view(text).substr(at, end - at));
        at = end;
      }
      splitter.finish();
      CHECK(files[0] == first);
      CHECK(files[1] == second);
      CHECK(files[2] == second);
    }
}

namespace {

/// The program and the data lists beside it whose names begin with its name.
std::string with_lists(const std::filesystem::path& program) {
  std::vector<std::string> files{program.string()};
  for (const auto& entry : std::filesystem::directory_iterator(program.parent_path()))
    if (entry.path().extension() == ".dat" &&
        entry.path().stem().string().starts_with(program.stem().string()))
      files.push_back(entry.path().string());
  FileReader bytes = join_files(files);
  std::string text;
  while (bytes.append(text, 1 << 20) > 0) {
  }
  return text;
}

}  // namespace

TEST_CASE("no target is inserted into the array of a loop whose counter is read outside") {
  const auto stays_whole = [](const std::string& old, const std::string& by) {
    const Program program = read_joined(replaced(loop_program, old, by), loop_list);
    REQUIRE(program.moves.size() == 3);
    return !program.moves[1].may_split;
  };
  const std::string end = "ENDFOR\n", own = "INT n\n";
  for (const char* const reads :
       {"IF n==4 THEN\n$OUT[2]=TRUE\nENDIF\n", "$OUT[n]=TRUE\n", "n=n+1\n", "k = 2*n\n",
        "FOR k = 1 TO n\nENDFOR\n", "FOR n = n TO 9\nENDFOR\n", "FOR n = 1 TO 2\nENDFOR\n$OUT[n]=TRUE\n"}) {
    CAPTURE(std::string(reads));
    CHECK(stays_whole(end, end + reads));
  }
  for (const char* const other : {"", "n=1\n", "FOR n=1 TO 2\n$OUT[n]=TRUE\nENDFOR\n",
                                  "FOR n=1 TO 2\nFOR k=1 TO n\nENDFOR\nENDFOR\n", "; n\n"}) {
    CAPTURE(std::string(other));
    CHECK_FALSE(stays_whole(end, end + other));
  }
  CHECK(stays_whole(own, own + "GLOBAL INTERRUPT DECL 3 WHEN n==3 DO stop()\n"));
  const std::string begin = "DEF speed(f:IN)\n", reader = "$OUT[n]=TRUE\nEND\n";
  CHECK_FALSE(stays_whole(begin, "DEF a(n:IN)\nINT n\n" + reader + begin));
  CHECK_FALSE(stays_whole(begin, "DEF a()\n" + reader + begin));
  const std::string in_list = replaced(loop_program, own, "");  // the data list declares n
  const Program shared = read_joined(replaced(in_list, begin, "DEF a()\n" + reader + begin), loop_list);
  CHECK_FALSE(shared.moves[1].may_split);
  const Program separate =
      read_joined(replaced(in_list, begin, "DEF a()\nINT n\n" + reader + begin), loop_list);
  CHECK(separate.moves[1].may_split);
}

TEST_CASE("each KUKA program of a folder of real programs is reproduced or refused with its line") {
  check_corpus(
      [](const std::filesystem::path& path) {
        return path.filename().string().starts_with("kuka_") && path.extension() == ".src";
      },
      with_lists);
}
