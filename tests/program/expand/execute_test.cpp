/// Execution of loops, conditions and jumps of G-code with constants.
#include <doctest/doctest.h>

#include <algorithm>

#include "program/expand/executed.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// The lines that run, also of a program behind the mark at the begin of a tape.
void check_executed(const std::string& dialect, const std::string& text, const std::string& lines) {
  for (const std::string mark : {"", "%\n"}) {
    CAPTURE(mark + text);
    const Executed e = executed(mark + text, dialect);
    CHECK(e.text == mark + lines);
    CHECK(e.expansion.executed > 0);
    CHECK(e.expansion.in_order);
    CHECK(e.expansion.unexpanded_calls.empty());
  }
}

void check_left(const std::string& dialect, const std::string& text, int line, std::string_view why) {
  CAPTURE(text);
  const Executed e = executed(text, dialect);
  CHECK(e.text == text);
  CHECK_FALSE(e.expansion.in_order);
  const auto& left = e.expansion.unexpanded_calls;
  const auto flow =
      std::find_if(left.begin(), left.end(), [](const UnexpandedCall& one) { return one.is_flow; });
  REQUIRE(flow != left.end());
  CHECK(flow->text_line == line);
  CHECK(flow->why == why);
}

}  // namespace

TEST_CASE("linuxcnc: while, do, repeat and if are executed") {
  check_executed("linuxcnc", "#1=0\no1 while [#1 LT 2]\nX[#1*10] (A)\n#1=[#1+1]\no1 endwhile\nM2\n",
                 "#1=0\nX[#1*10] (A)\n#1=[#1+1]\nX[#1*10] (A)\n#1=[#1+1]\nM2\n");
  check_executed("linuxcnc", "#1=5\no1 do\nX#1\n#1=[#1+1]\no1 while [#1 LE 6]\nM2\n",
                 "#1=5\nX#1\n#1=[#1+1]\nX#1\n#1=[#1+1]\nM2\n");
  check_executed("linuxcnc",
                 "O<n> repeat [1+1]\nN5 X1\nO<n> endrepeat (END)\no2 repeat [0]\nX2\no2 endrepeat\nM2\n",
                 "N5 X1\nN5 X1\nM2\n");
  const std::string branches =
      "o1 if [#1 EQ 1]\nX1\no1 elseif [#1 EQ 2]\nX2\no1 elseif [#1 EQ 3]\nX3\no1 else\nX4\no1 endif\nM2\n";
  for (const std::string number : {"1", "2", "3", "4"})
    check_executed("linuxcnc", "#1=" + number + "\n" + branches, "#1=" + number + "\nX" + number + "\nM2\n");
  check_executed("linuxcnc", "o1 if [0]\nX1\no1 endif\no2 if [0]\nX1\no2 elseif [0]\nX2\no2 endif\nM2\n",
                 "M2\n");
}

TEST_CASE("linuxcnc: break leaves a loop and continue begins the next pass") {
  check_executed(
      "linuxcnc",
      "#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\no3 if [#1 GT 3]\no1 break\n"
      "o3 endif\nX#1\no1 endwhile\nX9\nM2\n",
      "#1=0\n#1=[#1+1]\nX#1\n#1=[#1+1]\n#1=[#1+1]\nX#1\n#1=[#1+1]\nX9\nM2\n");
  check_executed("linuxcnc",
                 "#1=0\no1 do\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 break\no2 endif\nX1\no1 while [1]\nM2\n",
                 "#1=0\n#1=[#1+1]\nX1\n#1=[#1+1]\nM2\n");
  check_executed("linuxcnc", "o1 repeat [2]\no2 while [1]\nX1\no2 break\no2 endwhile\nX2\no1 endrepeat\nM2\n",
                 "X1\nX2\nX1\nX2\nM2\n");
}

TEST_CASE("linuxcnc: loops whose passes depend on a loop that was left before are not executed") {
  check_left("linuxcnc", "#1=0\no1 do\n#1=[#1+1]\no1 continue\nX1\no1 while [#1 LT 2]\nM2\n", 4,
             "continue is in a do loop, and LinuxCNC repeats the next while or repeat loop");
  const std::string do_loop = "#1=0\no2 do\n#1=[#1+1]\nX#1\no2 while [#1 LT 2]\nM2\n";
  const std::string do_lines = "#1=0\n#1=[#1+1]\nX#1\n#1=[#1+1]\nX#1\nM2\n";
  const std::string_view keeps_break =
      "the break of a while loop before ends this do loop after its first pass in LinuxCNC";
  check_left("linuxcnc", "o1 while [1]\nX5\no1 break\no1 endwhile\n" + do_loop, 9, keeps_break);
  check_left("linuxcnc", "o1 while [0]\no1 break\no1 endwhile\n" + do_loop, 8, keeps_break);
  check_left(
      "linuxcnc",
      "#2=0\no1 while [#2 LT 1]\n#2=1\no4 if [1]\no1 continue\no4 endif\no1 break\no1 endwhile\n" + do_loop,
      13, keeps_break);
  check_executed("linuxcnc", "o1 while [0]\nX1\no1 endwhile\n" + do_loop, do_lines);
  check_executed("linuxcnc", "o1 while [0]\no1 break\no1 endwhile\no3 do\nX7\no3 while [0]\n" + do_loop,
                 "X7\n" + do_lines);
  check_left("linuxcnc", "o9 call\no1 repeat [2]\nX2\no1 endrepeat\nM2\n", 2,
             "a call or a loop before its end is not replaced, and a break or continue there can change its "
             "passes in LinuxCNC");
}

TEST_CASE("linuxcnc: M2 in a condition ends the program, and the text behind it stays") {
  check_executed("linuxcnc", "#1=1\no1 if [#1 EQ 1]\nX1\nM2\no1 endif\nX2\nM2\n",
                 "#1=1\nX1\nM2\no1 endif\nX2\nM2\n");
}

TEST_CASE("linuxcnc: a body has its own loops and variables") {
  const std::string sub =
      "M2\no<row> sub\n#4=0\n#<x>=[#1*2]\no1 while [#4 LT #2]\nG1 X#<x> Y[#4/4]\n#4=[#4+1]\n"
      "o1 endwhile\no2 if [#2 GT 1]\no<row> return\no2 endif\nZ1\n#<_rows>=[#<_rows>+1] "
      "(COUNT)\n#31=#1\no<row> endsub\n";
  check_executed("linuxcnc", "#4=7\n#<_rows>=2\no<row> call [1.5] [2]\nX#4\n" + sub,
                 "#4=7\n#<_rows>=2\nG1 X3 Y0\nG1 X3 Y0.25\nX#4\n" + sub);
  check_executed("linuxcnc", "#4=7\n#<_rows>=2\no<row> call [#4] [1]\nX#31\n" + sub,
                 "#4=7\n#<_rows>=2\nG1 X14 Y0\nZ1\n#<_rows>=3 (COUNT)\n#31=7\nX#31\n" + sub);
  const std::string swap = "M2\no9 sub\n#1=#2 #2=#1 X#1\nY#1 Z#2\no9 endsub\n";
  CHECK(executed("o9 call [1] [2]\n" + swap, "linuxcnc").text == "X1\nY2 Z1\n" + swap);
}

TEST_CASE("calls in loops are replaced in each pass") {
  const std::string sub = "M2\no9 sub\nX#1\no9 endsub\n";
  check_executed("linuxcnc", "#1=1\no1 repeat [2]\no9 call [#1*2]\n#1=[#1+1]\no1 endrepeat\n" + sub,
                 "#1=1\nX2\n#1=[#1+1]\nX4\n#1=[#1+1]\n" + sub);
  const std::string o9 = "M30\nO9\nWHILE [#1 LT 2] DO1\nX#1\n#1=#1+1\nEND1\nM99\n";
  check_executed("fanuc", "O1\n#1=0\nM98 P9\nX#1\n" + o9, "O1\n#1=0\nX#1\n#1=#1+1\nX#1\n#1=#1+1\nX#1\n" + o9);
}

TEST_CASE("linuxcnc: a condition can end the recursion of a subprogram") {
  const std::string sub = "M2\no9 sub\no1 if [#1 GT 0]\nX#1\no9 call [#1-1]\no1 endif\no9 endsub\n";
  check_executed("linuxcnc", "o9 call [2]\n" + sub, "X2\nX1\n" + sub);
}

TEST_CASE("fanuc: WHILE, DO, IF and GOTO are executed") {
  check_executed(
      "fanuc",
      "O1\n#1=0\nWHILE [#1 LT 2] DO1\n#2=0\nWHILE[#2LT2]DO2\nX#1 Y#2\n#2=#2+1\nEND2\n#1=#1+1\nEND1\nM30\n",
      "O1\n#1=0\n#2=0\nX#1 Y#2\n#2=#2+1\nX#1 Y#2\n#2=#2+1\n#1=#1+1\n"
      "#2=0\nX#1 Y#2\n#2=#2+1\nX#1 Y#2\n#2=#2+1\n#1=#1+1\nM30\n");
  check_executed("fanuc", "O1\n#1=0\nN10 X#1\n#1=#1+1\nIF [#1 LT 2] GOTO 10\nM30\n",
                 "O1\n#1=0\nN10 X#1\n#1=#1+1\nN10 X#1\n#1=#1+1\nM30\n");
  check_executed("haas",
                 "O1\n#1=1\nIF [[#1 EQ 1] AND [#1 LT 5]] GOTO#1 (GO)\nX9.\nN1 X1.\nGOTO 20\nX8.\nN20 M30\n",
                 "O1\n#1=1\nN1 X1.\nN20 M30\n");
  check_executed(
      "fanuc",
      "O1\n#1=1\nIF [#1 EQ 1] THEN #2=5 (SET)\nN7 IF[#2GT5]THEN#2=6\nIF [#2 EQ 5] GOTO 3\nX1.\nN3 X#2\nM30\n",
      "O1\n#1=1\n#2=5 (SET)\nN3 X#2\nM30\n");
  const std::string o9 = "O9\n#2=0\nWHILE [#2 LT 2] DO2\nY[#2*10.]\n#2=#2+1\nEND2\nM99\n";
  check_executed(
      "fanuc", "O1\n#1=0\nWHILE [#1 LT 2] DO1\nIF [#1 EQ 1] GOTO 5\nM98 P9\nN5 #1=#1+1\nEND1\nM30\n" + o9,
      "O1\n#1=0\n#2=0\nY[#2*10.]\n#2=#2+1\nY[#2*10.]\n#2=#2+1\nN5 #1=#1+1\nN5 #1=#1+1\nM30\n" + o9);
  check_executed("fanuc", "O1\n#1=0\nDO1\n#1=#1+1\nIF [#1 EQ 2] GOTO 5\nEND1\nN5 M30\n",
                 "O1\n#1=0\n#1=#1+1\n#1=#1+1\nN5 M30\n");
}

TEST_CASE("fanuc: jumps of a body use its own numbers, and the last M99 ends it") {
  const std::string o9 = "O9\nN1 X1.\nIF [#1 EQ 1] GOTO 2\nM99\nN2 X2.\nM99\n";
  const std::string main = "N2 X7.\nM30\n";
  check_executed("fanuc", "O1\n#1=1\nM98 P9\n" + main + o9, "O1\n#1=1\nN1 X1.\nN2 X2.\n" + main + o9);
  check_executed("fanuc", "O1\n#1=0\nM98 P9\n" + main + o9, "O1\n#1=0\nN1 X1.\n" + main + o9);
}

TEST_CASE("copies of a line have the line of their origin") {
  const Executed e = executed("#1=0\no1 while [#1 LT 2]\nX#1\n#1=[#1+1]\no1 endwhile\nX9\nM2\n", "linuxcnc");
  CHECK(e.text == "#1=0\nX#1\n#1=[#1+1]\nX#1\n#1=[#1+1]\nX9\nM2\n");
  CHECK(line_of_file(e.expansion, 2) == 3);
  CHECK(line_of_file(e.expansion, 4) == 3);
  CHECK(line_of_file(e.expansion, 6) == 6);
  REQUIRE(e.expansion.lines.size() == 4);
  CHECK(e.expansion.lines[1].called_from == 0);
  CHECK(e.expansion.lines[2].called_from == 2);
  CHECK(e.expansion.lines[3].called_from == 0);
  CHECK(e.expansion.first_executed == 2);
}

TEST_CASE("a flow that is not known from the text leaves the program unchanged") {
  check_left("linuxcnc", "X1\no1 while [#5061 LT 2]\nX2\no1 endwhile\nM2\n", 2,
             "the condition [#5061 LT 2] is not known from the text");
  check_left("linuxcnc", "#1=0\n/#1=1\no1 if [#1 GT 0]\nX2\no1 endif\nM2\n", 3,
             "the condition [#1 GT 0] is not known from the text");
  check_left("linuxcnc", "#1=0\no9 call\no1 if [#1 GT 0]\nX2\no1 endif\nM2\n", 3,
             "the condition [#1 GT 0] is not known from the text");
  check_left("linuxcnc", "o1 while [1]\nX2\no1 endwhile\nM2\n", 3,
             "the expansion adds more than 500000 lines");
  check_left("linuxcnc", "o1 repeat [1.5]\nX2\no1 endrepeat\nM2\n", 1,
             "the count [1.5] is not an integer known from the text");
  check_left("linuxcnc", "o1 if [1]\nX2\nM2\n", 1, "if has no end");
  check_left("linuxcnc", "o1 if [1]\nX2\no2 endif\nM2\n", 3, "endif has no beginning");
  check_left("linuxcnc", "X2\no2 break\nM2\n", 2, "break is not in a while or do loop");
  check_left("linuxcnc", "/o1 if [1]\nX2\no1 endif\nM2\n", 1,
             "a jump or a loop is in a block that '/' may skip");
  check_left("fanuc", "O1\n#1=.1+.2\nIF [#1 EQ .3] GOTO 5\nX1.\nN5 M30\n", 3,
             "the condition [#1 EQ .3] depends on how the control rounds");
  check_left("fanuc", "O1\nGOTO 5\nX1.\nM30\n", 2, "N5, the target of the jump, is not found");
  check_left("fanuc", "O1\nGOTO 5\nN5 X1.\nN5 M30\n", 2, "N5, the target of the jump, occurs more than once");
  check_left("fanuc", "O1\nGOTO #1\nN5 M30\n", 2,
             "the target #1 of the jump is not a number known from the text");
  check_left("fanuc", "O1\n#1=1\nG66 P9\nX1.\nIF [#1 EQ 1] GOTO 5\nX1.\nN5 M30\n", 5,
             "the condition [#1 EQ 1] is not known from the text");
  check_left("fanuc", "O1\n#1=1\nIF [#1 EQ 1] THEN X5.\nM30\n", 3,
             "THEN needs exactly one assignment behind it");
  check_left("fanuc", "O1\nN1 X1.\nGOTO 1\nM30\n", 3, "the expansion adds more than 500000 lines");
}

TEST_CASE("fanuc: jumps behind another program number are not counted as executed") {
  const std::string text = "%\nG21 G90 G0 X1.\nO2\nGOTO 5\nG1 X2. F100\nN5 M30\n%\n";
  CHECK_FALSE(executed(text, "fanuc").expansion.in_order);
}

TEST_CASE("if a loop is unknown, calls outside of it are replaced, and a remark gives the reason") {
  ReadOptions options;
  options.dialect = "linuxcnc";
  options.expand_subprograms = true;
  const std::string loop = "o1 while [#5061 LT 2]\nX2\no1 endwhile\n",
                    sub = "M2\no9 sub\nX1\nX3\no9 endsub\n";
  const Program program = read_program("G21 G90 F100\nG0 X0 Y0 Z0\no9 call\n" + loop + sub, "p.ngc", options);
  CHECK(program.text == "G21 G90 F100\nG0 X0 Y0 Z0\nX1\nX3\n" + loop + sub);
  const auto& remarks = program.remarks;
  CHECK(std::any_of(remarks.begin(), remarks.end(), [](const Remark& remark) {
    return remark.line == 4 &&
           remark.what.find("are not executed: the condition [#5061 LT 2]") != std::string::npos;
  }));
}

TEST_CASE("an executed program is corrected in each pass, also with jumps behind its end") {
  ReadOptions options;
  options.dialect = "fanuc";
  options.evaluate = options.expand_subprograms = true;
  const Program program = read_program(
      "O1\nG21 G90 G17 F100\nG0 X0. Y0. Z5.\n#1=0\nN10 G1 X[#1*10]\n#1=#1+1\nIF [#1 LT 3] GOTO 10\nGOTO 20\n"
      "N15 #3000=1\nGOTO 15\nN20 M30\nN30 GOTO 10\nM30\n",
      "p.nc", options);
  REQUIRE(program.moves.size() == 4);
  CHECK(program.left_alone.empty());
  CHECK(program.moves[3].end_mm.x() == 20);
  CHECK(all_known(program.moves[3].known_end));
}
