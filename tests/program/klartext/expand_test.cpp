#include <doctest/doctest.h>

#include <algorithm>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext: repeated parts and subprograms replace their calls") {
  const Program program = expanded_klartext(
      klartext({"L X+0 Y+0 Z+5 FMAX", "LBL 5", "L IX+10 F100", "CALL LBL \"HOLE\"", "L IY+1",
                "CALL LBL 5 REP 2/2", "L Z+9", "M30", "LBL \"HOLE\"", "L IZ-1 ~\nF50 ; down", "LBL 0"}));
  CHECK(program.text ==
        klartext({"L X+0 Y+0 Z+5 FMAX", "LBL 5", "L IX+10 F100", "L IZ-1 ~\nF50 ; down", "L IY+1",
                  "L IX+10 F100", "L IZ-1 ~\nF50 ; down", "L IY+1", "L IX+10 F100", "L IZ-1 ~\nF50 ; down",
                  "L IY+1", "L Z+9", "M30", "LBL \"HOLE\"", "L IZ-1 ~\nF50 ; down", "LBL 0"}));
  CHECK(program.left_alone.empty());
  CHECK(program.expansion.calls == 5);
  std::vector<int> lines;
  for (const Move& move : program.moves) lines.push_back(move.line);
  CHECK(lines == std::vector<int>{2, 4, 11, 6, 4, 11, 6, 4, 11, 6, 8});
  CHECK(program.moves.back().end_mm == Vector3(30, 3, 9));
}

TEST_CASE("klartext: calls that cannot be replaced stay, with the reason") {
  for (const auto& [call, why] :
       {std::pair{"CALL LBL 7", "line 3: LBL 7 is missing"},
        {"CALL LBL 1", "line 6: LBL 1 calls itself"},
        {"CALL LBL Q1", "line 3: the label is a Q parameter"},
        {"/CALL LBL 2", "line 3: '/' may skip the call"},
        {"CALL LBL 2 REP 3", "line 3: LBL 2 is not before its REP"},
        {"CALL LBL 3", "line 12: a subprogram ends the program"},
        {"CALL LBL 2\nFN 9: IF +Q1 EQU +1 GOTO LBL 2", "line 4: the program jumps to a label"}}) {
    const std::string shown = call;
    CAPTURE(shown);
    const Program program = expanded_klartext(
        "BEGIN PGM A MM\nL X+0 Y+0 Z+5 FMAX\n" + shown +
        "\nM30\nLBL 1\nCALL LBL 1\nLBL 0\nLBL 2\nL IX+1\nLBL 0\nLBL 3\nL IX+1 M2\nLBL 0\nEND PGM A MM\n");
    CHECK(program.expansion.calls == 0);
    CHECK(program.moves.at(1).fixed[0]);
    const std::string reason =
        std::string(
            "a subprogram or a part of the program is called and cannot be put in the place of its call: ") +
        why;
    CHECK(std::any_of(program.left_alone.begin(), program.left_alone.end(),
                      [&](const LeftAlone& left) { return left.why == reason; }));
  }
  CHECK(diagnostic_of([&] {
          expanded_klartext(klartext({"LBL 1", "L IX+1", "CALL LBL 1 REP 900000000"}));
        }).find("the expansion adds more than 500000 lines") != std::string::npos);
}

TEST_CASE("Q parameters set to constants are evaluated with --evaluate") {
  const std::string begin =
      "BEGIN PGM A MM\nL X+0 Y+0 Z+5 FMAX\nFN 0: Q1 = +12,5\nQ2 = Q1 * 2 - 5\nFN 4: Q3 = +Q2 DIV +8\n";
  ReadOptions options{.dialect = "heidenhain", .evaluate = true};
  const auto last = [&](const std::string& statements) {
    return read_program(begin + statements + "END PGM A MM\n", "p.h", options).moves.back();
  };
  const Move line = last("L X+Q1 IY-Q3 F200\n");
  CHECK(all_known(line.known_end));
  CHECK((line.end_mm - Vector3(12.5, -2.5, 5)).norm() < 1e-12);
  CHECK(last("FN 5: Q1 = SQRT +4\nL X+Q1 F200\n").end_mm.x() == 2);
  CHECK(last("CC X+Q1 Y+0\nL X+0 Y+0\nC X+25 Y+0 DR-\n").arc);
  for (const char* doubt :
       {"FN 18: SYSREAD Q1 = ID270 NR1 IDX3\n", "/ Q1 = 5\n", "CALL PGM OTHER\nL X+0 Y+0 Z+5\n",
        "Q1 = SIN Q9\n", "FN #0: Q1 = +5\n", "LBL 1\nQ1 = Q1 + 1\nCALL LBL 1 REP 3\nL X+0 Y+0 Z+5\n",
        "FN 5: Q1 = SQRT -4\n", "FN 23: Q0 = CDATA Q30\n", "FN 24: Q1 = CDATA Q30\n", "Q01 = Q9\n",
        "FN 28: TABREAD Q0 = 6 /\"X,Y,D\"\n",
        "CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM B\nL X+0 M99\nL X+0 Y+0 Z+5\n"}) {
    CAPTURE(doubt);
    CHECK_FALSE(last(std::string(doubt) + "L X+Q1 F200\n").known_end[0]);
  }
  CHECK_FALSE(last("L X+Q100 F200\n").known_end[0]);
  options.evaluate = false;
  CHECK_FALSE(last("L X+Q1 F200\n").known_end[0]);
}
