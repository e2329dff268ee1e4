#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/program/program_reader.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using Names = std::vector<std::string>;

const std::string& operation_of(const Program& program, const Move& move) {
  return program.operations.at(move.operation);
}

Names operations_in(const Program& program) {
  Names names;
  for (const Move& move : program.moves) names.push_back(operation_of(program, move));
  return names;
}

Names operations_in(const std::string& text, const std::string& dialect = "auto") {
  return operations_in(read(text, dialect));
}

/// The operation after `line`, with OLD as the operation before it.
std::string named_by(const std::string& line, const std::string& dialect = "fanuc") {
  const std::string begin = dialect == "siemens" ? ";OLD\n" : "(OLD)\n";
  return operations_in((dialect == "siemens" ? "G71 G90\n" : "G21 G90\n") + begin + line + "\nG0 X1.\n",
                       dialect)
      .at(0);
}

std::vector<std::int32_t> tools_in(const std::string& text, const std::string& dialect = "linuxcnc") {
  std::vector<std::int32_t> tools;
  const std::string begin = dialect == "siemens" ? "G71 G90\n" : "G21 G90\n";
  for (const Move& move : read(begin + text, dialect).moves) tools.push_back(move.tool);
  return tools;
}

}  // namespace

TEST_CASE("a comment alone in its line names the moves after it, until the next one") {
  CHECK(operations_in("G21 G0 X1\n(POCKET1)\nX2\nX3 (beside)\n; Drill 4 mm\nX4\n\nX5\n") ==
        Names{"", "POCKET1", "POCKET1", "Drill 4 mm", "Drill 4 mm"});
}

TEST_CASE("a comment with only a block number or '/' in its line is alone, one with words is not") {
  for (const char* const line : {"N10 (NEW)", "/ (NEW)", "/2 N10 (NEW)", "N10 / (NEW) ;", "(NEW) (SECOND)",
                                 "(FORCE FX=1) (NEW)", "( ) (NEW)"}) {
    CAPTURE(line);
    CHECK(named_by(line) == "NEW");
  }
  for (const char* const line : {"M5 (NEW)", "(NEW) M5", "T2 (NEW)", "#1=5 (NEW)", "(FORCE OFF)",
                                 "(force fx=1)", "(COUNTERFLEX 1 METHOD DIRECT)", "()", "( )", "(-----)"}) {
    CAPTURE(line);
    CHECK(named_by(line) == "OLD");
  }
}

TEST_CASE("a comment with a command for the control is not an operation") {
  for (const char* const line :
       {"(MSG, change the clamps)", "(msg,)", "(DEBUG, #5)", "(PRINT,x)", "(LOG, #1)", "(LOGOPEN,a.txt)",
        "(LOGAPPEND,a.txt)", "(LOGCLOSE)", "(PROBEOPEN a.txt)", "(probeclose)", "( MSG,a)"}) {
    CAPTURE(line);
    CHECK(named_by(line, "linuxcnc") == "OLD");
  }
  for (const char* const line : {"(LOG HOUSE)", "(PROBE)", "(MSG)", "(PRINTED PART, LEFT)", "(LOGCLOSET)"}) {
    CAPTURE(line);
    const std::string name(line);
    CHECK(named_by(line, "linuxcnc") == name.substr(1, name.size() - 2));
  }
}

TEST_CASE("the name of a program is not an operation") {
  CHECK(operations_in("%\nO1001 (BRACKET)\nG21 G90\nG0 X1.\n(FACE)\nX2.\n%\n") == Names{"", "FACE"});
  CHECK(operations_in("<BRACKET> (PART)\nG21 G90\nG0 X1.\n", "fanuc") == Names{""});
  CHECK(operations_in("% (PART)\nG21 G90\nG0 X1.\n", "fanuc") == Names{""});
}

TEST_CASE("marks and blanks around a name do not belong to it") {
  CHECK(named_by("( --- POCKET-2 *** )") == "POCKET-2");
  CHECK(named_by("(=== 2D # 1 ===)") == "2D # 1");
  CHECK(named_by("; (POCKET)") == "POCKET");
  CHECK(named_by("; ---- (POCKET) ----", "linuxcnc") == "POCKET");
  CHECK(named_by("; POCKET (ROUGH)", "linuxcnc") == "POCKET (ROUGH)");
  CHECK(named_by("(POCKET (ROUGH))", "fanuc") == "POCKET (ROUGH)");
  CHECK(named_by("(COUNTERFLEX 12)") == "COUNTERFLEX 12");
}

TEST_CASE("comments of a Sinumerik name operations, except in lines with statements") {
  CHECK(named_by("; *** SLOT ***", "siemens") == "SLOT");
  CHECK(named_by("N30 ;SLOT", "siemens") == "SLOT");
  for (const char* const line : {"STOPRE ;SLOT", "LABEL1: ;SLOT", "R1=5 ;SLOT", "MSG(\"A\") ;SLOT",
                                 "T=\"MILL\" ;SLOT", "TRANS ;SLOT"}) {
    CAPTURE(line);
    CHECK(named_by(line, "siemens") == "OLD");
  }
}

TEST_CASE("Klartext's comments and structure lines name operations") {
  const Program program = read(
      "0 BEGIN PGM A MM\n1 L X+1 F100\n2 * - ROUGHING\n3 L X+2 ;beside\n4 ; Slot 3\n5 ;FORCE FX=1\n"
      "6 L X+3\n7 ; FORCE OFF\n8 ;---\n9 L X+4\n");
  CHECK(operations_in(program) == Names{"", "ROUGHING", "Slot 3", "Slot 3"});
  CHECK(program.moves[2].force.has_value());
  CHECK_FALSE(program.moves[3].force.has_value());
}

TEST_CASE("comments of a subprogram name the moves that replace its call") {
  ReadOptions options;
  options.expand_subprograms = true;
  const Program program = read_program(
      "%\nO1\nG21 G90\nG0 X0. Y0. Z5.\n(A)\nM98 P2\n(B)\nM98 P2\nG0 X9.\nM30\nO2\nG1 X1. F100.\n(HOLE)\n"
      "X2.\nM99\n%\n",
      "p.nc", options);
  CHECK(operations_in(program) == Names{"", "A", "HOLE", "B", "HOLE", "HOLE"});
}

TEST_CASE("only operations with moves are kept, again each time that one begins") {
  const Program program = read("G21 F9 G1 X0\n(A)\n(B)\nX1\n(C)\n(B)\nX2\n(A)\nX3\n(D)\n");
  CHECK(program.operations == Names{"", "B", "A"});
  CHECK(operations_in(program) == Names{"", "B", "B", "A"});
}

Names titles_in(const std::string& text, const std::string& dialect = "auto") {
  const Program program = read(text, dialect);
  Names titles;
  for (const Move& move : program.moves) titles.push_back(program.operation_titles.at(move.operation));
  return titles;
}

TEST_CASE("a title is the first comment after a tool change, a blank line or a rapid move") {
  CHECK(titles_in("(PART)\n(REMARK)\nG21 G90 F100\nG1 X1\n") == Names{""});
  CHECK(titles_in("(PART)\nG21 G90 F100\nT1 M6\nS100 M3\n(POCKET)\n(SPEED 100)\nG1 X1\n(REMARK)\nX2\n") ==
        Names{"POCKET", "POCKET"});
  CHECK(titles_in("G21 G90 F100\n\n(POCKET)\n(SPEED 100)\nG1 X1\n \r\n(SLOT)\nX2\n") ==
        Names{"POCKET", "SLOT"});
  CHECK(titles_in("G21 G90 F100\nG1 X1\nG0 X9\n(STEP)\nG1 X2\n") == Names{"", "", "STEP"});
  CHECK(titles_in("G21 G90 F100\n\n(POCKET)\nT1 M6\n(SPEED 100)\nG1 X1\nT2 M6\nX2\n(REMARK)\nX3\n") ==
        Names{"POCKET", "POCKET", "POCKET"});
}

TEST_CASE("a structure line of a Klartext program is a title, another comment only as in other dialects") {
  CHECK(titles_in("0 BEGIN PGM A MM\n1 ; PART\n2 L X+1 F100\n3 * - ROUGHING\n4 ; REMARK\n5 L X+2\n6 TOOL "
                  "CALL 3 Z S500\n"
                  "7 ; Slot 3\n8 L X+3\n") == Names{"", "ROUGHING", "Slot 3"});
}

TEST_CASE("a window has its own operations, independent of the windows before it") {
  std::string text = "(FIRST)\nG21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F100\n";
  for (int i = 0; i < 3000; ++i)
    text += fmt::format("{}{}X{} Y{}\n", i % 18 == 1 ? "\n" : "",
                        i % 3 == 1 ? fmt::format("(OP {})\n", i / 9) : "", i % 50, i / 50);
  const Program whole = read(text);
  for (const std::size_t least : {1, 7, 100}) {
    CAPTURE(least);
    FileReader bytes = FileReader::of_bytes(text);
    ProgramReader reader(bytes, "p.ngc", {}, least);
    std::size_t index = 0;
    while (reader.next()) {
      const Program& window = reader.window();
      CHECK(window.operations.size() <= window.moves.size() + 3);
      if (window.before)
        CHECK(operation_of(window, *window.before) == operation_of(whole, whole.moves.at(index - 1)));
      for (const Move& move : window.moves) {
        CHECK(window.operation_titles.at(move.operation) ==
              whole.operation_titles.at(whole.moves.at(index).operation));
        CHECK(operation_of(window, move) == operation_of(whole, whole.moves.at(index++)));
      }
      if (window.after)
        CHECK(operation_of(window, *window.after) == operation_of(whole, whole.moves.at(index)));
    }
    CHECK(index == whole.moves.size());
  }
}

TEST_CASE("without a tool change, the tool of G43's length is the active one") {
  using Tools = std::vector<std::int32_t>;
  CHECK(tools_in("G0 X1\nG43 H3 Z5\nX2\nT4 M6\nX3\nG43 H5 Z5\nX4\n") == Tools{0, 3, 3, 4, 4, 4});
  CHECK(tools_in("G0 G43 H3 Z5\nG49\nX1\n") == Tools{3, 0});
  CHECK(tools_in("G0 G43 H#1 Z5\nG43 Z6\n") == Tools{0, 0});
  CHECK(tools_in("T5 D1\nG0 X1\nT7 M6\nX2\nT=\"MILL\" M6\nX3\n", "siemens") == Tools{0, 7, 0});
}

TEST_CASE("a tool number outside of all tables is unknown") {
  using Tools = std::vector<std::int32_t>;
  CHECK(tools_in("T2147483647 M6\nG0 X1\nT2147483648 M6\nX2\nT4294967297 M6\nX3\n") ==
        Tools{2147483647, 0, 0});
  CHECK(tools_in("G43 H4294967297 G0 X1\nG43 H99999999999 X2\n") == Tools{0, 0});
  const Program klartext = read("BEGIN PGM A MM\nTOOL CALL 4294967297 Z\nL X+1 F100\n");
  CHECK(klartext.moves.at(0).tool == 0);
}
