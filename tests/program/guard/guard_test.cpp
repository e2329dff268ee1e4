// Guards: their exact texts in each language, where they are, and that readers take them as comments.
#include "counterflex/program/guard.hpp"

#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Guard guard_of(const std::string& offset) {
  Guard guard;
  guard.active = {offset, {120, 80, -250.5}, Matrix3::Identity()};
  guard.window_mm = 0.25;
  guard.tool = 3;
  guard.length_mm = 92.5;
  return guard;
}

std::string guarded(const Program& program, const Guard& guard) {
  return rewrite(program, {}, {.guard = guard}).text;
}

/// What the guard adds: the part behind the beginning that both texts have, up to the end that both have.
std::string added(const std::string& original, const std::string& text, std::size_t at) {
  REQUIRE(text.size() > original.size());
  CHECK(text.substr(0, at) == original.substr(0, at));
  const std::size_t size = text.size() - original.size();
  CHECK(text.substr(at + size) == original.substr(at));
  return text.substr(at, size);
}

/// The guard of a program that is given as the text before and behind it. Its moves are read back as without
/// it.
std::string text_of_guard(const std::string& before, const std::string& behind, const std::string& dialect,
                          const Guard& guard) {
  const Program program = read(before + behind, dialect);
  const std::string text = guarded(program, guard);
  const Program again = read(text, dialect);
  CHECK(again.moves.size() == program.moves.size());
  CHECK(again.left_alone.size() == program.left_alone.size());
  CHECK(again.block_count == program.block_count);
  CHECK(again.operations == program.operations);
  for (std::size_t i = 0; i < std::min(again.moves.size(), program.moves.size()); ++i) {
    CAPTURE(i);
    CHECK(again.moves[i].end_mm == program.moves[i].end_mm);
    CHECK(again.moves[i].known_end == program.moves[i].known_end);
    CHECK(again.moves[i].fixed == program.moves[i].fixed);
    CHECK(again.moves[i].tool == program.moves[i].tool);
  }
  CHECK(all_known(again.moves.back().known_end));
  return added(before + behind, text, before.size());
}

std::string replaced_once(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

/// Without the digits of the marks.
std::string without_marks(std::string text) {
  for (std::size_t at = 0; (at = text.find("CF ", at)) != std::string::npos; ++at)
    if (at + 11 <= text.size() && text.find_first_not_of("0123456789ABCDEF", at + 3) >= at + 11)
      text.replace(at + 3, 8, "#");
  return text;
}

}  // namespace

TEST_CASE("a line with its right mark is one of a guard, and no other line is") {
  const std::string line = marked_line("IF [#4006 NE 21] THEN #3000=101(", " G21)");
  CHECK(line == "IF [#4006 NE 21] THEN #3000=101(CF FE8BA8C1 G21)");
  CHECK(is_guard_line(line));
  CHECK(is_guard_line("  " + line + " \r"));
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string edited = line;
    edited[i] = edited[i] == '1' ? '2' : '1';
    CAPTURE(edited);
    CHECK_FALSE(is_guard_line(edited));
  }
  CHECK_FALSE(is_guard_line(line + "X10"));
  for (const char* other : {"", "CF ", "CF 1234567", "(CF 12345678)", "G1 X10 (CF 1A2B3C4D)"})
    CHECK_FALSE(is_guard_line(other));
}

TEST_CASE("the guard of LinuxCNC") {
  CHECK(without_marks(text_of_guard("G21 G90 G54\nT3 M6\nG0 X0 Y0\nG43 H3 Z5.\n",
                                    "N50 G1 Z-1. F200\nX10.\nM2\n", "linuxcnc", guard_of("G54"))) ==
        R"((COUNTERFLEX 1 GUARD: CORRECTED FOR G54 AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM)
o<counterflex_guard_1> if [#<_metric> NE 1] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: THE UNIT MUST BE MM, G21)
o<counterflex_guard_1> endif (CF #)
o<counterflex_guard_2> if [#5220 NE 1] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: G54 MUST BE ACTIVE)
o<counterflex_guard_2> endif (CF #)
o<counterflex_guard_3> if [#5210 NE 0] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: NO G92 OR G52 MAY ACT)
o<counterflex_guard_3> endif (CF #)
o<counterflex_guard_4> if [ABS[#5221 - [120]] GT 0.25] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: G54 X MUST BE 119.75 TO 120.25 MM)
o<counterflex_guard_4> endif (CF #)
o<counterflex_guard_5> if [ABS[#5222 - [80]] GT 0.25] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: G54 Y MUST BE 79.75 TO 80.25 MM)
o<counterflex_guard_5> endif (CF #)
o<counterflex_guard_6> if [ABS[#5223 - [-250.5]] GT 0.25] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: G54 Z MUST BE -250.75 TO -250.25 MM)
o<counterflex_guard_6> endif (CF #)
o<counterflex_guard_7> if [ABS[#5230 - [0]] GT 0.0001] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: THE ROTATION OF G54 MUST BE 0 DEG)
o<counterflex_guard_7> endif (CF #)
o<counterflex_guard_8> if [#5400 NE 3] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: TOOL T3 MUST BE IN THE SPINDLE)
o<counterflex_guard_8> endif (CF #)
o<counterflex_guard_9> if [ABS[#5403 - [92.5]] GT 0.25] (CF #)
(CF #) (abort, COUNTERFLEX GUARD: THE TOOL LENGTH MUST BE 92.25 TO 92.75 MM)
o<counterflex_guard_9> endif (CF #)
)");
}

TEST_CASE(
    "an offset that is turned about Z has the checks of one that is not, one turned about X or Y has none") {
  Guard guard = guard_of("G54");
  guard.turn_deg = -30;
  const std::string cut = "G0 X0 Y0 Z5\n", behind = "G1 Z-1 F200\nM30\n";
  const std::string linuxcnc = text_of_guard("G21 G90 G54\n" + cut, behind, "linuxcnc", guard),
                    siemens = text_of_guard("G71 G90 G54\n" + cut, behind, "siemens", guard);
  CHECK(linuxcnc.find("[#5210 NE 0]") != std::string::npos);
  CHECK(linuxcnc.find("[ABS[#5230 - [-30]] GT 0.0001]") != std::string::npos);
  CHECK(siemens.find("ABS($P_IFRAME[Z,RT]-(-30))>0.0001") != std::string::npos);
  guard.turn_deg.reset();
  for (const char* dialect : {"linuxcnc", "siemens", "heidenhain"})
    CHECK(why_no_guard(dialect, guard) ==
          "G54 is turned about X or Y, and the checks compare a turn about Z alone: leave out --guard");
}

TEST_CASE("registers of LinuxCNC are in the unit of its machine, and those of G59.3 the last ones") {
  Guard guard = guard_of("G59.3");
  guard.control = LengthUnit::inches;
  guard.active.shown_mm = {25.4, 0, -50.8};
  guard.program_shifts = true;
  guard.tool = 0;
  guard.length_mm.reset();
  const std::string text =
      text_of_guard("G20 G90 G59.3\nG0 X0 Y0 Z1.\n", "G1 Z-1. F20\nM2\n", "linuxcnc", [&] {
        guard.unit = LengthUnit::inches;
        return guard;
      }());
  CHECK(text.find("[#<_metric> NE 0]") != std::string::npos);
  CHECK(text.find("[#5220 NE 9]") != std::string::npos);
  CHECK(text.find("[ABS[#5381 - [1]] GT 0.009842]") != std::string::npos);  // rounded down
  CHECK(text.find("[ABS[#5383 - [-2]] GT 0.009842]") != std::string::npos);
  for (const char* other : {"#5210", "ROTATION", "#5400", "#5403"})
    CHECK(text.find(other) == std::string::npos);
}

TEST_CASE("the guard of a Fanuc, and of a Haas") {
  const std::string before = "%\nO1001\nG21 G90 G54\nT3 M6\nG0 X0. Y0.\nG43 Z5. H3\n",
                    behind = "N50 G1 Z-1. F200.\nX10.\nM30\n%\n";
  const std::string fanuc = text_of_guard(before, behind, "fanuc", guard_of("G54"));
  CHECK(without_marks(fanuc) ==
        R"((COUNTERFLEX 1 GUARD: CORRECTED FOR G54 AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM)
IF [#4006 NE 21] THEN #3000=101(CF # G21)
IF [#4014 NE 54] THEN #3000=102(CF # G54)
IF [ABS[#5201+#5221-[120]] GT 0.25] THEN #3000=103(CF # G54 X)
IF [ABS[#5202+#5222-[80]] GT 0.25] THEN #3000=104(CF # G54 Y)
IF [ABS[#5203+#5223-[-250.5]] GT 0.25] THEN #3000=105(CF # G54 Z)
IF [#4120 NE 3] THEN #3000=106(CF # TOOL T3)
IF [ABS[#[2200+#4111]+#[2000+#4111]-[92.5]] GT 0.25] THEN #3000=107(CF # TOOL LENGTH)
)");
  for (std::size_t at = 0; (at = fanuc.find("(CF ", at)) != std::string::npos; ++at)
    CHECK(fanuc.find(')', at) - at - 1 <= 26);  // what the alarm shows
  const std::string haas = without_marks(text_of_guard(before, behind, "haas", guard_of("G54")));
  CHECK(haas.find("IF [#3026 NE 3] THEN #3000=106(CF # TOOL T3)") != std::string::npos);
  CHECK(haas.find("IF [ABS[#[2000+#4111]+#[2200+#4111]-[92.5]] GT 0.25] THEN #3000=107(CF # TOOL LENGTH)") !=
        std::string::npos);
}

TEST_CASE("additional offsets of a Fanuc have numbers of their own, and a preselected tool is not compared") {
  Guard guard = guard_of("G54.1 P3");
  guard.is_chosen = false;
  const std::string text = without_marks(text_of_guard("O1\nG21 G90 G54.1 P3\nT3 M6\nT4\nG0 X0. Y0. Z5.\n",
                                                       "G1 Z-1. F200.\nM30\n", "fanuc", guard));
  CHECK(text.find("IF [#4130 NE 3] THEN #3000=102(CF # G54.1 P3)") != std::string::npos);
  CHECK(text.find("IF [ABS[#5201+#7041-[120]] GT 0.25]") != std::string::npos);
  CHECK(text.find("#4120") == std::string::npos);
  guard.active.name = "G54.1 P49";
  CHECK(guarded(read("O1\nG21 G90\nG54.1 P49\nG0 X0. Y0. Z5.\nG1 Z-1. F200.\n", "fanuc"), guard)
            .find("#5201+#14961-") != std::string::npos);
  CHECK(why_no_guard("haas", guard) == "guards for Haas check G54 to G59, not G54.1 P49: leave out --guard");
}

TEST_CASE("the guard of a Sinumerik") {
  Guard guard = guard_of("G54");
  const std::string title =
      "; COUNTERFLEX 1 GUARD: CORRECTED FOR G54 AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM\n";
  const auto check = [](const std::string& condition, int alarm, const std::string& message) {
    return "IF " + condition + " ; CF #\nSETAL(" + std::to_string(65000 + alarm) +
           ",\"COUNTERFLEX GUARD: " + message + "\") ; CF #\nENDIF ; CF #\n";
  };
  CHECK(without_marks(text_of_guard("G71 G90 G54\nT3 D1\nM6\nG0 X0 Y0 Z5\n", "N50 G1 Z-1 F200\nX10\nM30\n",
                                    "siemens", guard)) ==
        title + check("($P_GG[13]<>2) AND ($P_GG[13]<>4)", 0, "THE UNIT MUST BE MM, G71") +
            check("$P_UIFRNUM<>1", 1, "G54 MUST BE ACTIVE") +
            check("ABS($P_IFRAME[X,TR]+$P_IFRAME[X,FI]-(120))>0.25", 2, "G54 X MUST BE 119.75 TO 120.25 MM") +
            check("ABS($P_IFRAME[Y,TR]+$P_IFRAME[Y,FI]-(80))>0.25", 3, "G54 Y MUST BE 79.75 TO 80.25 MM") +
            check("ABS($P_IFRAME[Z,TR]+$P_IFRAME[Z,FI]-(-250.5))>0.25", 4,
                  "G54 Z MUST BE -250.75 TO -250.25 MM") +
            check("ABS($P_IFRAME[X,RT])+ABS($P_IFRAME[Y,RT])+ABS($P_IFRAME[Z,RT]-(0))>0.0001", 5,
                  "THE ROTATION OF G54 MUST BE 0 DEG") +
            check("ABS($P_PFRAME[X,TR])+ABS($P_PFRAME[Y,TR])+ABS($P_PFRAME[Z,TR])>0.001", 6,
                  "NO TRANS MAY ACT") +
            check("$P_TOOLNO<>3", 7, "TOOL T3 MUST BE ACTIVE") +
            check("ABS($P_TOOLL[1]-(92.5))>0.25", 8, "THE TOOL LENGTH MUST BE 92.25 TO 92.75 MM"));
  guard.active.name = "G505";
  CHECK(guarded(read("G71 G90 G505\nG0 X0 Y0 Z5\nG1 Z-1 F200\n", "siemens"), guard)
            .find("IF $P_UIFRNUM<>5 ;") != std::string::npos);
  guard.active.name = "G58";
  CHECK(why_no_guard("siemens", guard).starts_with("G58 is not a settable frame of the control"));
  guard.active.name = "G54";
  guard.unit = LengthUnit::inches;
  CHECK(why_no_guard("siemens", guard).starts_with("the program and the control have different units"));
}

TEST_CASE("the guard of Klartext, whose blocks are numbered again") {
  const auto check = [](const std::string& what, const std::string& condition, int error, int label) {
    const std::string name = "\"CFGUARD" + std::to_string(label) + "\"";
    return "; COUNTERFLEX 1 GUARD: " + what + "\nFN " + condition + " GOTO LBL " + name +
           " ; CF #\nFN 14: ERROR = " + std::to_string(error) + " ; CF #\nLBL " + name + " ; CF #\n";
  };
  const auto read_preset = [](int column) {
    return "FN 18: SYSREAD Q1991 = ID507 NRQ1990 IDX" + std::to_string(column) + " ; CF #\n";
  };
  const auto shift = [](int axis) {
    return "FN 18: SYSREAD Q" + std::to_string(1990 + axis) + " = ID220 NR2 IDX" + std::to_string(axis) +
           " ; CF #\n";
  };
  const std::string expected =
      "; COUNTERFLEX 1 GUARD: CORRECTED FOR G54 AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM\n"
      "FN 18: SYSREAD Q1990 = ID530 NR1 ; CF #\n" +
      read_preset(1) + "Q1991 = ABS ( Q1991 - ( 120 ) ) ; CF #\n" +
      check("PRESET X MUST BE 119.75 TO 120.25 MM", "12: IF +Q1991 LT +0.25", 1005, 1) + read_preset(2) +
      "Q1991 = ABS ( Q1991 - ( 80 ) ) ; CF #\n" +
      check("PRESET Y MUST BE 79.75 TO 80.25 MM", "12: IF +Q1991 LT +0.25", 1005, 2) + read_preset(3) +
      "Q1991 = ABS ( Q1991 - ( -250.5 ) ) ; CF #\n" +
      check("PRESET Z MUST BE -250.75 TO -250.25 MM", "12: IF +Q1991 LT +0.25", 1005, 3) + read_preset(6) +
      "Q1991 = ABS ( Q1991 - ( 0 ) ) ; CF #\n" +
      check("PRESET SPC MUST BE 0 DEG", "12: IF +Q1991 LT +0.0001", 1005, 4) + shift(1) + shift(2) +
      shift(3) + "Q1991 = ABS Q1991 + ABS Q1992 + ABS Q1993 ; CF #\n" +
      check("NO DATUM SHIFT MAY ACT", "9: IF +Q1991 EQU +0", 1005, 5) +
      "FN 18: SYSREAD Q1991 = ID20 NR1 ; CF #\n" +
      check("TOOL 3 MUST BE ACTIVE", "9: IF +Q1991 EQU +3", 1011, 6) +
      "FN 18: SYSREAD Q1991 = ID200 NR2 IDX1 ; CF #\nQ1991 = ABS ( Q1991 - ( 92.5 ) ) ; CF #\n" +
      check("TOOL LENGTH MUST BE 92.25 TO 92.75 MM", "12: IF +Q1991 LT +0.25", 1011, 7);
  CHECK(without_marks(text_of_guard("BEGIN PGM P MM\nTOOL CALL 3 Z S2000\nL X+0 Y+0 Z+5 R0 FMAX\n",
                                    "L Z-1 F200\nL X+10\nEND PGM P MM\n", "heidenhain", guard_of("G54"))) ==
        expected);

  const std::string before = "0 BEGIN PGM P MM\n1 TOOL CALL 3 Z S2000\n2 L X+0 Y+0 Z+5 R0 FMAX\n";
  const std::string text =
      guarded(read(before + "3 L Z-1 F200\n4 END PGM P MM\n", "heidenhain"), guard_of("G54"));
  std::string numbered = before;
  long number = 3;
  for (std::size_t at = 0; at < expected.size(); at = expected.find('\n', at) + 1)
    numbered += std::to_string(number++) + " " + expected.substr(at, expected.find('\n', at) + 1 - at);
  numbered += std::to_string(number) + " L Z-1 F200\n" + std::to_string(number + 1) + " END PGM P MM\n";
  CHECK(without_marks(text) == numbered);
  CHECK(read(text, "heidenhain").moves.size() == 2);
}

TEST_CASE("the guard of KRL") {
  Guard guard = guard_of("BASE_DATA[1]");
  guard.active.R = from_rpy(Vector3(0, 0, 90 * deg));
  const auto check = [](const std::string& condition, const std::string& message) {
    return "IF " + condition + " THEN ; CF #\n; COUNTERFLEX 1 GUARD: " + message +
           "\nLOOP ; CF #\nHALT ; CF #\nENDLOOP ; CF #\nENDIF ; CF #\n";
  };
  const auto angle = [&](char name, const std::string& value) {
    const std::string off = std::string("ABS($BASE.") + name + "-(" + value + "))";
    return check("(" + off + ">0.002) AND (ABS(" + off + "-360)>0.002)",
                 std::string("$BASE.") + name + " MUST BE " + value + " DEG");
  };
  CHECK(without_marks(text_of_guard(
            "DEF part()\n$TOOL=TOOL_DATA[3]\n$BASE=BASE_DATA[1]\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 0}\n",
            "LIN {X 0,Y 0,Z -1,A 0,B 0,C 0} ;cut\nEND\n", "kuka", guard)) ==
        "; COUNTERFLEX 1 GUARD: CORRECTED FOR BASE_DATA[1] AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM\n" +
            check("ABS($BASE.X-(120))>0.25", "$BASE.X MUST BE 119.75 TO 120.25 MM") +
            check("ABS($BASE.Y-(80))>0.25", "$BASE.Y MUST BE 79.75 TO 80.25 MM") +
            check("ABS($BASE.Z-(-250.5))>0.25", "$BASE.Z MUST BE -250.75 TO -250.25 MM") + angle('A', "90") +
            angle('B', "0") + angle('C', "0") +
            check("ABS($TOOL.X-TOOL_DATA[3].X)+ABS($TOOL.Y-TOOL_DATA[3].Y)+ABS($TOOL.Z-TOOL_DATA[3].Z)>0.01",
                  "$TOOL MUST BE TOOL_DATA[3]"));
}

TEST_CASE("the guard of RAPID") {
  Guard guard = guard_of("table");
  guard.active.R = from_rpy(Vector3(0, 0, 90 * deg));
  const auto check = [](const std::string& condition, const std::string& message) {
    return "IF " + condition + " THEN ! CF #\nTPWrite \"GUARD: " + message +
           "\"; ! CF #\nEXIT; ! CF #\nENDIF ! CF #\n";
  };
  const std::string target = "[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
  const std::string origin = "PoseVect(table.uframe,table.oframe.trans)";
  const auto point = [&](const std::string& p) {
    return "PoseVect(table.uframe,PoseVect(table.oframe," + p + "))";
  };
  CHECK(without_marks(text_of_guard(
            "MODULE Part\nPROC main()\nMoveJ [[0,0,5]," + target + ",v100,fine,spindle\\WObj:=table;\n",
            "MoveL [[0,0,-1]," + target + ",v20,z1,spindle\\WObj:=table;\nENDPROC\nENDMODULE\n", "abb",
            guard)) ==
        "! COUNTERFLEX 1 GUARD: CORRECTED FOR table AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM\n" +
            check("Distance(" + origin + ",[120,80,-250.5])>0.25", "table POSITION") +
            check("Distance(" + point("[1000,0,0]") + "-" + origin + ",[0,1000,0])>0.035",
                  "table ORIENTATION") +
            check("Distance(" + point("[0,1000,0]") + "-" + origin + ",[-1000,0,0])>0.035",
                  "table ORIENTATION"));
  guard.active.name = "wobj0";
  CHECK(why_no_guard("abb", guard).starts_with("the first cut uses no work object"));
}

TEST_CASE("the guard of URScript") {
  Guard guard = guard_of("table");
  guard.active.R = from_rpy(Vector3(0, 0, 90 * deg));
  const auto check = [](const std::string& condition, const std::string& message) {
    return "if " + condition + ": # CF #\npopup(\"" + message +
           "\", \"COUNTERFLEX GUARD\", error=True) # CF #\nhalt # CF #\nend # CF #\n";
  };
  const std::string pose = "p[0.12,0.08,-0.2505,0,0,1.570796327]";
  CHECK(without_marks(text_of_guard("def part():\n  table = p[0.12, 0.08, -0.2505, 0, 0, 1.570796327]\n"
                                    "  movej(pose_trans(table, p[0, 0, 0.05, 0, 0, 0]))\n",
                                    "  movel(pose_trans(table, p[0, 0, 0, 0, 0, 0]), v=0.1)\nend\n", "ur",
                                    guard)) ==
        "# COUNTERFLEX 1 GUARD: CORRECTED FOR table AT X120 Y80 Z-250.5 MM, HOLDS WITHIN 0.25 MM\n" +
            check("point_dist(table," + pose + ")>0.00025", "table must be " + pose + " within 0.25 mm") +
            "counterflex_turn = pose_trans(pose_inv(" + pose + "), table) # CF #\n" +
            check("norm([counterflex_turn[3],counterflex_turn[4],counterflex_turn[5]])>0.000034907",
                  "table is turned"));
  guard.active.name.clear();
  CHECK(why_no_guard("ur", guard).starts_with("the first cut uses no feature that is a variable"));
}

TEST_CASE("the guard of FANUC TP, whose lines are numbered again") {
  const std::string position =
      "{\n   GP1:\n\tUF : 5, UT : 3,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = 0.000 mm,\tY = 0.000 mm,\tZ = "
      "0.000 mm,\n"
      "\tW = 0.000 deg,\tP = 0.000 deg,\tR = 0.000 deg\n};\n";
  const std::string before =
      "/PROG  P\n/ATTR\nLINE_COUNT\t= 4;\n/MN\n   1:  UFRAME_NUM=5 ;\n   2:  UTOOL_NUM=3 ;\n   3:J P[1] 50% "
      "FINE    ;\n";
  const std::string behind =
      "L P[2] 20mm/sec CNT100    ;\n/POS\nP[1]" + position + "P[2]" + position + "/END\n";
  const Program program = read(before + "   4:" + behind, "fanuc_tp");
  Guard guard = guard_of("UF 5");
  guard.active.R = from_rpy(Vector3(0, 0, 90 * deg));
  const std::string text = guarded(program, guard);
  std::string expected = replaced_once(before, "= 4;", "= 35;");
  int number = 4;
  const auto line = [&](const std::string& statement) {
    const std::string digits = std::to_string(number++);
    expected += std::string(4 - digits.size(), ' ') + digits + ":" + statement;
  };
  const auto check = [&](const std::string& statement) {
    line("  !COUNTERFLEX 1 CF # ;\n");
    line("  " + statement + " ;\n");
  };
  line("  !COUNTERFLEX 1 GUARD ;\n");
  check("IF $MNUFRAMENUM[1]<>5,JMP LBL[32701]");
  check("IF $MNUTOOLNUM[1]<>3,JMP LBL[32701]");
  check("PR[100]=UFRAME[5]");
  check("IF (PR[100,1]<119.75 OR PR[100,1]>120.25),JMP LBL[32701]");
  check("IF (PR[100,2]<79.75 OR PR[100,2]>80.25),JMP LBL[32701]");
  check("IF (PR[100,3]<(-250.75) OR PR[100,3]>(-250.25)),JMP LBL[32701]");
  check("IF (PR[100,4]<(-0.002) OR PR[100,4]>0.002),JMP LBL[32701]");
  check("IF (PR[100,5]<(-0.002) OR PR[100,5]>0.002),JMP LBL[32701]");
  check("IF (PR[100,6]<89.998 OR PR[100,6]>90.002),JMP LBL[32701]");
  check("JMP LBL[32702]");
  check("LBL[32701]");
  check("MESSAGE[COUNTERFLEX GUARD]");
  check("ABORT");
  check("LBL[32702]");
  line(behind);
  CHECK(without_marks(text) == replaced_once(expected, "= 35;", "= " + std::to_string(number - 1) + ";"));
  const Program again = read(text, "fanuc_tp");
  REQUIRE(again.moves.size() == program.moves.size());
  CHECK(all_known(again.moves.back().known_start));
  CHECK(again.moves.back().may_split == program.moves.back().may_split);
  CHECK(again.left_alone.size() == program.left_alone.size());
  for (const double half_turn : {180.0, -180.0}) {
    guard.active.R = from_rpy(Vector3(0, 0, half_turn * deg));
    CHECK(guarded(program, guard).find("IF (PR[100,6]<179.998 AND PR[100,6]>(-179.998)),JMP LBL[32701]") !=
          std::string::npos);
  }
  CHECK(reserved_for_guard("fanuc_tp", "   4:  PR[100]=LPOS ;") == "PR[100");
  CHECK(reserved_for_guard("fanuc_tp", before + behind).empty());
}

TEST_CASE("a check that was edited is a condition again, behind which positions are unknown") {
  const Program program = read("G21 G90 G54\nG0 X0 Y0 Z5.\nG1 Z-1. F200\nX10.\nM2\n", "linuxcnc");
  std::string text = guarded(program, guard_of("G54"));
  const std::size_t at = text.find("[120]");
  REQUIRE(at != std::string::npos);
  CHECK(all_known(read(text, "linuxcnc").moves[1].known_start));
  text.replace(at, 5, "[130]");
  CHECK_FALSE(diagnostic_of([&] {
                const Program again = read(text, "linuxcnc");
                if (!all_known(again.moves[1].known_start))
                  throw InputError(ErrorKind::program_text, {}, "unknown");
              }) == "none");
}

TEST_CASE("the first cut is a feed move or a cycle, and there is one guard in all windows of a program") {
  const auto line_of = [](const std::string& text) {
    const Program program = read(text, "linuxcnc");
    const Move* move = first_cut(program);
    return move == nullptr ? 0 : move->line;
  };
  CHECK(line_of("G21 G90\nG28\nG0 X0 Y0 Z5\nG53 G0 Z0\nG0 Z5\nG81 X1 Y1 Z-3 R1 F80\n") == 6);
  CHECK(line_of("G21 G90\nG0 X0 Y0 Z5\nG2 X1 I.5 F80\nM2\n") == 3);
  CHECK(line_of("G21 G90\nG0 X0 Y0 Z5\nM2\n") == 0);
  const Program first = read("G21 G90 G54\nG0 X0 Y0 Z5.\nG1 Z-1. F200\n", "linuxcnc");
  Rewriter writer({.guard = guard_of("G54")});
  CHECK(writer.write(first, {}).text.find("COUNTERFLEX 1 GUARD") != std::string::npos);
  CHECK(writer.write(first, {}).text.find("COUNTERFLEX 1 GUARD") == std::string::npos);
}

TEST_CASE("controls whose conditions cannot read an offset have no guard") {
  for (const char* dialect : {"grbl", "mach3", "apt", "yaskawa"}) {
    CAPTURE(dialect);
    CHECK(why_no_guard(dialect, guard_of("G54"))
              .starts_with(std::string(dialect) + " has no condition that reads"));
  }
  CHECK(why_no_guard("linuxcnc", guard_of("G54")).empty());
}
