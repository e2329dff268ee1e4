#include "counterflex/program/restart.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace counterflex;

namespace {

RestartLines restart_lines(const std::string& text, const std::string& dialect = "linuxcnc") {
  RestartScan scan(dialect);
  scan.add(text);
  return scan.finish();
}

const std::string head = "G21 G90 G17 G54 G40\nT1 M6\nG0 X0 Y0\nS900 M3\nG43 H1 Z5\nG1 Z-1 F100\nX10\nM5\n";
const std::string complete =
    "T2 M6\nG21 G90 G17 G54 G40\nS800 M3\nG0 X1 Y1\nG43 H2 Z5\nG1 Z-1 F200\nX20\nM30\n";

/// What the second tool change of a program with `behind` lacks.
std::string lacks(const std::string& behind, const std::string& before = head,
                  const std::string& dialect = "linuxcnc") {
  const RestartLines found = restart_lines(before + behind, dialect);
  CHECK(found.why_none == "");
  REQUIRE(found.lines.size() == 2);
  return found.lines.back().missing;
}

/// `complete` without one of its words.
std::string without(const std::string& word, const std::string& instead = "") {
  std::string text = complete;
  const std::size_t at = text.find(word);
  REQUIRE(at != std::string::npos);
  return text.replace(at, word.size(), instead);
}

}  // namespace

TEST_CASE("a program may be begun at a tool change behind which everything is stated again") {
  const RestartLines found = restart_lines(head + complete);
  REQUIRE(found.lines.size() == 2);
  CHECK(found.lines[0].line == 2);
  CHECK(found.lines[0].missing ==
        "G21 of line 1, G90 of line 1, G17 of line 1, G54 of line 1, G40 of line 1");
  CHECK(found.lines[1].line == 9);
  CHECK(found.lines[1].tool == 2);
  CHECK(found.lines[1].text == "T2 M6");
  CHECK(found.lines[1].missing == "");
}

TEST_CASE("each word that the cut needs and that is missing behind the tool change is named") {
  CHECK(lacks(without("G21 ")) == "G21 of line 1");
  CHECK(lacks(without("G90 ")) == "G90 of line 1");
  CHECK(lacks(without("G17 ")) == "G17 of line 1");
  CHECK(lacks(without("G54 ")) == "G54 of line 1");
  CHECK(lacks(without(" G40")) == "G40 of line 1");
  CHECK(lacks(without("G43 H2 ")) == "G43 of line 5");
  CHECK(lacks(without(" F200")) == "F100 of line 6");
  CHECK(lacks(without("S800 ")) == "S900 of line 4");
  CHECK(lacks(without(" M3")) == "M5 of line 8");
  CHECK(lacks(without(" Y1")) == "Y before the first cut");
  CHECK(lacks(without(" Z5")) == "Z before the first cut");
}

TEST_CASE("where the motion is not stated again, the first axis word may cut") {
  CHECK(lacks(without("G0 X1 Y1", "X1 Y1")) ==
        "G1 of line 6, G43 of line 5, F100 of line 6, X before the first cut, Y before the first cut, Z "
        "before the first cut");
}

TEST_CASE("a word that comes too late, or that '/' may skip, does not count") {
  CHECK(lacks(without("G21 G90 G17 G54 G40\n", "G21 G90 G17 G40\n")) == "G54 of line 1");
  CHECK(lacks("T2 M6\nG21 G90 G17 G40\nS800 M3\nG0 X1 Y1\nG54\nG43 H2 Z5\nG1 Z-1 F200\n") == "G54 of line 1");
  CHECK(lacks(without("G21 G90", "/G21 G90")) ==
        "G21 of line 1, G90 of line 1, G17 of line 1, G54 of line 1, G40 of line 1");
}

TEST_CASE("a position of the machine or a difference is not a position of the program") {
  CHECK(lacks(without("G43 H2 Z5", "G43 H2\nG53 G0 Z0")) == "Z before the first cut");
  CHECK(lacks(without("G43 H2 Z5", "G43 H2 G91 Z5\nG90")) == "Z before the first cut");
}

TEST_CASE("a state that the program has not set before need not be set again") {
  const std::string bare = "T1 M6\nG0 X0 Y0\nZ5\nG1 Z-1 F100\n";
  CHECK(lacks("T2 M6\nG0 X0 Y0\nZ5\nG1 Z-1 F50\nM2\n", bare) == "");
  CHECK(restart_lines(bare).lines.at(0).missing == "");
}

TEST_CASE("states that are not followed end the proof for all later lines") {
  for (const char* word : {"G92 X1", "G52 X1", "G10 L2 P1 X1", "G43.4", "M128", "M62 P1"}) {
    CAPTURE(word);
    const std::string carried = head + word + "\n";
    CHECK(lacks(complete, carried).find(" of line 9") != std::string::npos);
  }
  CHECK(lacks(complete, "G92.1\nG49\n" + head) == "");
  CHECK(lacks(without("S800", "G52 X1\nS800")) == "G52 of line 11");
}

TEST_CASE("a program with variables, jumps or subprograms, and another language, have no restart line") {
  const auto why = [](const std::string& text, const std::string& dialect = "linuxcnc") {
    const RestartLines found = restart_lines(text, dialect);
    CHECK(found.lines.empty());
    return found.why_none;
  };
  CHECK(why("#1=5\n" + head + complete) == "it has variables or expressions (line 1)");
  CHECK(why(head + "G1 X[1+2]\n" + complete) == "it has variables or expressions (line 9)");
  CHECK(why(head + "o100 call\n" + complete) == "it has subprograms, loops, conditions or jumps (line 9)");
  CHECK(why("O1\n" + head + "M98 P100\n" + complete, "fanuc") == "it has subprograms (line 10)");
  CHECK(why("O1\n" + head + "G65 P100\n" + complete, "fanuc") == "it calls a macro (line 10)");
  for (const char* dialect : {"heidenhain", "kuka", "abb", "ur", "apt", "fanuc_tp", "yaskawa"})
    CHECK(why(head + complete, dialect) == "its language is not G-code");
}

TEST_CASE("holes need G98 or G99, Z and R again; mills do not") {
  const std::string drilled = "T1 M6\nG0 X0 Y0\nZ5\nG98 G81 X1 Y1 Z-2 R1 F100\nG80\n";
  CHECK(lacks("T2 M6\nG0 X0 Y0\nZ5\nG1 Z-1 F50\nM2\n", drilled) == "");
  CHECK(lacks("T2 M6\nG0 X0 Y0\nZ5\nG81 X2 Y2 Z-1 R1 F50\nM2\n", drilled) == "G98 of line 4");
  CHECK(lacks("T2 M6\nG0 X0 Y0\nZ5\nG99 G81 X2 Y2 Z-1 F50\nM2\n", drilled) == "Z and R of the cycle");
  CHECK(lacks("T2 M6\nG0 Z5\nG99 G81 X2 Y2 Z-1 R1 F50\nM2\n", drilled) == "");
  CHECK(lacks("T2 M6\nG0 X0 Y0 Z5\nG1 Z-1 F50\nG0 Z5\nG81 X2 Y2 Z-1 R1\nM2\n", drilled) == "G98 of line 4");
}

TEST_CASE("coolant that was on, and rotary axes in use, are needed again") {
  const std::string wet = "T1 M6\nM8\nG0 X0 Y0 A0\nZ5\nG1 Z-1 F100\n";
  CHECK(lacks("T2 M6\nG0 X0 Y0\nZ5\nG1 Z-1 F50\n", wet) == "M8 of line 2, A before the first cut");
  CHECK(lacks("T2 M6\nG0 X0 Y0 A90\nM8\nZ5\nG1 Z-1 F50\n", wet) == "");
  CHECK(lacks("T2 M6\nG0 X0 Y0 A90\nZ5\nG1 Z-1 F50\n", wet + "M9\n") == "");
  const std::string misty = "T1 M6\nM7\nM8\nG0 X0 Y0\nZ5\nG1 Z-1 F100\n";
  CHECK(lacks("T2 M6\nM8\nG0 X0 Y0\nZ5\nG1 Z-1 F50\n", misty) == "M7 of line 2");
  CHECK(lacks("T2 M6\nM7\nM8\nG0 X0 Y0\nZ5\nG1 Z-1 F50\n", misty) == "");
}

TEST_CASE("T may be alone in the line before M6, and a Sinumerik gives the length by D") {
  const std::string mpf = "G71 G90 G54\nT1 D1\nM6\nG0 X0 Y0\nZ5\nG1 Z-1 F100\n";
  const RestartLines found =
      restart_lines(mpf + "N90 T2 D1\nN100 M6\nG71 G90 G54\nG0 X0 Y0\nZ5\nG1 Z-1 F100\nM30\n", "siemens");
  REQUIRE(found.lines.size() == 2);
  CHECK(found.lines[1].line == 7);
  CHECK(found.lines[1].text == "N90 T2 D1");
  CHECK(found.lines[1].missing == "");
  CHECK(lacks("T2\nM6\nG71 G90 G54\nG0 X0 Y0\nZ5\nG1 Z-1 F100\nM30\n", mpf, "siemens") == "D1 of line 2");
  CHECK(restart_lines("G90\nT1\nG0 X0\nM6\nZ5 Y0\nG1 Z0 F9\n").lines.empty());
}

TEST_CASE("words of a Sinumerik whose effect on later blocks is not followed are named") {
  const std::string mpf = "G71 G90 G54\nT1 D1\nM6\nG0 X0 Y0\nZ5\nG1 Z-1 F100\n",
                    again = "T2 D1\nM6\nG71 G90 G54\nG0 X0 Y0\nZ5\nG1 Z-1 F100\nM30\n";
  for (const std::string word : {"OVR=50", "FGROUP(X,Y)", "FFWON", "SOFT", "LIMS=3000"}) {
    CAPTURE(word);
    const std::string name = word.substr(0, word.find_first_of("=("));
    CHECK(lacks(again, mpf + "N70 " + word + "\n", "siemens") == name + " of line 7");
  }
  for (const char* block : {"MSG(\"OVR=50\") ; SOFT\n", "G2 X10 CR=5\n", "SPOS=0\n", "G0 SUPA Z0\n"})
    CHECK(lacks(again, mpf + block, "siemens") == "");
}

TEST_CASE("on a Fanuc a G43 without H takes the modal H of before") {
  const std::string program = "O1\n" + head;
  CHECK(lacks(without("G43 H2 Z5", "G43 Z5"), program, "fanuc") == "G43 of line 6");
  CHECK(lacks(complete, program, "fanuc") == "");
}

TEST_CASE(
    "lines are counted over the portions of a text, and those behind the end of the program are not read") {
  RestartScan scan("linuxcnc");
  scan.add(head);
  scan.add(complete);
  scan.add("T9 M6\nG1 X1\n#1=5\n");
  const RestartLines found = scan.finish();
  REQUIRE(found.lines.size() == 2);
  CHECK(found.lines[1].line == 9);
  CHECK(found.why_none == "");
}
