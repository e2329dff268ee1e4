// Robot programs divided into parts that a main program calls.
#include "counterflex/program/parts.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "program/robot/fanuc/fanuc.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string tp_header = "  !COUNTERFLEX 1 TEST ;\n";

std::string tp_text() {
  return tp_program(tp_header +
                        "  UFRAME_NUM=1 ;\n  UTOOL_NUM=2 ;\nJ P[1] 50% FINE ;\nL P[2] 9mm/sec CNT10 ;\n"
                        "  !side ;\nL P[30:corner] 9mm/sec CNT10 ;\nJ P[1] 50% FINE ;\n"
                        "L P[2] 9mm/sec CNT10 ;\nL P[4] 9mm/sec CNT10 ;\nL P[2] 9mm/sec CNT10 ;\n",
                    tp_position(1, {0, 0, 50, 180, 0, 0}) + tp_position(2, {0, 0, 0, 180, 0, 0}) +
                        "P[30:\"corner\"]" + tp_position(3, {100, 0, 0, 180, 0, 10}).substr(4) +
                        tp_position(4, {100, 80, 0, 180, 0, 10}));
}

const std::string krl_begin =
    "&ACCESS RVO1\nDEF job( )\n;COUNTERFLEX 1 TEST\nINI\n$BASE=BASE_DATA[2]\nPTP {A1 0}\n";
const std::string krl_body =
    "LIN {X 1,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n"
    ";FOLD side\n"
    "$VEL.CP=0.1\n"
    "LIN {X 2} C_DIS ;down\n"
    ";ENDFOLD\n"
    "PTP {X 3,Y 0,Z 9,A 0,B 0,C 0,S 2,T #UP}\n"
    "CIRC {X 4,Y 1},{X 5,Y 0},CA 90 C_DIS\n"
    "LIN {X 6} C_DIS\n";
const std::string krl_end = "$OUT[3]=FALSE\nPTP {A1 0}\nEND\n";

std::string tp_problem(const std::string& statement) {
  const std::string text = tp_program("L P[1] 9mm/sec FINE ;\n" + statement + " ;\n", tp_square());
  return diagnostic_of([&] { divide_program("job.ls", "fanuc_tp", text, 100); });
}

std::string krl_problem(const std::string& statement) {
  const std::string text = krl_begin + "LIN {X 1} C_DIS\n" + statement + "\nLIN {X 2} C_DIS\n" + krl_end;
  return diagnostic_of([&] { divide_program("job.src", "kuka", text, 100); });
}

}  // namespace

TEST_CASE("a FANUC program is divided into parts before joint motions, with positions of their own") {
  const std::vector<ProgramPart> parts = divide_program("job.ls", "fanuc_tp", tp_text(), 5);
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].name == "JOB");
  CHECK(parts[0].text ==
        "/PROG  JOB\n/ATTR\nCOMMENT\t\t= \"by hand\";\nLINE_COUNT\t= 3;\n/MN\n   1:  !COUNTERFLEX 1 TEST ;\n"
        "   2:  CALL JOB_1    ;\n   3:  CALL JOB_2    ;\n/POS\n/END\n");
  CHECK(
      parts[1].text ==
      "/PROG  JOB_1\n/ATTR\nCOMMENT\t\t= \"by hand\";\nLINE_COUNT\t= 7;\n/MN\n   1:  !COUNTERFLEX 1 TEST ;\n"
      "   2:  UFRAME_NUM=1 ;\n   3:  UTOOL_NUM=2 ;\n   4:J P[1] 50% FINE ;\n   5:L P[2] 9mm/sec CNT10 ;\n"
      "   6:  !side ;\n   7:L P[3:corner] 9mm/sec CNT10 ;\n/POS\n" +
          tp_position(1, {0, 0, 50, 180, 0, 0}) + tp_position(2, {0, 0, 0, 180, 0, 0}) + "P[3:\"corner\"]" +
          tp_position(3, {100, 0, 0, 180, 0, 10}).substr(4) + "/END\n");
  CHECK(parts[2].name == "JOB_2");
  CHECK(parts[2].text.find("TEST ;\n   2:J P[1] 50% FINE ;\n   3:L P[2] 9mm/sec CNT10 ;\n"
                           "   4:L P[3] 9mm/sec CNT10 ;\n   5:L P[2] 9mm/sec CNT10 ;\n/POS\n") !=
        std::string::npos);
}

TEST_CASE("the parts of a FANUC program have the targets of the program") {
  const Program whole = read_tp(tp_text());
  for (const std::size_t most : {1u, 2u, 3u, 4u, 5u}) {
    CAPTURE(most);
    const std::vector<ProgramPart> parts = divide_program("job.ls", "fanuc_tp", tp_text(), most);
    std::vector<Vector3> ends;
    for (std::size_t k = 1; k < parts.size(); ++k) {
      // The frame of a part is selected in an earlier one.
      std::string text = parts[k].text;
      text.insert(text.find("/MN\n") + 4, "   1:  UFRAME_NUM=1 ;\n   2:  UTOOL_NUM=2 ;\n");
      const Program part = read_tp(text);
      CHECK(part.moves.size() <= most);
      for (const Move& move : part.moves) ends.push_back(move.end_mm);
    }
    REQUIRE(ends.size() == whole.moves.size());
    for (std::size_t i = 0; i < ends.size(); ++i) CHECK(ends[i] == whole.moves[i].end_mm);
  }
}

TEST_CASE("a second line /MN of a FANUC program does not repeat statements in its parts") {
  std::string text = tp_text();
  text.insert(text.find("/POS"), "/MN\n");
  const std::vector<ProgramPart> parts = divide_program("job.ls", "fanuc_tp", text, 5);
  const std::vector<ProgramPart> wanted = divide_program("job.ls", "fanuc_tp", tp_text(), 5);
  REQUIRE(parts.size() == wanted.size());
  for (std::size_t i = 0; i < parts.size(); ++i) CHECK(parts[i].text == wanted[i].text);
}

TEST_CASE("a KUKA program is divided into subprograms in files of their own, not inside of folds") {
  const std::vector<ProgramPart> parts = divide_program("job.src", "kuka", krl_begin + krl_body + krl_end, 3);
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].text == krl_begin + "job_1( )\njob_2( )\n" + krl_end);
  const std::size_t cut = krl_body.find("PTP");
  const std::string head = "&ACCESS RVO1\nDEF job_", header = "( )\n;COUNTERFLEX 1 TEST\n";
  CHECK(parts[1].name == "job_1");
  CHECK(parts[1].text == head + "1" + header + krl_body.substr(0, cut) + "END\n");
  CHECK(parts[2].text == head + "2" + header + krl_body.substr(cut) + "END\n");
}

TEST_CASE("a program whose statements depend on the main program is not divided") {
  const std::string tail = "; divide it where it was posted, or give --max-points a larger number";
  CHECK(tp_problem("R[1]=5") == "none");
  CHECK(tp_problem("JMP LBL[1]") ==
        "job.ls:7:1: error: the program cannot be divided into parts: 'JMP LBL[1]' "
        "may depend on the place of other statements" +
            tail);
  CHECK(tp_problem("WAIT DI[1]=ON TIMEOUT,LBL[1]") ==
        "job.ls:7:1: error: the program cannot be divided into parts: 'WAIT DI[1]=ON TIMEOUT,LBL[1]' jumps" +
            tail);
  CHECK(tp_problem("PR[1]=P[R[2]]").find("is computed") != std::string::npos);
  for (const char* statement : {"$APO.CDIS=2.5", "$VEL={CP 0.1,ORI1 200}", "WAIT SEC 0.5", "; comment",
                                "$TOOL=TOOL_DATA[3]", "$ORI_TYPE=#VAR", "LIN_REL {X 1} #BASE"})
    CHECK(krl_problem(statement) == "none");
  CHECK(krl_problem("LIN corner C_DIS") ==
        "job.src:8:1: error: the program cannot be divided into parts: 'corner' may need what only the main "
        "program has" +
            tail);
  for (const char* statement : {"IF $IN[1] THEN", "n=1", "DECL INT n", "next()", "$VEL.CP=fast", "GOTO end",
                                "LIN {X 1,Y wide} C_DIS", "RETURN", "LIN {X 1}:shift"})
    CHECK(krl_problem(statement).find("cannot be divided") != std::string::npos);
}

namespace {

const std::string rapid_begin =
    "%%%\n  VERSION:1\n%%%\nMODULE job\n! COUNTERFLEX 1 TEST\n"
    "  CONST robtarget corner:=[[5,5,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "  LOCAL VAR num hidden:=3;\n"
    "  PROC main()\n    VAR num n:=1;\n    ConfL\\Off;\n";
const std::string rapid_end =
    "    MoveAbsJ home,v100,fine,t;\n  ENDPROC\n  PROC other()\n  ENDPROC\nENDMODULE\n";

std::string rapid_line(const std::string& head, int x, const std::string& zone = "z1") {
  return "    " + head + " [[" + std::to_string(x) +
         ",0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20," + zone + ",t; ! " + std::to_string(x) +
         "\n";
}

const std::string rapid_body = rapid_line("MoveL", 1) + "    SetDO spindle,1;\n    ! side\n" +
                               rapid_line("MoveL", 2) + rapid_line("MoveJ", 3) +
                               "    MoveL corner,v20,z1,t;\n" + rapid_line("MoveL", 5);

std::string rapid_problem(const std::string& statement) {
  const std::string text =
      rapid_begin + rapid_line("MoveL", 1) + "    " + statement + "\n" + rapid_line("MoveL", 2) + rapid_end;
  return diagnostic_of([&] { divide_program("job.mod", "abb", text, 100); });
}

}  // namespace

TEST_CASE("an ABB program is divided into modules with a routine each") {
  const std::vector<ProgramPart> parts =
      divide_program("job.mod", "abb", rapid_begin + rapid_body + rapid_end, 3);
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].text == rapid_begin + "    run_job_1;\n    run_job_2;\n" + rapid_end);
  const std::size_t cut = rapid_body.find("    MoveJ");
  const std::string head = "%%%\n  VERSION:1\n%%%\nMODULE job_",
                    header = "\n! COUNTERFLEX 1 TEST\n  PROC run_job_", tail = "  ENDPROC\nENDMODULE\n";
  CHECK(parts[1].name == "job_1");
  CHECK(parts[1].text == head + "1" + header + "1()\n" + rapid_body.substr(0, cut) + tail);
  CHECK(parts[2].text == head + "2" + header + "2()\n" + rapid_body.substr(cut) + tail);
  CHECK(read_program(parts[1].text, "job_1.mod", {}).moves.size() == 2);
}

TEST_CASE("an ABB program whose statements depend on their routine or module is not divided") {
  for (const char* statement : {"count:=count+1;", "WaitTime 0.5;", "MoveJ corner,v100,z10,t;", "other;",
                                "! comment", "SingArea\\Wrist;"})
    CHECK(rapid_problem(statement) == "none");
  CHECK(rapid_problem("n:=2;") ==
        "job.mod:12:1: error: the program cannot be divided into parts: 'n:=2' needs data or a routine that "
        "only the main module has; divide it where it was posted, or give --max-points a larger number");
  CHECK(rapid_problem("WaitTime hidden;").find("only the main module has") != std::string::npos);
  for (const char* statement : {"IF n=1 THEN", "RETURN;", "GOTO end;", "end:", "IF n=1 SetDO x,1;", "ERROR"})
    CHECK(rapid_problem(statement).find("cannot be in another routine") != std::string::npos);
  CHECK(diagnostic_of([] {
          divide_program(
              "job.mod", "abb",
              rapid_begin + rapid_body + "  ENDPROC\n  PROC next()\n" + rapid_line("MoveL", 9) + rapid_end,
              3);
        }).find("a second routine has linear motions") != std::string::npos);
}

TEST_CASE("a language whose programs are not divided states why") {
  CHECK(can_be_divided("abb"));
  for (const char* dialect : {"ur", "apt"}) {
    CHECK(!can_be_divided(dialect));
    CHECK(!why_not_divided(dialect).empty());
  }
}

TEST_CASE("parts of KUKA programs have names of at most 24 characters") {
  const auto problem_of = [](const std::string& name) {
    const std::string begin = "DEF " + name + "( )\n";
    return diagnostic_of(
        [&] { divide_program("job.src", "kuka", begin + "LIN {X 1}\nLIN {X 2}\nEND\n", 1); });
  };
  CHECK(problem_of("finish_of_the_pocket_1") == "none");
  CHECK(problem_of("finish_of_the_pocket_12") ==
        "job.src:1:1: error: the program cannot be divided into parts: the name of its part "
        "finish_of_the_pocket_12_1 is longer than the 24 characters of a name in KRL; divide it where it was "
        "posted, or give --max-points a larger number");
}

TEST_CASE("a part that cannot end in time is refused with its line") {
  CHECK(diagnostic_of([] { divide_program("job.src", "kuka", krl_begin + krl_body + krl_end, 1); }) ==
        "none");
  const std::string fold = ";FOLD\nLIN {X 2}\nLIN {X 3}\n;ENDFOLD\n";
  CHECK(
      diagnostic_of([&] {
        divide_program("job.src", "kuka", krl_begin + "LIN {X 1}\n" + fold + "LIN {X 1}\n" + krl_end, 1);
      }) ==
      "job.src:10:1: error: a part of at most 1 points cannot end before this statement; give --max-points a "
      "larger number");
}
