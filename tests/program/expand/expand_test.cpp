#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Program expanded(const std::string& text, const std::string& dialect = "auto") {
  ReadOptions options;
  options.dialect = dialect;
  options.expand_subprograms = true;
  return read_program(text, "p.nc", options);
}

/// The moves of a program, without their lines: equal text means equal moves.
std::string path_of(const Program& program) {
  std::string path;
  for (const Move& move : program.moves)
    path += fmt::format("{} {} {} {} {} {} {}\n", move.motion == Motion::rapid ? "rapid" : "feed",
                        move.end_mm.x(), move.end_mm.y(), move.end_mm.z(), move.arc.has_value(),
                        move.feed_mm_min, all_known(move.known_end));
  return path;
}

const std::string go = "G21 G90 G17 F100\nG0 X0. Y0. Z5.\n";
const std::string fanuc_go = "O1\n" + go;

struct Expanding {
  std::string dialect, before, calls, bodies, after;
};

/// `calls` is replaced by `bodies`; a definition is before the program or behind it.
void check_same(const Expanding& e) {
  CAPTURE(e.before);
  CAPTURE(e.calls);
  CAPTURE(e.after);
  const Program program = expanded(e.before + e.calls + e.after, e.dialect);
  CHECK(program.text == e.before + e.bodies + e.after);
  CHECK(program.expansion.unexpanded_calls.empty());
  const std::string begin = e.before.substr(e.before.find("G21"));
  CHECK(path_of(program) ==
        path_of(read((e.dialect == "fanuc" ? "O1\n" : "") + begin + e.bodies + "M30\n", e.dialect)));
}

}  // namespace

TEST_CASE("a program without expanded calls has the same bytes, lines and moves") {
  for (const std::string& text : {go + "G1 X1\nX2", fanuc_go + "N5 G1 X1.\r\n(M98 P2)\r\nM30\n%\nwhatever {",
                                  "%\n" + go + "%\nM98 P3\n", go + "o1 if [#1 GT 2]\nX1\no1 endif\nX3 Y#2\n",
                                  "O1\nG21\nM99\nO2\n" + go + "M30\n", std::string(), std::string("\n\n")}) {
    CAPTURE(text);
    const Program with = expanded(text), without = read(text);
    CHECK(with.text == text);
    CHECK(with.expansion.calls == 0);
    REQUIRE(path_of(with) == path_of(without));
    for (std::size_t i = 0; i < with.moves.size(); ++i) CHECK(with.moves[i].line == without.moves[i].line);
  }
}

TEST_CASE("a call by M98 is replaced by its body") {
  const std::string end = "M30\nO1001 (SLOT)\nG91 G1 X1.\nG90 Y2. (CUT)\nM99\n";
  const std::string body = "G91 G1 X1.\nG90 Y2. (CUT)\n";
  for (const std::string dialect : {"fanuc", "haas"}) {
    check_same({dialect, fanuc_go, "M98 P1001\n", body, end});
    check_same({dialect, fanuc_go, "M98P01001L2\nG0 Z9.\n", body + body + "G0 Z9.\n", end});
    check_same({dialect, fanuc_go, "G0 X7. M98 P1001 (ONE)\n", "G0 X7. (ONE)\n" + body, end});
    check_same({dialect, fanuc_go, "N50 M98 P1001\n  M98 P1001 ;\n", "N50\n" + body + body, end});
  }
  check_same({"mach3", go, "M98 P1001 Q2\nM98 P1001\n", body + body + body, end});
  check_same({"linuxcnc", go, "n7 m98 p1001 l2 (both)\n", "n7 (both)\n" + body + body, end});
}

TEST_CASE("a subprogram may begin with ':' and its number") {
  check_same({"fanuc", fanuc_go, "M98 P1000\n", "G1 X20.\n", "M30\n:1000\nG1 X20.\nM99\n"});
}

TEST_CASE("P31001 means O1001 three times to a Fanuc, and O31001 to a Haas") {
  const std::string end = "M30\nO1001\nX1.\nM99\nO31001\nX3.\nM99\n";
  check_same({"haas", fanuc_go, "M98 P31001\n", "X3.\n", end});
  check_same({"fanuc", fanuc_go, "M98 P0031001\nM98 P20031\n", "X3.\nX4.\nX4.\n", end + "O31\nX4.\nM99\n"});
  check_same({"fanuc", fanuc_go, "M98 P31001\n", "X1.\nX1.\nX1.\n", "M30\nO1001\nX1.\nM99\n"});
}

TEST_CASE("M97 calls the blocks from its number on") {
  check_same(
      {"haas", fanuc_go, "M97 P100 L2\n", "N100 X1.\nY1.\nN100 X1.\nY1.\n", "M30\nN100 X1.\nY1.\nM99\n"});
}

TEST_CASE("other words in the block of M99 are executed before the return") {
  check_same(
      {"fanuc", fanuc_go, "M98 P2\nX9.\n", "X1.\nN4 Y3. (LAST)\nX9.\n", "M30\nO2\nX1.\nN4 Y3. M99 (LAST)\n"});
}

TEST_CASE("calls in a body are expanded in every copy") {
  check_same({"fanuc", fanuc_go, "M98 P2 L2\n", "X1.\nY5.\nX2.\nX1.\nY5.\nX2.\n",
              "M30\nO2\nX1.\nM98 P3\nX2.\nM99\nO3\nY5.\nM99\n"});
}

TEST_CASE("the arguments of an O-word replace #1 to #30 in its body") {
  const std::string body = "M2\no<a_b> sub\nG1 X#1 Y[#2*2+1] (#1)\nZ-[#3/4] F-#4\no<a_b> endsub (end)\n";
  check_same(
      {"linuxcnc", go, "o<a_b> call [1.5] [-2] [3-1] [-[60+40]]\n", "G1 X1.5 Y-3 (#1)\nZ-0.5 F100\n", body});
  check_same(
      {"linuxcnc", go, "N9 O< A_B >CALL[+.5][1] ; twice\n", "N9 ; twice\nG1 X0.5 Y3 (#1)\nZ0 F0\n", body});
  check_same(
      {"linuxcnc", go, "o0100 call [2]\n", "G1 X2\nG1 X5\n",
       "M2\no100 sub\no200 call [#1]\no200 call [#1*2+1]\no100 endsub\no200 sub\nG1 X#1\no200 endsub\n"});
}

TEST_CASE("values are written with the digits they have, at most six") {
  const std::string sub = "M2\no1 sub\nX#1\no1 endsub\n";
  for (const auto& [argument, number] : std::vector<std::pair<std::string, std::string>>{
           {"1/3", "0.333333"}, {"0.1+0.2", "0.3"}, {"-0", "0"}, {"100", "100"}, {"2.50", "2.5"}})
    check_same({"linuxcnc", go, "o1 call [" + argument + "]\n", "X" + number + "\n", sub});
}

TEST_CASE("line ends are those of the file, and a last line without a line end gets one") {
  const Program program =
      expanded("O1\r\nG21 G0 X0. Y0. Z0.\r\nM98 P2\r\nM30\r\nO2\r\nX1.\r\nY2. M99", "fanuc");
  CHECK(program.text == "O1\r\nG21 G0 X0. Y0. Z0.\r\nX1.\r\nY2.\r\nM30\r\nO2\r\nX1.\r\nY2. M99");
  CHECK(expanded("O2\nX1.\nM99\nO1\n" + go + "X4. M98 P2", "fanuc").text ==
        "O2\nX1.\nM99\nO1\n" + go + "X4.\nX1.\n");
}

TEST_CASE("moves of a copy have the lines of the body, and repeated blocks are different moves") {
  const Program program = expanded(fanuc_go + "M98 P2 L3\nX9.\nM30\nO2\nX1. Y1.\nM99\n", "fanuc");
  std::vector<int> lines;
  for (const Move& move : program.moves) lines.push_back(move.line);
  CHECK(lines == std::vector<int>{3, 8, 8, 8, 5});
  CHECK(program.expansion.file_lines == 9);
  CHECK(line_of_file(program.expansion, 4) == 8);
  CHECK(line_of_file(program.expansion, 7) == 5);
  CHECK(line_of_file(program.expansion, 8) == 6);
}

TEST_CASE("an error in a copy is reported at its line, with the line of the call") {
  CHECK(diagnostic_of([] { expanded("O1\nG21 G90\nM98 P2\nM30\nO2\n  X1.\nM99\n", "fanuc"); }) ==
        "p.nc:6:3: error: X without a motion: program G0 or G1 before it (called from line 3)");
}

TEST_CASE("a call that is not all plain numbers is not expanded, with the reason") {
  struct Left {
    std::string dialect, call, definition, why;
  };
  const std::string plain = "O2\nX1.\nM99\n", word = "o<a> sub\nX#1\no<a> endsub\n";
  for (const Left& l : std::vector<Left>{
           {"fanuc", "M98 P#1", plain, "its P is not a plain number"},
           {"fanuc", "M98 P2.5", plain, "its P is not a plain number"},
           {"fanuc", "M98 L2", plain, "it has no P"},
           {"fanuc", "M98 P2 L0", plain, "its L is not an integer from 1"},
           {"fanuc", "M98 P2 L#1", plain, "its L is not an integer from 1"},
           {"fanuc", "/M98 P2", plain, "'/' may skip it"},
           {"fanuc", "G4 M98 P2", plain, "its block has the word G"},
           {"fanuc", "M30 M98 P2", plain, "its block has the word M"},
           {"fanuc", "M98 P3", plain,
            "the subprogram is not in this file: append it behind the end of the program"},
           {"fanuc", "G65 P2 X5. Y3.", plain, "G65 passes arguments to a macro"},
           {"haas", "G65 P2", plain, "G65 passes arguments to a macro"},
           {"fanuc", "M198 P2", plain, "M198 calls a program outside of this file"},
           {"fanuc", "M98 P2", plain + plain, "this file defines the subprogram more than once"},
           {"fanuc", "M98 P2", "O2\nX1.\nM30\n", "its body does not end with M99 or endsub"},
           {"fanuc", "M98 P2", "O2\nX1.\nO3\nM99\n", "its body does not end with M99 or endsub"},
           {"fanuc", "M98 P2", "O2\nX1.\n/M99\nM99\n", "'/' may skip the M99 in its body"},
           {"fanuc", "M98 P2", "O2\nWHILE [#1 LT 2] DO1\nX1.\nEND1\nM99\n",
            "the condition [#1 LT 2] is not known from the text"},
           {"fanuc", "M98 P2", "O2\nX1.\nM99 P10\n", "its M99 jumps to a block number"},
           {"fanuc", "M98 P2", "O2\nG#1 X1.\nM99\n", "a code in its body is a variable or an expression"},
           {"fanuc", "M98 P2", "O2 G0\nX1.\nM99\n", "its O line has other words"},
           {"linuxcnc", "o<a> call [1]", word + "(#<_value>)\n",
            "the program reads values returned by calls"},
           {"linuxcnc", "X1 M98 P2", plain, "its block has the word X"},
           {"linuxcnc", "M98 P2", "O2\nX#1\nM99\n", "its body has variables or expressions"},
           {"linuxcnc", "o<a> call [#5]", word, "its argument [#5] is not a plain number"},
           {"linuxcnc", "o<a> call [1/0]", word, "its argument [1/0] is not a plain number"},
           {"linuxcnc", "o<a> call 5", word, "its arguments are not in brackets"},
           {"linuxcnc", "o<a> call [1", word, ""},
           {"linuxcnc", "o#3 call [1]", word, "its name is a variable or an expression"},
           {"linuxcnc", "o<b> call [1]", word,
            "the subprogram is not in this file: append it behind the end of the program"},
           {"linuxcnc", "o<a> call [1] (and) o<a> call [2]", word, "a comment is before it"},
           {"linuxcnc", "/o<a> call [1]", word, "'/' may skip it"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\n#5221=2\nX#1\no<a> endsub\n",
            "#5221 in line 6 of its body is an expression or a variable of the control"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\n#100=#5061\nX#1\no<a> endsub\n",
            "the value of #100 in line 6 of its body is not known from the text"},
           {"linuxcnc", "M98 P2", "O2\n#1=2\nX1\nM99\n", "its body sets variables"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\nX#<wide>\no<a> endsub\n",
            "X#<wide> in line 6 of its body is not a number given by the call"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\nX1\no<a> return [3]\nX2\no<a> endsub\n",
            "its return has a value"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\no1 while [1]\nX1\no1 endwhile\no<a> endsub\n",
            "the expansion adds more than 500000 lines"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\no1 if [#5061 GT 0]\nX1\no1 endif\no<a> endsub\n",
            "the condition [#5061 GT 0] is not known from the text"},
           {"linuxcnc", "o<a> call [1]",
            "o<a> sub\no1 repeat [2]\nX1\no2 if [#1]\no<a> return\no2 endif\no1 endrepeat\no<a> endsub\n",
            "return is in a repeat loop, and LinuxCNC keeps its other passes for the next call"},
           {"linuxcnc", "o<a> call [1]",
            "o<a> sub\no1 repeat [2]\nX1\no2 if [#1]\no<a> call [0]\no2 endif\no1 endrepeat\no<a> endsub\n",
            "the loop calls itself, and LinuxCNC counts the passes of both together"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\nX1\no<a> endsub [3]\n", "its endsub returns a value"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\nM73\nX1\no<a> endsub\n",
            "M73 in its body restores modal states"},
           {"linuxcnc", "o<a> call [1]", "o<a> sub\no<c> call\no<a> endsub\n",
            "the subprogram is not in this file: append it behind the end of the program"}}) {
    CAPTURE(l.call);
    CAPTURE(l.definition);
    const std::string text = (l.dialect == "linuxcnc" ? go : fanuc_go) + l.call + "\nM30\n" + l.definition;
    if (l.why.empty()) {
      CHECK(diagnostic_of([&] { expanded(text, l.dialect); }) != "none");
      continue;
    }
    const Program program = expanded(text, l.dialect);
    CHECK(program.text == text);
    REQUIRE(program.expansion.unexpanded_calls.size() == 1);
    CHECK(program.expansion.unexpanded_calls[0].why == l.why);
    const auto& left = program.left_alone;
    CHECK(std::any_of(left.begin(), left.end(), [&](const LeftAlone& one) {
      return one.why == "a subprogram is called, not expanded: " + l.why;
    }));
  }
}

TEST_CASE("a call in a condition or a loop is not expanded") {
  for (const auto& [before, after] :
       std::vector<std::pair<std::string, std::string>>{{"o1 if [#1 GT 2]\n", "o1 endif\n"},
                                                        {"o1 repeat [#1]\n", "o1 endrepeat\n"},
                                                        {"o1 do\n", "o1 while [#1 GT 2]\n"},
                                                        {"o1 while [#1 GT 2]\n", "o1 endwhile\n"}}) {
    const std::string text = go + before + "o9 call\n" + after;
    const std::string end = "M2\no9 sub\nX1\no9 endsub\n";
    CHECK(expanded(text + end).text == text + end);
    CHECK(expanded(text + "o9 call\n" + end).text == text + "X1\n" + end);
  }
}

TEST_CASE("linuxcnc: a body whose break would end a later loop is not expanded beside loops that stay") {
  const std::string loop = "o2 do\nX3\no2 while [#5061]\nM2\n";
  const std::string sub = "o9 sub\no1 while [1]\nX1\no1 break\no1 endwhile\no9 endsub\n";
  const Program program = expanded(go + "o9 call\n" + loop + sub);
  CHECK(program.text == go + "o9 call\n" + loop + sub);
  CHECK(program.expansion.unexpanded_calls.front().why ==
        "LinuxCNC keeps a break of its while loop for a loop of the program");
  CHECK(expanded(go + "o9 call\nM2\n" + sub).text == go + "X1\nM2\n" + sub);
}

TEST_CASE("nothing is copied if the program searches block numbers") {
  const std::string sub = "M30\nO2\nN10 X1.\nM99\n";
  for (const std::string seeking : {"GOTO 10\n", "/M97 P10\n", "M99 P10\n"}) {
    CAPTURE(seeking);
    const std::string text = go + "M98 P2\n" + seeking + sub;
    CHECK(expanded(text, "fanuc").text == text);
    CHECK(expanded(text, "fanuc").expansion.unexpanded_calls.size() >= 1);
  }
}

TEST_CASE("a copy that fails half way has no effect on the text") {
  const std::string text = go +
                           "o1 call [1]\no2 call [2]\nM2\no1 sub\no2 call [#1]\nX#5\nY#<y>\no1 endsub\n"
                           "o2 sub\nX#1\no2 endsub\n";
  const Program program = expanded(text);
  CHECK(program.text == go + "o1 call [1]\nX2\n" + text.substr(text.find("M2\n")));
  CHECK(program.expansion.calls == 1);
  CHECK(program.moves.back().line == 12);
}

TEST_CASE("a subprogram that always calls itself is refused, and repeats are limited") {
  CHECK(diagnostic_of([] {
          expanded(fanuc_go + "M98 P2\nM30\nO2\nX1.\nM98 P3\nM99\nO3\n N5 M98 P2\nM99\n", "fanuc");
        }) ==
        "p.nc:11:5: error: the subprogram calls itself: its expansion does not end (called from line 8)");
  const std::string nested = fanuc_go + "M98 P2 L9999\nM30\nO2\nM98 P3 L9000\nM99\nO3\nX1.\nM99\n";
  CHECK(diagnostic_of([&] {
          expanded(nested, "fanuc");
        }).find("p.nc:7:1: error: M98: the expansion adds more than 500000 lines") == 0);
  const std::string body(200'000, ' ');
  CHECK(diagnostic_of([&] {
          expanded(fanuc_go + "M98 P2 L9999\nM30\nO2\n(" + body + ")\nM99\n", "fanuc");
        }).find("p.nc:4:1: error: M98: the expansion adds more than 64000000 bytes") == 0);
}

TEST_CASE("a pattern of many pockets is expanded") {
  std::string pocket;
  for (int i = 0; i < 100; ++i) pocket += fmt::format("G1 X{}. Y{}. Z-{}. F100\n", i % 7, i % 5, i % 3);
  const Program program = expanded(fanuc_go + "M98 P2 L200\nM30\nO2\n" + pocket + "M99\n", "fanuc");
  CHECK(program.moves.size() == 20'001);
}

TEST_CASE("blocks in a definition do not run when all calls are expanded, but they stay in the text") {
  const std::string subs = "o1 sub\nG1 X7\no1 endsub\n";
  const Program program = expanded(go + subs + "o1 call\nX3\nM2\n");
  CHECK(program.text == go + subs + "G1 X7\nX3\nM2\n");
  CHECK(program.moves.size() == 3);
  CHECK(program.left_alone.empty());
  CHECK(expanded(program.text).moves.size() == 3);
  CHECK(expanded(go + subs + "o1 call\no2 call\nX3\nM2\n").moves.size() == 4);
  CHECK(expanded(subs + go + "o1 call\no2 call\nX3\nM2\n").moves.size() == 5);
  const Program numbered = expanded("O2\nX1.\nM99\nO1\n" + go + "M98 P2\nM30\n", "fanuc");
  CHECK(path_of(numbered) == path_of(read(fanuc_go + "X1.\nM30\n", "fanuc")));
  // A file of subprograms is for calls from other files.
  CHECK(expanded("G21\no1 sub\nG1 X7\no1 endsub\no2 sub\nG1 X8\no2 endsub\nM2\n").moves.size() == 2);
  // Here O2 may be the program, which runs over and over.
  CHECK(expanded("O2\n" + go + "M98 P3\nM99\nO3\nX1.\nM99\n", "fanuc").moves.size() == 3);
}

TEST_CASE("remarks report the expansion, or that there is nothing to expand") {
  const Program program = expanded(go + "o1 call\no1 call\nM2\no1 sub\nX1\no1 endsub\n");
  const auto has_remark = [](const Program& p, int line, std::string_view what) {
    return std::any_of(p.remarks.begin(), p.remarks.end(), [&](const Remark& r) {
      return r.line == line && r.what.find(what) != std::string::npos;
    });
  };
  CHECK(has_remark(program, 3, "2 calls of subprograms replaced by the bodies"));
  for (const std::string dialect : {"grbl", "linuxcnc"})
    CHECK(has_remark(expanded("G90\nM5\n", dialect), 1, "no call by M98 or an O-word"));
  CHECK(has_remark(expanded("G90\nM5\n", "siemens"), 1, "the program has no loop, condition or jump"));
  CHECK(has_remark(expanded("BEGIN PGM A MM\nL X+1 R0 FMAX\nEND PGM A MM\n"), 1,
                   "no call by M98 or an O-word"));
}

TEST_CASE("each copy of a call is rewritten separately") {
  const std::string subs = "M2\no1 sub\nG1 X#1\nY2\no1 endsub\n";
  const Program program = expanded(go + "o1 call [1]\no1 call [2]\n" + subs);
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (std::size_t i = 1; i < edits.size(); ++i) edits[i].end_mm.x() += 0.1 * static_cast<double>(i);
  CHECK(rewrite(program, edits, {}).text ==
        "G21 G90 G17 F100\nG0 X0. Y0. Z5.\nG1 X1.1\nY2 X1.200\nG1 X2.3\nY2 X2.400\n" + subs);
}

TEST_CASE(
    "the motion word is repeated behind a definition that has one, because the definition does not run") {
  for (const char* const rest : {"X0 I-5\nM2\n", "X0 I-5\no2 call\nM2\n"}) {
    CAPTURE(rest);
    const Program program = expanded(go + "G2 X10 I5\no1 sub\nG2 X1 I2\no1 endsub\n" + rest);
    REQUIRE(program.moves.size() >= 3);
    const MoveEdit chord{.move = 1, .end_mm = {10, 0.5, 5}};
    const std::string text = rewrite(program, {chord}, {}).text;
    CHECK(text.find("o1 endsub\nG2 X0 I-5\n") != std::string::npos);
  }
}
