/// Execution of loops, conditions and jumps of a Sinumerik with constants.
#include <doctest/doctest.h>

#include "program/expand/executed.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// The lines that run.
void check_executed(const std::string& text, const std::string& lines) {
  CAPTURE(text);
  const Executed e = executed(text, "siemens");
  CHECK(e.text == lines);
  CHECK(e.expansion.executed > 0);
}

void check_left(const std::string& text, int line, std::string_view why) {
  CAPTURE(text);
  const Executed e = executed(text, "siemens");
  CHECK(e.text == text);
  REQUIRE(e.expansion.unexpanded_calls.size() == 1);
  CHECK(e.expansion.unexpanded_calls[0].text_line == line);
  CHECK(e.expansion.unexpanded_calls[0].why == why);
}

}  // namespace

TEST_CASE("siemens: FOR sets its variable before each pass") {
  check_executed("FOR R1=1 TO 2\nX=R1\nENDFOR\nM30\n", "R1=1\nX=R1\nR1=2\nX=R1\nR1=3\nM30\n");
  check_executed("DEF INT I, LAST=1\nFOR I=LAST TO LAST+1\nX=I\nENDFOR\nM30\n",
                 "DEF INT I, LAST=1\nI=1\nX=I\nI=2\nX=I\nI=3\nM30\n");
  check_executed("FOR R1=5 TO 1\nX5\nENDFOR\nM30\n", "R1=5\nM30\n");
}

TEST_CASE("siemens: WHILE, REPEAT, LOOP, IF and jumps to labels are followed") {
  check_executed("R1=0\nWHILE R1<2\nR1=R1+1 ; count\nENDWHILE\nM30\n",
                 "R1=0\nR1=R1+1 ; count\nR1=R1+1 ; count\nM30\n");
  check_executed("R1=0\nREPEAT\nR1=R1+1\nUNTIL R1>=2\nM30\n", "R1=0\nR1=R1+1\nR1=R1+1\nM30\n");
  check_executed("R1=0\nN1 LOOP\nN2 R1=R1+1\nN3 IF R1==2 GOTOF OUT\nN4 ENDLOOP\nN5 OUT: X1\nM30\n",
                 "R1=0\nN2 R1=R1+1\nN2 R1=R1+1\nN5 X1\nM30\n");
  check_executed(
      "R1=1\nIF R1==1\nX1\nELSE\nX2\nENDIF\nIF R1>1\nX3\nELSE\nX4\nENDIF\nIF R1<>1\nX5\nENDIF\nM30\n",
      "R1=1\nX1\nX4\nM30\n");
  check_executed("R1=0\nA:\nR1=R1+1\nIF (R1<2) OR (R1<3 AND NOT R1==9) GOTOB A\nM30\n",
                 "R1=0\nR1=R1+1\nR1=R1+1\nR1=R1+1\nM30\n");
  check_executed("N10 gotof N50\nN20 X1\nN50 X2\nN60 X3\nM30\n", "N50 X2\nN60 X3\nM30\n");
  check_executed("N10 GOTOF N50\nN20 X1\nN050 X2\nM30\n", "N050 X2\nM30\n");
  check_executed("R1=0\nN05 R1=R1+1\nIF R1<2 GOTOB N5\nGOTO n0060\nX1\nn60 X2\nM30\n",
                 "R1=0\nN05 R1=R1+1\nN05 R1=R1+1\nn60 X2\nM30\n");
  check_executed("GOTO B\nX1\nB: X2\nGOTOF B\nX3\nb: X4\nM30\n", "X2\nX4\nM30\n");
}

TEST_CASE("siemens: copies of a line have the line of their origin, and text behind the end stays") {
  const Executed e = executed("R1=0\nA: X1\nR1=R1+1\nIF R1<2 GOTOB A\nM30\nIF R9==1 GOTOF A\n", "siemens");
  CHECK(e.text == "R1=0\nX1\nR1=R1+1\nX1\nR1=R1+1\nM30\nIF R9==1 GOTOF A\n");
  CHECK(line_of_file(e.expansion, 4) == 2);
  CHECK(line_of_file(e.expansion, 6) == 5);
  REQUIRE(e.expansion.lines.size() >= 2);
  CHECK(e.expansion.lines[1].called_from == 4);
  CHECK(e.expansion.executed == 2);
}

TEST_CASE("siemens: a flow that is not known from the text leaves the program unchanged") {
  check_left("IF R1==1 GOTOF A\nX1\nA: M30\n", 1, "the condition R1==1 is not known from the text");
  check_left("WHILE $AC_TIMER[1]<5\nX1\nENDWHILE\nM30\n", 1,
             "the condition $AC_TIMER[1]<5 is not known from the text");
  check_left("R1=0.1+0.2\nIF R1==0.3 GOTOF A\nX1\nA: M30\n", 2,
             "the condition R1==0.3 depends on how the control rounds");
  check_left("A: X1\nGOTOB A\nM30\n", 2, "the expansion adds more than 500000 lines");
  check_left("R1=1\nIF R1==1 GOTOB A\nX1\nA: M30\n", 2,
             "the label A of the jump is not found in its direction");
  check_left("GOTOF NOWHERE\nM30\n", 1, "the label NOWHERE of the jump is not found");
  check_left("FOR R1=1 TO R2\nX1\nENDFOR\nM30\n", 1, "the end of FOR R1=1 TO R2 is not known from the text");
  check_left("R1=1\nL100\nIF R1==1 GOTOF A\nX1\nA: M30\n", 3,
             "the condition R1==1 is not known from the text");
  check_left("R1=1\nMCALL MY_HOLE(1)\nX1\nIF R1==1 GOTOF A\nX2\nA: M30\n", 4,
             "the condition R1==1 is not known from the text");
  check_left("R1=1 R2=1\n_A[R2]=5\nIF R1==1 GOTOF A\nX1\nA: M30\n", 3,
             "the condition R1==1 is not known from the text");
  check_left("X1 GOTOF A\nX2\nA: M30\n", 1, "GOTO behind other words is not supported");
  check_left("A: X1\nREPEATB A P=3\nM30\n", 2, "REPEATB is not supported");
  check_left("A: X1\nREPEAT A P=3\nM30\n", 2, "REPEAT of labels is not supported");
  check_left("X1\nENDIF\nM30\n", 2, "ENDIF has no beginning");
  check_left("X1\nLOOP\nM30\n", 2, "LOOP has no end");
  check_left("R1=1\n/IF R1==1 GOTOF A\nX1\nA: M30\n", 2, "a jump or a loop is in a block that '/' may skip");
}

TEST_CASE("siemens: a program without loops and jumps is not changed") {
  const Executed e = executed("G0 X1\nMSG(\"IF THEN\") ; GOTOB A\nM30\n", "siemens");
  CHECK(e.expansion.lines.empty());
  CHECK(e.expansion.unexpanded_calls.empty());
}
