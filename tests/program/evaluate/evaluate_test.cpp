#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/program/rewrite.hpp"
#include "program/evaluate/constant_expression.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::optional<double> bracketed(const std::string& text,
                                ExpressionSyntax syntax = ExpressionSyntax::linuxcnc) {
  return constant_value(text, syntax, [](const std::string& name) -> std::optional<double> {
    if (name == "#1") return 2;
    if (name == "#2") return 1;
    return name == "#<depth>" ? std::optional<double>(-3) : std::nullopt;
  });
}

std::optional<double> sinumerik(const std::string& text) {
  return constant_value(text, ExpressionSyntax::parentheses,
                        [](const std::string& name) -> std::optional<double> {
                          return name == "r1"       ? std::optional<double>(2)
                                 : name == "_depth" ? std::optional<double>(-3)
                                                    : std::nullopt;
                        });
}

Program evaluated(const std::string& text, const std::string& dialect = "linuxcnc") {
  ReadOptions options;
  options.dialect = dialect;
  options.evaluate = true;
  return read_program(text, "p.ngc", options);
}

const std::string start = "G21 G90 G17 G54 F100\nG0 X0. Y0. Z5.\n";

/// End of the last move, whose position must be known.
Vector3 end_of(const std::string& blocks, const std::string& dialect = "linuxcnc") {
  const std::string siemens_start = "G71 G90 G17 G54 F100\nG0 X0 Y0 Z5\n";
  const Program program = evaluated((dialect == "siemens" ? siemens_start : start) + blocks, dialect);
  CAPTURE(blocks);
  CHECK(all_known(program.moves.back().known_end));
  return program.moves.back().end_mm;
}

bool last_is_known(const std::string& blocks, const std::string& dialect = "linuxcnc") {
  return all_known(evaluated(start + blocks, dialect).moves.back().known_end);
}

/// The program with every end moved by (1, 0, 0) mm.
std::string moved(const Program& program) {
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < program.moves.size(); ++m)
    edits.push_back({.move = m, .end_mm = program.moves[m].end_mm + Vector3(1, 0, 0)});
  return rewrite(program, edits, {}).text;
}

}  // namespace

TEST_CASE("expressions have the values that LinuxCNC computes") {
  CHECK(bracketed("[1 + 2 * 3]") == 7);
  CHECK(bracketed("[[1 + 2] * 3 - #1 / 4]") == 8.5);
  CHECK(bracketed("-#1") == -2);
  CHECK(bracketed("##2") == 2);
  CHECK(bracketed("#[#2 + 0]") == 2);
  CHECK(bracketed("[#<Depth> * 2]") == -6);
  CHECK(bracketed("[2 ** 3 * 2]") == 16);
  CHECK(bracketed("[7 MOD 4]") == 3);
  CHECK(std::abs(*bracketed("SIN[30]") - 0.5) < 1e-15);
  CHECK(std::abs(*bracketed("[10 * COS[60] + SQRT[16]]") - 9) < 1e-12);
  CHECK(std::abs(*bracketed("ATAN[1]/[1]") - 45) < 1e-12);
  CHECK(bracketed("ABS[-3]") == 3);
  CHECK(bracketed("FIX[2.8]") == 2);
}

TEST_CASE("LinuxCNC rounds negative values and computes MOD of them as its interpreter shows") {
  struct Case {
    const char* expression;
    double value;
  };
  for (const Case& of : {Case{"FIX[-2.5]", -3},
                         {"FIX[-3]", -3},
                         {"FUP[-2.5]", -2},
                         {"FUP[-3]", -3},
                         {"ROUND[-2.4]", -2},
                         {"ROUND[-2.5]", -3},
                         {"ROUND[-2.6]", -3},
                         {"ROUND[-0.5]", -1},
                         {"[-7 MOD 4]", 1},
                         {"[7 MOD -4]", 3},
                         {"[-7 MOD -4]", 1},
                         {"[-8 MOD 4]", 0},
                         {"[-0.5 MOD 3]", 2.5},
                         {"[7.5 MOD -2]", 1.5}}) {
    CAPTURE(std::string(of.expression));
    CHECK(bracketed(of.expression) == of.value);
    for (const ExpressionSyntax other : {ExpressionSyntax::macro, ExpressionSyntax::brackets})
      CHECK_FALSE(bracketed(of.expression, other).has_value());
  }
  CHECK(bracketed("ROUND[0.49999999999999994]") == 1);  // adds 0.5 and truncates
  CHECK(std::abs(*bracketed("ASIN[-0.5]") + 30) < 1e-12);
  CHECK(std::abs(*bracketed("ATAN[-1]/[-2]") + 153.434948822922) < 1e-9);
  CHECK_FALSE(bracketed("ROUND[3000000000] / 1000").has_value());  // beyond the integers of LinuxCNC
  CHECK(end_of("#1=-2.5\nG1 X[FIX[#1]] Y[#1 MOD 2]\n") == Vector3(-3, 1.5, 5));
}

TEST_CASE("expressions of a Sinumerik are in round brackets, with its functions") {
  CHECK(sinumerik("R1 + 5") == 7);
  CHECK(sinumerik("(R1 - 1) * _DEPTH") == -3);
  CHECK(sinumerik("R[1] / 4") == 0.5);
  CHECK(sinumerik("TRUNC(2.8) + POT(3)") == 11);
  CHECK(std::abs(*sinumerik("ATAN2(1, 1)") - 45) < 1e-12);
}

TEST_CASE("comparisons and logic have the values 1 or 0, with the precedence of the control") {
  CHECK(bracketed("[#1 GT 1]") == 1);
  CHECK(bracketed("[[1 + 1] GT 1 AND 3 LT 2 + 2]") == 1);
  CHECK(bracketed("[1 OR 0 AND 0]") == 0);
  CHECK(bracketed("[2 AND 4]") == 1);
  CHECK(bracketed("[3 XOR 2]") == 0);
  CHECK(bracketed("[0.1 + 0.2 EQ 0.3]") == 1);
  CHECK(bracketed("[1 EQ 1.0002]") == 0);
  CHECK_FALSE(bracketed("[1 EQ 1.00001]").has_value());  // versions of LinuxCNC differ
  CHECK(bracketed("[1 NE 2]") == 1);
  CHECK(bracketed("[2 LE 2 + 1 GE 1]") == 1);
  const auto macro = ExpressionSyntax::macro;
  CHECK(bracketed("[[#1 EQ 2] AND [#2 LT 3]]", macro) == 1);
  CHECK(bracketed("[1 OR 0 AND 0]", macro) == 1);
  CHECK(bracketed("[#1 NE 2]", macro) == 0);
  for (const char* const text :
       {"[2 AND 4]", "[#1 EQ 2 AND #2 LT 3]", "[0.1 + 0.2 EQ 0.3]", "[0.1 + 0.2 GT 0.3]"})
    CHECK_FALSE(bracketed(text, macro).has_value());
  CHECK(evaluate_expression("[0.1 + 0.2 LE 0.3]", macro, nullptr).depends_on_rounding);
  CHECK_FALSE(bracketed("[1 GT 0]", ExpressionSyntax::brackets).has_value());
  CHECK(sinumerik("R1 == 2 AND NOT R1 <> 2") == 1);
  CHECK(sinumerik("R1 >= 3 OR (R1 < 3 AND _DEPTH <= -3)") == 1);
  CHECK(sinumerik("7 MOD R1") == 1);
  CHECK_FALSE(sinumerik("R1 AND 1").has_value());
  CHECK_FALSE(sinumerik("R1 ANDY 1").has_value());
}

TEST_CASE(
    "expressions that controls evaluate differently, or that the text does not determine, have no value") {
  for (const char* const text :
       {"#3", "[1 / 0]", "SQRT[-1]", "ASIN[2]", "#<other>", "FOO[1]", "[1 + ", "#[1.5]", "[1 2]2"})
    CHECK_FALSE(bracketed(text).has_value());
  for (const char* const text : {"FIX[-2.8]", "ROUND[-0.5]", "ATAN[-1]/[1]", "[-7 MOD 4]"})
    CHECK_FALSE(bracketed(text, ExpressionSyntax::macro).has_value());
  for (const char* const text : {"R2", "R1 +", "MINVAL(1,2)", "$P_EP[X]", "(1"})
    CHECK_FALSE(sinumerik(text).has_value());
}

TEST_CASE("constants and expressions of constants are known positions only with --evaluate") {
  CHECK(end_of("#1=5\nG1 X#1 Y[#1 * 2 + 1]\n") == Vector3(5, 11, 5));
  CHECK(end_of("#<depth>=-2.5 (down)\n#1=[#<depth> * 2]\nG1 Z#<depth> X#1\n") == Vector3(-5, 0, -2.5));
  CHECK(end_of("#1=5\n#1=[#1+1]\nG1 X#1\n") == Vector3(6, 0, 5));
  CHECK(end_of("#1=5\n#1=7 G1 X#1\n") == Vector3(5, 0, 5));                // set behind the block
  CHECK(end_of("#2=3\n#2=5 #3=#2 G1 X#2\nG1 Y#3\n") == Vector3(3, 3, 5));  // all values are read first
  CHECK(end_of("#100=5 (A)\nG1 X#100 Y-#100\n", "fanuc") == Vector3(5, -5, 5));
  CHECK(end_of("#101=1#102=2\nG1 X#102 Y#101\n", "fanuc") == Vector3(2, 1, 5));
  CHECK(end_of("R1=5 R2=R1*2\nG1 X=R2+1 Y=-R1\n", "siemens") == Vector3(11, -5, 5));
  CHECK(end_of("_TIEFE=-4\nG1 Z=_TIEFE\n", "siemens") == Vector3(0, 0, -4));
  CHECK(end_of("#1=90\nG[#1]\nG1 X#1\n") == Vector3(90, 0, 5));
  CHECK_FALSE(all_known(read(start + "#1=5\nG1 X#1\n").moves.back().known_end));
}

TEST_CASE("variables that the text does not determine are unknown") {
  CHECK_FALSE(last_is_known("G1 X#1\n"));
  CHECK_FALSE(last_is_known("#1=#5021\nG1 X#1\n"));
  CHECK_FALSE(last_is_known("#1=5\n/#1=6\nG1 X#1\n"));
  CHECK_FALSE(last_is_known("#1=5\no1 if [#2 GT 1]\n#1=6\no1 endif\nX0. Y0. Z5.\nX#1\n"));
  CHECK_FALSE(last_is_known("#1=5\no<part> call\nX0. Y0. Z5.\nX#1\n"));
  CHECK_FALSE(last_is_known("#[#2]=5\nG1 X#1\n"));
  CHECK_FALSE(last_is_known("#1=5\n#[#2]=6\nG1 X#1\n"));
  CHECK_FALSE(last_is_known("#100=5\nIF[#2EQ1]THEN#100=6\nG1 X#100\n", "fanuc"));
  CHECK_FALSE(last_is_known("#100=5\nM98 P1000\nG90 G1 X0. Y0. Z5.\nX#100\n", "fanuc"));
  CHECK_FALSE(last_is_known("#100=5\n#100=6#101=#100\nG1 X#101\n", "fanuc"));
  CHECK_FALSE(last_is_known("#5221=5\nG1 X#5221\n"));
  CHECK_FALSE(last_is_known("#1=[1/3]\nG91 G1 X#1\n"));
}

TEST_CASE("siemens: INT and BOOL variables take values as the control stores them") {
  CHECK(end_of("DEF INT CNT=7\nCNT=CNT/2\nR1=CNT*10\nG1 X=R1\n", "siemens").x() == 40);
  CHECK(end_of("def int aa=7.6, BB=2.4\nG1 X=AA Y=BB\n", "siemens") == Vector3(8, 2, 5));
  CHECK(end_of("DEF INT AA=-7.6\nG1 X=AA\n", "siemens").x() == -8);
  CHECK(end_of("DEF BOOL FLAG=5\nG1 X=FLAG*50\n", "siemens").x() == 50);
  CHECK(end_of("DEF BOOL FLAG=0\nFLAG=-0.5\nG1 X=FLAG*50\n", "siemens").x() == 50);
  CHECK(end_of("DEF REAL AA=7.5\nAA=AA/2\nG1 X=AA\n", "siemens").x() == 3.75);
  CHECK(end_of("R[1]=7.5\nG1 X=R1 Y=R[1]\n", "siemens") == Vector3(7.5, 7.5, 5));
  for (const std::string unclear :
       {"DEF INT AA=-2.5\nG1 X=AA\n", "DEF INT AA=0.1*25\nAA=AA+0.4999999\nG1 X=AA\n",
        "DEF INT AA=3E9\nG1 X=AA\n", "DEF CHAR AA=65\nG1 X=AA\n", "_GUD=2.5\nG1 X=_GUD\n"}) {
    CAPTURE(unclear);
    const Program program = evaluated("G71 G90 G17 G54 F100\nG0 X0 Y0 Z5\n" + unclear, "siemens");
    CHECK_FALSE(program.moves.back().known_end[0]);
  }
}

TEST_CASE("an evaluated word becomes a number if it changes, and stays as it is if it does not") {
  const Program program = evaluated(start + "#1=5\nG1 X#1 Y[#1 * 2]\nG2 X[2*#1] Y#1 I0 J-5\n");
  CHECK(moved(program).find("#1=5\nG1 X6. Y[#1 * 2]\n") != std::string::npos);
  const Program words = evaluated("G71 G90 G17 G54 F100\nG0 X0 Y0 Z5\nR1=5\nG1 X=R1*2 Y=R1\n", "siemens");
  CHECK(moved(words).find("R1=5\nG1 X=11. Y=R1\n") != std::string::npos);
  CHECK(program.evaluated == 4);
  CHECK(program.remarks.size() == 1);
}

TEST_CASE("ROUND in a word of a shop control, and variables under G66, are not evaluated") {
  for (const char* const dialect : {"fanuc", "haas"}) {
    CHECK(evaluated(start + "#1=10.3456\nG1 X[ROUND[#1]]\n", dialect).moves.back().fixed[0]);
    CHECK_FALSE(evaluated(start + "#1=10.3456\n#2=ROUND[#1]\nG1 X#2\n", dialect).moves.back().fixed[0]);
  }
  CHECK_FALSE(evaluated(start + "#1=10.3456\nG1 X[ROUND[#1]]\n").moves.back().fixed[0]);
  const std::string modal = start + "#100=10.\nG66 P9100 A1.\nG0 X0. Y0.\nG67\nG0 X0. Y0. Z0.\nG1 X#100\n";
  CHECK(evaluated(modal, "fanuc").moves.back().fixed[0]);
}
