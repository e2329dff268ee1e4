#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Program siemens(const std::string& text) {
  ReadOptions options;
  options.dialect = "siemens";
  options.unit = LengthUnit::millimetres;
  return read_program(text, "p.mpf", options);
}

std::string siemens_shifted(const std::string& text) {
  return shifted_text(siemens(text), {0.5, -0.25, 0.125});
}

constexpr std::string_view siemens_start = "G90 G17 G71\nT=\"MILL_10\" M6\nG0 X0 Y0 Z50. D1 S2500 M3\n";

}  // namespace

TEST_CASE(
    "siemens: words that only a Sinumerik reads decide the dialect, but not in comments of other dialects") {
  CHECK(read("N10 G90 G71\nN20 G2 X1. Y0. CR=4.\n").dialect == "siemens");
  CHECK(read("%_N_COVER_MPF\n;$PATH=/_N_MPF_DIR\nG71 G0 X1\n").dialect == "siemens");
  CHECK(read("G71\nMSG(\"ROUGH\")\nG0 X1\n").dialect == "siemens");
  CHECK(read("G71\nT=\"MILL10\"\nG0 X1\n").dialect == "siemens");
  CHECK(read("G71\nTRANS X10\nG0 X1\n").dialect == "siemens");
  CHECK(read("(CR=4. MCALL)\nG21 G0 X1\n").dialect == "linuxcnc");
  CHECK(read("O0001\nG21 G0 X1.\n(SUPA)\n").dialect == "fanuc");
}

TEST_CASE("siemens: centres marked as absolute are coordinates") {
  const std::string start = std::string(siemens_start) + "G1 Z0 F100\n";
  const std::string text =
      start + "G2 X10 Y0 I=AC(5) J=AC(0)\nG3 I=AC(5.) J=AC(0.)\nG3 X10 Y0 I=IC(-5) J=IC(0)\n";
  const Program program = siemens(text);
  for (const std::size_t m : {2u, 3u, 4u}) {
    REQUIRE(program.moves.at(m).arc);
    CHECK(program.moves[m].arc->centre_mm == Vector3(5, 0, 0));
    CHECK(program.moves[m].may_split);
  }
  CHECK(siemens_shifted(text).find("G2 X10.5 Y-0.25 I=AC(5.5) J=AC(-0.25)\n") != std::string::npos);
  // The pieces of a split circle have the same form.
  const MoveEdit halves{.move = 3,
                        .inserted = {{.end_mm = {0, 0, 0}, .centre_mm = Vector3(5, 0, 0)}},
                        .end_mm = {10, 0, 0},
                        .centre_mm = Vector3(5, 0, 0)};
  CHECK(rewrite(program, {halves}, {}).text.find("X0.000 I=AC(5.000) J=AC(0.000)") != std::string::npos);
  // If only one coordinate is absolute, the error has no hint.
  CHECK_FALSE(siemens(start + "G2 X10 Y0 I=AC(5) J0\n").moves.back().arc);
  CHECK_FALSE(siemens(start + "G2 X10 Y0 I=AC(5)\n").moves.back().arc);
}

TEST_CASE("siemens: unchanged lines are reproduced byte for byte") {
  const std::string text =
      "%_N_COVER_MPF\n;$PATH=/_N_MPF_DIR\nN10 G17 G90 G71 G500 ;start\nDEF REAL "
      "_DEPTH=5.5\nWORKPIECE(,\"\",,\"BOX\",112)\n"
      "N000020 T=\"MILL 10\" M6\nMSG(\"ROUGH; PART\")\nS=R3 M3=3 SPOS[2]=0 FFWON\nG0 SUPA Z500. D0\nG0 G153 "
      "X0 D0\nG54 G0 X10 Y10 D1\nZ=50.5\n"
      "R1=5 R2=R1*2\nG1 X=R1+5 Y=AC(12.5) Z=IC(-3) F=R9\nTRANS X10 Y5\nG1 X5\nTRANS\nCYCLE800()\nMCALL "
      "CYCLE81(50,0,2,-10)\nX1 Y1\nMCALL\n"
      "L100 P3\nPOCKET3(50,0,1)\nIF R1==5\nG1 X5\nELSE\nX6\nENDIF\nCOMPCAD\nCYCLE832(0.01,_ROUGH,1)\nG0 X1 "
      "Y1 Z1 A0.0\nCIP X5 Y5 I1=3 J1=3\nG3 X1 Y2 CR=5 TURN=2\n"
      "/G1 X4\n$P_UIFR[1]=CTRANS(X,5)\nSTOPRE\nM30\n%_N_OTHER_SPF\nanything";
  const Program program = siemens(text);
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (MoveEdit& edit : edits)
    if (const auto& arc = program.moves[edit.move].arc) edit.centre_mm = arc->centre_mm;
  CHECK(rewrite(program, edits, {}).text == text);
  CHECK(program.moves.size() > 8);
}

TEST_CASE("siemens: values behind '=' are read and changed in place") {
  const std::string text = std::string(siemens_start) + "G1 X=12.5 Y=AC(7) F500\nZ=-2.25\n";
  const Program program = siemens(text);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].end_mm == Vector3(12.5, 7, 50));
  CHECK(siemens_shifted(text) ==
        "G90 G17 G71\nT=\"MILL_10\" M6\nG0 X0.5 Y-0.25 Z50.125 D1 S2500 M3\n"
        "G1 X=13.0 Y=AC(6.75) F500\nZ=-2.125\n");
}

TEST_CASE("siemens: a block of incremental words is relative, in a mixed block each axis has its own mode") {
  const Program program =
      siemens(std::string(siemens_start) + "G1 X=IC(5) Y=IC(-1) F500\nX10 Y=IC(2)\nG91\nX=AC(3) Y=AC(4)\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].relative);
  CHECK(program.moves[1].end_mm.x() == 5);
  CHECK_FALSE(program.moves[1].may_insert_words);
  CHECK_FALSE(program.moves[2].relative);
  CHECK_FALSE(is_relative(program.moves[2], 0));
  CHECK(is_relative(program.moves[2], 1));
  CHECK(program.moves[2].end_mm == Vector3(10, 1, 50));
  CHECK_FALSE(program.moves[3].relative);
  CHECK(program.moves[3].end_mm.y() == 4);
  CHECK(program.moves[3].known_end[1]);
}

TEST_CASE("siemens: each axis of an arc has its own mode, too") {
  for (const std::string arc :
       {"G3 X10 Y2 CR=6", "G3 X10 Y=IC(2) CR=6", "G3 X=IC(10) Y2 CR=6", "G91 G3 X10 Y=AC(2) CR=6"}) {
    CAPTURE(arc);
    const Program program = siemens(std::string(siemens_start) + "F500\nG1 X0 Y0\n" + arc + "\n");
    CHECK(program.left_alone.empty());
    REQUIRE(program.moves.back().arc);
    CHECK(program.moves.back().end_mm == Vector3(10, 2, 50));
    CHECK(program.moves.back().arc->radius_mm == 6);
  }
}

TEST_CASE("siemens: the centre of an arc may be an expression") {
  ReadOptions options{.dialect = "siemens", .unit = LengthUnit::millimetres, .evaluate = true};
  const auto read_arc = [&](const std::string& arc) {
    return read_program(std::string(siemens_start) + "R1=5\nG1 X10 Y0 F500\n" + arc + "\nG1 X1\n", "p.mpf",
                        options);
  };
  for (const std::string arc :
       {"G3 X0 Y0 I-5 J0", "G3 X0 Y0 I=-R1 J0", "G3 X0 Y0 I=IC(-R1) J=0", "G3 X0 Y0 I=AC(R1) J=AC(0)"}) {
    CAPTURE(arc);
    const Program program = read_arc(arc);
    CHECK(program.left_alone.empty());
    REQUIRE(program.moves.at(2).arc);
    CHECK(program.moves[2].arc->centre_mm.x() == 5);
  }
  options.evaluate = false;
  const Program unknown = read_arc("G3 X0 Y0 I=-R1 J0");
  CHECK(unknown.left_alone.at(0).why ==
        "the centre, radius or number of turns of the arc is a variable or an expression (--evaluate works "
        "out constants)");
  CHECK(unknown.moves.back().known_start == std::array{true, true, true});
}

TEST_CASE("siemens: expressions of R parameters fix their axis") {
  const Program program = siemens(std::string(siemens_start) + "R1=5 R2=R1*2\nG1 X=R1+5 Y7 F500\n");
  REQUIRE(program.moves.size() == 2);
  CHECK(program.moves[1].fixed == std::array{true, false, false});
  CHECK(program.moves[1].words[1]);
}

TEST_CASE("siemens: CR= arcs move with their ends and keep their form in pieces") {
  const std::string text = std::string(siemens_start) + "G3 X10. Y10. CR=10. F200\n";
  const Program program = siemens(text);
  REQUIRE(program.moves.size() == 2);
  REQUIRE(program.moves[1].arc);
  CHECK((program.moves[1].arc->centre_mm - Vector3(0, 10, 50)).norm() < 1e-9);
  CHECK(siemens_shifted(text).ends_with("G3 X10.5 Y9.75 CR=10. F200\n"));
  const double s = 10 * std::sqrt(0.5);
  const MoveEdit halves{.move = 1,
                        .inserted = {{{s, 10 - s, 50}, Vector3(0, 10, 50)}},
                        .end_mm = {10, 10, 50},
                        .centre_mm = Vector3(0, 10, 50)};
  CHECK(rewrite(program, {halves}, {})
            .text.ends_with("G3 X7.071 Y2.929 CR=10.000 F200\nG3 X10. Y10. CR=10. F200\n"));
}

TEST_CASE("siemens: the words of pieces have blanks between them if one has '='") {
  const std::string start = "G90 G17 G71\nG0 X0Y0Z50 D1\n";
  const double s = 10 * std::sqrt(0.5);
  const MoveEdit halves{.move = 1,
                        .inserted = {{{s, 10 - s, 50}, Vector3(0, 10, 50)}},
                        .end_mm = {10, 10, 50},
                        .centre_mm = Vector3(0, 10, 50)};
  for (const auto& [block, piece] :
       {std::pair{"G3 X10.Y10. I=AC(0) J=AC(10) F200", "G3 X7.071 Y2.929 I=AC(0.000) J=AC(10.000) F200"},
        std::pair{"G3X10.Y10.CR=10.F200", "G3 X7.071 Y2.929 CR=10.000 F200"},
        std::pair{"G3X10.Y10.I0J10.F200", "G3X7.071Y2.929I0.000J10.000F200"}}) {
    const Program program = siemens(start + block + "\n");
    const std::string text = rewrite(program, {halves}, {}).text;
    CAPTURE(text);
    CHECK(text.find(piece + std::string("\n")) != std::string::npos);
    CHECK(siemens(text).moves.size() == 3);
  }
}

TEST_CASE("siemens: TURN is the number of additional full turns") {
  const Program program = siemens(std::string(siemens_start) + "G3 X0 Y0 Z-2 I10 J0 TURN=2 F200\n");
  REQUIRE(program.moves.back().arc);
  CHECK(program.moves.back().arc->turns == 2);
}

TEST_CASE("siemens: machine positions make their axes unknown") {
  for (const std::string line : {"G0 SUPA Z500. D0", "G0 G53 Z500", "G153 G0 Z500", "G74 Z1=0", "G75 Z0"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nG0 X5\n");
    REQUIRE(program.moves.size() == 2);
    CHECK_FALSE(program.moves[1].known_start[2]);
  }
  CHECK(siemens(std::string(siemens_start) + "supa G0 Z0\n").left_alone.at(0).why ==
        "SUPA moves to a position of the machine");
}

TEST_CASE("siemens: the remark on a path mode names its code, without words of other controls") {
  CHECK(siemens(std::string(siemens_start) + "G64\n").remarks.back().what ==
        "G64: the control may leave the path by any distance");
  CHECK(siemens(std::string(siemens_start) + "G641\n").remarks.back().what ==
        "G641: the control may leave the path by any distance");
}

TEST_CASE("siemens: frames, cycles and subprograms are not corrected, with their reasons") {
  const auto fixed_after = [](const std::string& lines) {
    const Program program = siemens(std::string(siemens_start) + lines);
    return program.moves.back().fixed[0] || program.moves.back().fixed[2];
  };
  CHECK(fixed_after("MIRROR X0\nG1 X5 Y5 F100\n"));
  CHECK_FALSE(fixed_after("MIRROR X0\nTRANS\nG1 X5 Y5 F100\n"));
  CHECK(fixed_after("MCALL MY_HOLE(50,0,2,-10)\nX5 Y5\n"));
  CHECK_FALSE(fixed_after("MCALL MY_HOLE(50,0,2,-10)\nMCALL\nX5 Y5\n"));
  CHECK(fixed_after("CYCLE800(1,\"TC1\",0,57,0,0,0,0,30)\nG1 X5 Y5 F100\n"));
  CHECK_FALSE(fixed_after("CYCLE800(1,\"TC1\",0,57,0,0,0,0,30)\nCYCLE800()\nG1 X5 Y5 F100\n"));
  CHECK(fixed_after("TRAORI\nG1 X5 A3=0 B3=0 C3=1 F100\n"));
  CHECK(fixed_after("L100 P2\n"));
  CHECK(fixed_after("MY_DRILL(5,6)\n"));
  CHECK(fixed_after("IF R1==1\nG1 X5 F100\nENDIF\n"));
  CHECK(fixed_after("AGAIN: G1 X5 F100\nIF R1<5 GOTOB AGAIN\n"));
  CHECK(fixed_after("CIP X5 Y5 I1=3 J1=3\n"));
  CHECK(fixed_after("G1 X5 B30 F100\n"));
  const auto why = [](const std::string& lines) {
    return siemens(std::string(siemens_start) + lines).left_alone.at(0).why;
  };
  CHECK(why("L100\n") == "a subprogram is called");
  CHECK(why("N10 SUB1\n") == "a subprogram is called");
  CHECK(why("G1 X5 FLIN F100\n") == "'FLIN' is not supported");
  CHECK(why("RNDM=2\n") == "'RNDM' is not supported");
  CHECK_FALSE(fixed_after("G1 X5 FNORM F100\n"));
  const Program own_feed = siemens(std::string(siemens_start) + "G1 X5 F100\nX20 FB=20\nX30\n");
  const std::size_t n = own_feed.moves.size();
  CHECK(own_feed.moves[n - 3].may_split);
  CHECK_FALSE(own_feed.moves[n - 2].may_split);  // FB= acts in this block alone
  CHECK(own_feed.moves[n - 1].may_split);
}

TEST_CASE("siemens: an arc behind a call is corrected when plane, motion and position are stated again") {
  const Program program =
      siemens(std::string(siemens_start) + "L100\nG0 G90 G17 X0 Y0 Z20\nG2 X10 Y10 I10 J0 F100\n");
  CHECK(program.left_alone.size() == 1);
  CHECK_FALSE(program.moves.back().fixed[0]);
  CHECK(program.moves.back().arc.has_value());
}

TEST_CASE("siemens: ANG= gives the coordinate of a line that has no word for it") {
  const std::string text = std::string(siemens_start) + "G1 X40 ANG=45 F100\nY0 ANG=90\nY-20 ANG=-135\n";
  const Program program = siemens(text);
  REQUIRE(program.moves.size() == 4);
  CHECK((program.moves[1].end_mm - Vector3(40, 40, 50)).norm() < 1e-9);
  CHECK((program.moves[2].end_mm - Vector3(40, 0, 50)).norm() < 1e-9);
  CHECK((program.moves[3].end_mm - Vector3(20, -20, 50)).norm() < 1e-9);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  // The direction stays if the whole line has the same shift; otherwise the coordinate is written.
  CHECK(siemens_shifted(text).ends_with("G1 X40.5 Y39.750 F100\nY-0.25 X40.500\nY-20.25 X20.500\n"));
  for (const std::string lines : {"G1 ANG=45 F100\n", "G1 X5 Y5 ANG=45 F100\n", "G1 X5 ANG=90 F100\n",
                                  "G1 X5 ANG=R1 F100\n", "G18\nG1 X5 ANG=30 F100\n"}) {
    CAPTURE(lines);
    const Program left = siemens(std::string(siemens_start) + lines);
    CHECK((left.moves.back().fixed[0] || left.moves.size() == 1));
    CHECK(!left.left_alone.empty());
  }
}

TEST_CASE("siemens: G60 is an exact stop and G64 ends it") {
  const Program program = siemens(std::string(siemens_start) + "G60 G1 X5 F100\nX6\nG64 X7\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[2].exact_stop);
  CHECK_FALSE(program.moves[3].exact_stop);
}

TEST_CASE(
    "siemens: another edge of the tool makes the height unknown, a tool change selects the first edge") {
  const Program program = siemens(std::string(siemens_start) + "G1 X5 D01 F100\nX6 D2\nX7\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].known_end[2]);
  CHECK_FALSE(program.moves[3].known_start[2]);
}

TEST_CASE("siemens: a motion that is not supported is named in the reason") {
  for (const char* block : {"CIP X50 Y20 I1=30 J1=18", "CT X50 Y20", "BSPLINE X50 Y20"}) {
    CAPTURE(block);
    const Program program = siemens(std::string(siemens_start) + "G1 X5 F100\n" + block + "\n");
    REQUIRE(!program.left_alone.empty());
    CHECK(program.left_alone.back().why.starts_with("its motion is not followed (CIP, CT or a spline)"));
  }
}

TEST_CASE("siemens: behind a D that is an expression Z is not known") {
  const auto knows_z = [](const std::string& edge) {
    const Program program = siemens(std::string(siemens_start) + "G1 X5 D1 F100\n" + edge + "\nX7\n");
    return program.moves.back().known_start[2];
  };
  CHECK(knows_z("D1"));
  CHECK_FALSE(knows_z("D=R1"));
  CHECK_FALSE(knows_z("D=EDGE+1"));
}

TEST_CASE("siemens: the header is written as comments below the lines that must be first") {
  const Program program = siemens("%_N_COVER_MPF\n;$PATH=/_N_MPF_DIR\nG71 G0 X1 SUPA\n");
  const std::string text = rewrite(program, {}, {.header = {"Counterflex 1 made"}}).text;
  CHECK(text == "%_N_COVER_MPF\n;$PATH=/_N_MPF_DIR\n;COUNTERFLEX 1 MADE\nG71 G0 X1 SUPA\n");
  CHECK(is_corrected(read(text)));
}

TEST_CASE("siemens: the header is written before the first move, also if later lines look like a beginning") {
  const std::string text = "L100\n%_N_COVER_MPF\nG71 G0 X1\n";
  const Program program = siemens(text);
  REQUIRE(!program.moves.empty());
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(rewrite(program, {}, {.header = {"Counterflex 1 made"}}).text == ";COUNTERFLEX 1 MADE\n" + text);
}

TEST_CASE("siemens: a name of one special character is not a letter of a word") {
  CHECK(siemens("G71 G90\nG1 X1 F1 $=5\n$\n_\n").dialect == "siemens");
}

TEST_CASE("siemens: RND=, CHR= and CHF= shorten the lines beside the corner") {
  const Program program =
      siemens(std::string(siemens_start) + "G1 Z0 F100\nX30 RND=4\nY30 CHR=5\nX0 CHF=4\nY15 RND=R1\nX10\n");
  const auto ends = [&](std::size_t m) {
    REQUIRE(program.moves.at(m).corners);
    return *program.moves[m].corners;
  };
  CHECK(ends(2).end_mm == doctest::Approx(4));
  CHECK(ends(3).begin_mm == doctest::Approx(4));
  CHECK(ends(3).end_mm == doctest::Approx(5));
  CHECK(ends(4).end_mm == doctest::Approx(4 / std::sqrt(2)));
  CHECK(changes_height_inside(program.moves[4]));
  CHECK(program.moves[2].takes_no_z);
  // A radius that is an expression may remove the whole line.
  CHECK_FALSE(changes_height_inside(program.moves[5]));
  CHECK_FALSE(program.moves[5].fixed[0]);
  CHECK(siemens(std::string(siemens_start) + "G1 X5 RNDM=2 F100\n").moves.back().fixed[0]);
}

TEST_CASE("siemens: a call with other words in its block is a move that is not followed") {
  const std::string text = "G71 G90 G1 X1 Y1 Z1 F100\nG1 X2 POCKETS\nX3\n";
  const Program program = siemens(text);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].fixed[0]);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}

TEST_CASE("siemens: text that is not a program is refused with its position") {
  CHECK(diagnostic_of([] { siemens("G71\nG0 X\n"); }) == "p.mpf:2:4: error: X has no number");
  CHECK(diagnostic_of([] { siemens("G71\nG0 X1e5\n"); }).starts_with("p.mpf:2:6: error: X1e5"));
  CHECK(diagnostic_of([] { siemens("G71\n<<<<<<< mine\n"); }).starts_with("p.mpf:2:1: error: '<<<<<<<'"));
  CHECK(diagnostic_of([] { siemens("G71\nG291\n"); }).starts_with("p.mpf:2:1: error: G291"));
  CHECK(diagnostic_of([] { siemens("G71\nG0 X0 Y0\nG2 X20 Y0 R10\n"); }) ==
        "p.mpf:3:11: error: R10 is an R parameter without a value: the radius of an arc is CR=, and the "
        "parameter is set by R10=");
  CHECK(diagnostic_of([] { siemens("G71\nG0 SUPA\n"); }) == "p.mpf:2:4: error: SUPA has no axis word");
  CHECK(diagnostic_of([] { siemens("G71\nG0 G153\n"); }) == "p.mpf:2:4: error: G153 has no axis word");
  CHECK(diagnostic_of([] { siemens("G71\nG0 X=\n"); }).starts_with("p.mpf:2:5: error: X= has no value"));
}

TEST_CASE(
    "siemens: a block with an unknown assignment and words is not followed, and the position after it is "
    "unknown") {
  for (const char* const line : {"MEAS=1 G1 X20", "G1 X20 MEAW=-1", "_VAR=5 G1 X20 Y50", "$AC_TIMER[1]=0 X20",
                                 "LIMIT[2]=4 X=R1", "_A=R1 + 5 X20"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nY50\n");
    REQUIRE(program.moves.size() == 3);
    CHECK(program.moves[1].fixed == std::array{true, true, true});
    CHECK(program.moves[2].fixed[1]);
    REQUIRE(!program.left_alone.empty());
    CHECK(program.left_alone.front().why.find("part of the block that is not supported") !=
          std::string::npos);
  }
}

TEST_CASE("siemens: an assignment alone to a name that is not a variable may move any axis") {
  for (const char* const line :
       {"AX[X]=15", "N10 AX[X]=15", "POSP[X]=(5,1,1)", "OS[X]=1", "MOVT=5", "POLY PO[X]=(15,1,2)",
        "PO[X]=(15,1,2) PO[Y]=(5,2)", "CPLON[Y]=X CPLNUM[Y,X]=2", "CPON=X", "DIAMONA[X]", "DIAM90A[X]",
        "DIAMCHANA[X]", "DIACYCOFA[X]", "USER_DATA=5", "_A=5 MOVT=5"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nY50\n");
    REQUIRE(program.moves.size() == 3);
    CHECK(program.moves[1].fixed == std::array{true, true, true});
    CHECK(program.moves[2].fixed[1]);
    CHECK_FALSE(program.left_alone.empty());
  }
}

TEST_CASE("siemens: an assignment alone to a variable moves no axis") {
  for (const char* const line :
       {"_DEPTH=5", "R1=5 R[2]=R1", "H1=3", "S1=300 M1=3", "LIMS=2000", "FINEA[X]",
        "DEF REAL DEPTH=3,WIDTH[2]\nDEPTH=2 width[1]=5",
        "PROC PART(REAL DEPTH,VAR INT COUNT)\nDEPTH=2 COUNT=1", "$AC_TIMER[1]=0",
        "DEF STRING[20] NAME\nNAME=\"X\"", "PROC PART(STRING [20] TEXT,VAR REAL WIDTH)\nTEXT=\"A\" WIDTH=2",
        "SPOS[1]=90", "TRANS\n_GUD[1,2]=5"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nG1 X5 F100\n");
    REQUIRE(program.moves.size() == 2);
    CHECK(program.moves[1].may_split);
    CHECK(program.left_alone.empty());
  }
  ReadOptions options{.dialect = "siemens", .unit = LengthUnit::millimetres};
  options.harmless_calls = {"USER_DATA"};
  const Program stated =
      read_program(std::string(siemens_start) + "USER_DATA=5\nG1 X5 F100\n", "p.mpf", options);
  CHECK(stated.moves.back().may_split);
}

TEST_CASE("siemens: behind a change of the tool offset the position is not known") {
  for (const char* const line : {"TOFF[Z]=1", "TOFFL=1", "TOFFLR=1", "TCARR=1", "DL=1"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nG1 X5 F100\nX6 Y0 Z3\nX7\n");
    REQUIRE(program.moves.size() == 4);
    CHECK_FALSE(program.moves[1].known_end[2]);
    CHECK(program.moves[3].may_split);
  }
}

TEST_CASE("siemens: words behind a value that moves no axis are read") {
  for (const char* const line :
       {"CTOL=0.01 G1 X20 F100", "FL[X]=1000 G1 X20 F100", "OVRA[X]=50 G1 X20 F100", "FRC=100 G1 X20 F100",
        "R5=R1 + 5 G1 X20 F100", "R5=2 R6=R5*3 G1 X20 F100"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\n");
    REQUIRE(program.moves.size() == 2);
    CHECK(program.moves[1].end_mm.x() == 20);
    CHECK(program.left_alone.empty());
  }
}

TEST_CASE("siemens: a word directly behind a number or a bracket is read") {
  const std::string arc = std::string(siemens_start) + "G1 X20 F100\n";
  for (const char* const line :
       {"G3 X40 Y0 CR=10F600", "G3 X=40Y=0CR=10.F600", "G3 X=AC(40)Y0 I=AC(30)J=AC(0)F600",
        "G3 X40 Y=IC(0)I10 J=IC(0)F=600", "G3 X40 Y0 CR=10TURN=0F600"}) {
    CAPTURE(line);
    const Program program = siemens(arc + line + "\nG1 X50\n");
    REQUIRE(program.moves.size() == 4);
    REQUIRE(program.moves[2].arc);
    CHECK((program.moves[2].arc->centre_mm - Vector3(30, 0, 50)).norm() < 1e-9);
    CHECK(program.moves[2].end_mm == Vector3(40, 0, 50));
    CHECK(program.moves[3].feed_mm_min == 600);
  }
  for (const char* const line :
       {"ADIS=0.5G1 X20 F600", "R5=2G1 X20 F600", "SPOS=0G1 X20 F600", "MSG(\"A\")G1 X20 F600",
        "FL[X]=1000G1 X20 F600", "R5=2R6=R5 DIV 3 G1 X20 F600", "R5=SIN(30)G1 X20 F600",
        "R5=R6DIV2 G1 X20 F600", "R5=1.5EX-3 R6=1EX3 G1 X20 F600", "S=R[1]G1 X20 F600"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\n");
    REQUIRE(program.moves.size() == 2);
    CHECK(program.moves[1].end_mm.x() == 20);
    CHECK(program.moves[1].feed_mm_min == 600);
    CHECK(program.left_alone.empty());
  }
  CHECK(siemens("T=5M6\nG0 X0 Y0 Z0\n").moves.at(0).tool == 5);
}

TEST_CASE("siemens: a word directly behind an expression is refused") {
  struct Line {
    std::string value, word;
  };
  for (const auto& line : {Line{"G3 X40 Y0 CR=|R1", "F600"}, Line{"G1 X=|R1+5", "Y20"}, Line{"R5=|R1", "M6"},
                           Line{"S=|1EX3", "M3"}}) {
    const std::size_t bar = line.value.find('|');
    const std::string before = line.value.substr(0, bar), value = line.value.substr(bar + 1);
    CAPTURE(value);
    const std::string text = std::string(siemens_start) + before + value + line.word + "\n";
    CHECK(diagnostic_of([&] { siemens(text); }) ==
          "p.mpf:4:" + std::to_string(line.value.size()) + ": error: '" + line.word +
              "' is directly behind '" + value +
              "': only behind a plain number or a bracket does a word need no blank; write a blank before '" +
              line.word + "'");
  }
}

TEST_CASE("siemens: assignments alone do not move, and an axis with a number is not followed") {
  for (const char* const line : {"_VAR=5", "_A=5 _B=R1 * (2 + R3) M8", "_S=\"X20 G1\"", "R1=SIN(30) DIV 2"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nG1 X5 F100\n");
    CHECK(program.moves.size() == 2);
    CHECK(program.moves.back().known_end == std::array{true, true, true});
  }
  CHECK(siemens(std::string(siemens_start) + "G1 X1=20 F100\n").moves.back().fixed[0]);
}

namespace {

/// Why the last move is not followed; empty if it is.
std::string why_last(const std::string& lines) {
  const Program program = siemens(std::string(siemens_start) + lines);
  const Move& last = program.moves.back();
  if (!last.fixed[0] && !last.fixed[1] && !last.fixed[2]) return {};
  return program.left_alone.empty() ? "?" : program.left_alone.back().why;
}

}  // namespace

TEST_CASE("siemens: a block that may not run ends no frame, transformation or modal call") {
  const std::string frame = "a frame shifts or turns coordinates", move = "G0 X5 Y5 Z5\n";
  const auto in_condition = [](const std::string& line) { return "IF R1==1\n" + line + "\nENDIF\n"; };
  for (const std::string end : {"TRANS", "ROT", "SCALE", "MIRROR"}) {
    CAPTURE(end);
    CHECK(why_last("TRANS Y500\n/" + end + "\n" + move) == frame);
    CHECK(why_last("TRANS Y500\n" + in_condition(end) + move) == frame);
    CHECK(why_last("SCALE X3\n/" + end + "\n" + move) == frame);
    // Nothing has begun that the block may end.
    CHECK(why_last("/" + end + "\n" + in_condition(end) + move).empty());
    CHECK(why_last("TRANS Y500\n/" + end + "\n" + end + "\n" + move).empty());
  }
  CHECK(why_last("TRAORI\n/TRAFOOF\n" + move) == "tool centre point control is active");
  CHECK(why_last("TRAORI\n" + in_condition("TRAFOOF") + move) == "tool centre point control is active");
  CHECK(why_last("CYCLE800(1,\"T\",0,57,0,0,0,0,30)\n/CYCLE800()\n" + move) == "coordinates are tilted");
  const std::string macro = "every move calls a macro; its heights are not corrected", hole = "X5 Y5\n";
  CHECK(why_last("MCALL CYCLE81(50,0,2,-20)\n/MCALL\n" + hole) == macro);
  CHECK(why_last("MCALL CYCLE81(50,0,2,-20)\n" + in_condition("MCALL") + hole) == macro);
  CHECK(why_last("MCALL MY_HOLE(1)\n" + in_condition("MCALL") + hole) == macro);
  CHECK(why_last("MCALL CYCLE81(50,0,2,-20)\n" + in_condition("MCALL") + "MCALL\n" + move).empty());
}

TEST_CASE("siemens: a condition that begins and ends a frame or a modal call leaves it as it was") {
  const std::string move = "G0 X5 Y5 Z5\n";
  CHECK(why_last("LOOP\nTRANS X5\nG1 X1\nTRANS\nENDLOOP\n" + move).empty());
  CHECK(why_last("LOOP\nMCALL CYCLE81(50,0,2,-20)\nX1\nMCALL\nENDLOOP\n" + move).empty());
  CHECK_FALSE(why_last("IF R1==1\nTRANS X5\nELSE\nTRANS\nENDIF\n" + move).empty());
  CHECK_FALSE(why_last("TRANS Y500\nLOOP\nTRANS X5\nG1 X1\nTRANS\nENDLOOP\n" + move).empty());
}

TEST_CASE("siemens: TRANS, ROT, SCALE and MIRROR alone end all frames") {
  for (const std::string end : {"TRANS", "ROT", "SCALE", "MIRROR"}) {
    CAPTURE(end);
    for (const std::string begin : {"TRANS Y500\n", "TRANS Y500\nSCALE X2\n", "TRANS Y500\nL100\nG90 G0\n"}) {
      const Program program = siemens(std::string(siemens_start) + "G54\n" + begin + end + "\nG0 X5 Y5 Z5\n");
      CHECK(program.frames.at(program.moves.back().frame).origin_mm == Vector3(0, 0, 0));
    }
  }
}

TEST_CASE("siemens: jumps and repeated parts in lower case make the program a body") {
  const std::string tail = "TRANS Y500\naa: G0 X5 Y5 Z5\n";
  for (const std::string jump : {"gotof aa\n", "GotoF aa\n", "if R1==1 gotof aa\n", "case R2 of 1 gotof aa\n",
                                 "MSG(\"A(;B\") gotof aa\n"}) {
    CAPTURE(jump);
    CHECK(why_last(jump + tail).starts_with("the program jumps"));
  }
  CHECK(why_last("aa: G0 X5 Y5 Z5\nbb: G0 Z50\nrepeat aa bb P=2\n").starts_with("the program jumps"));
  CHECK(why_last("MSG(\"gotof aa\")\n; gotof aa\nG0 X5 Y5 Z5\n").empty());
  CHECK(why_last("repeat\nX1\nuntil R1==1\nG0 X5 Y5 Z5\n").empty());
}

TEST_CASE("siemens: the program continues behind a RET that may not run") {
  for (const std::string end : {"/RET\n", "IF R1==1\nRET\nENDIF\n", "/M17\n", "IF R1==1\nM17\nENDIF\n"}) {
    CAPTURE(end);
    const Program program = siemens(std::string(siemens_start) + end + "G0 X5 Y5 Z5\nRET\nG0 X9\n");
    CHECK(program.moves.back().end_mm == Vector3(5, 5, 5));
  }
}

TEST_CASE(
    "siemens: coordinates that a variable of the control sets stay unknown until a statement sets them") {
  const std::string set = "a variable or a measuring cycle has set the coordinates", move = "G0 X5 Y5 Z5\n";
  CHECK(why_last("$P_UIFR[1,Y,TR]=500\nG54\n" + move) == set);
  CHECK(why_last("/$P_UIFR[ 1 ]=CTRANS(Y,500)\nG54\n" + move) == set);
  CHECK(why_last("$P_UIFR[R1,Y,TR]=500\nG55\n" + move) == set);
  CHECK(why_last("$P_UIFR[1,Y,TR]=500\nG55\n" + move).empty());
  CHECK(why_last("$P_UIFR[5,Y,TR]=500\nG505\n" + move) == set);
  CHECK(why_last("$P_UIFR[5,Y,TR]=500\nG54\n" + move).empty());
  const std::string frame = "a frame shifts or turns coordinates";
  CHECK(why_last("$P_PFRAME=CTRANS(Y,500)\nG54\n" + move) == frame);
  CHECK(why_last("$P_PFRAME=CTRANS(Y,500)\n/TRANS\n" + move) == frame);
  CHECK(why_last("$P_PFRAME[Y,TR]=500\nTRANS\n" + move).empty());
  for (const std::string variable :
       {"$P_BFRAME", "$P_CHBFR[0]", "$P_NCBFR[0,X,TR]", "$P_TOOLFRAME", "$AA_OFF[Z]"}) {
    CAPTURE(variable);
    CHECK(why_last(variable + "=5\nTRANS\nG54\n" + move) == set);
  }
  CHECK(why_last("$P_IFRAME=CTRANS(Y,500)\n" + move).starts_with("its work offset is unknown"));
  CHECK(why_last("$P_IFRAME=CTRANS(Y,500)\nG54\n" + move).empty());
}

TEST_CASE("siemens: a measuring cycle may write the work offset; names like those of cycles are calls") {
  const std::string move = "G0 X5 Y5 Z5\n";
  for (const char* cycle : {"CYCLE977(1,0,1,1)", "cycle978(1)", "CYCLE996(101)"}) {
    CAPTURE(cycle);
    CHECK(why_last(std::string(cycle) + "\nG54\n" + move) ==
          "a variable or a measuring cycle has set the coordinates");
  }
  CHECK(why_last("CYCLE971(1,0)\nG54\n" + move).empty());
  const auto why = [](const std::string& line) {
    return siemens(std::string(siemens_start) + line + "\n").left_alone.at(0).why;
  };
  CHECK(why("HOLES_TOP(5)") == "a subprogram is called");
  CHECK(why("CYCLE_CLEAN") == "a subprogram is called");
  CHECK(why("CYCLE63(5)").starts_with("this cycle of the control is not supported"));
}

TEST_CASE("siemens: statements without an effect on coordinates are read") {
  for (const std::string line : {"$AC_TIMER[1]=0", "$A_OUT[3]=1", "R[1]=150", "r[R2]=R3+1 R5=2", "G26 S3000",
                                 "G25 X0 Y0 Z0", "CPRECON", "WAITM(1,1,2)", "SETAL(65000)", "STARTFIFO"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\nG1 X5 F100\n");
    REQUIRE(program.moves.size() == 2);
    CHECK(program.moves[1].end_mm == Vector3(5, 0, 50));
    CHECK(program.moves[1].spindle_rpm == 2500);
    CHECK(program.left_alone.empty());
  }
  CHECK(diagnostic_of([] { siemens("G71\nR[1]\n"); }).starts_with("p.mpf:2:1: error"));
}

TEST_CASE("siemens: a state that one path through a condition leaves is unknown behind it") {
  const std::string move = "G0 X5 Y5 Z5\n", distance = "G90 or G91 is unknown";
  CHECK(why_last("IF R1==1\nG91\nIF R2==1\nG90\nENDIF\nENDIF\n" + move).starts_with(distance));
  CHECK(why_last("IF R1==1\nG91\nELSE\nG90\nENDIF\n" + move).starts_with(distance));
  CHECK(why_last("IF R1==1\nG91\nG90\nELSE\nG90\nENDIF\n" + move).empty());
  const Program program =
      siemens(std::string(siemens_start) + "T1 M6\nIF R1==1\nT2 M6\nELSE\nT1 M6\nENDIF\nG0 X5 Y5 Z5\n");
  CHECK(program.moves.back().tool == 0);
  CHECK(why_last("IF R1==1\nG58 X5\nELSE\nX1\nENDIF\n" + move).starts_with("G58 or G59 shifts"));
}

TEST_CASE("siemens: axis words beside a statement that needs its own block make the position unknown") {
  const std::string start = std::string(siemens_start) + "G1 Z-2 F100\n";
  for (const char* line :
       {"X10 Y60 CYCLE81(10,0,2,-5)", "X10 Y60 MCALL CYCLE81(10,0,2,-5)", "X20 Y7 MCALL",
        "CYCLE832(0.01,1,1) X20 Y60", "TRAFOOF X20 Y7", "X20 Y7 TRAFOOF", "X5 TRANS Y10", "X20 Y7 ROT",
        "X20 Y7 CYCLE800()", "X20 Y7 TRAORI", "X20 POCKET3(50,0,2,-10,60,20,5,50,40,0,4,0.1,0.1,500,200)"}) {
    CAPTURE(line);
    const Program program = siemens(start + line + "\nX30\n");
    REQUIRE(program.moves.size() == 4);
    CHECK(program.moves[2].fixed == std::array{true, true, true});
    CHECK_FALSE(all_known(program.moves[3].known_end));
  }
  // A modal call may act from here on, and a frame may be active.
  for (const char* line : {"X10 Y60 MCALL CYCLE81(10,0,2,-5)", "X5 TRANS Y10"})
    CHECK(siemens(start + line + "\nG90 G17 G71 G1 X0 Y0 Z0 F100\nX30\n").moves.back().fixed[0]);
  CHECK(diagnostic_of([&] { siemens(start + "G4 F1 X20 Y7\n"); }) ==
        "p.mpf:5:1: error: axis words are not allowed in a block with a dwell");
}

TEST_CASE("siemens: words beside a path mode or CYCLE832 are followed") {
  for (const char* line :
       {"COMPCAD X20 Y7", "COMPCAD G1 X20 Y7", "X20 Y7 COMPCAD", "X20 Y7 CYCLE832(0.01,1,1)"}) {
    CAPTURE(line);
    const Program program = siemens(std::string(siemens_start) + line + "\n");
    CHECK(program.moves.back().end_mm == Vector3(20, 7, 50));
    CHECK(all_known(program.moves.back().known_end));
    CHECK(program.remarks.back().what.find("smooths the path") != std::string::npos);
  }
}

TEST_CASE("siemens: the first difference of an axis behind a change of the frame has an unknown end") {
  const auto last = [](const std::string& lines) {
    return siemens(std::string(siemens_start) + "G54 X0 Y0 Z50\n" + lines);
  };
  const Program program = last("TRANS Y100\nG91 X40 Y5\nX20\n");
  const Move& first = program.moves[program.moves.size() - 2];
  CHECK(first.fixed == std::array{false, true, false});
  CHECK(program.moves.back().known_end == std::array{true, false, true});
  CHECK(program.left_alone.back().why.find("SD42440") != std::string::npos);
  for (const std::string lines : {"TRANS Y100\nG91 X40\n", "TRANS Y100\nY5\nG91 Y5\n",
                                  "TRANS Y100\nTRANS\nG91 Y5\n", "TRANS Y100\nX5 Y=AC(5)\nY=IC(5)\n"}) {
    CAPTURE(lines);
    CHECK(all_known(last(lines).moves.back().known_end));
  }
  for (const char* lines :
       {"TRANS Y100\nY=IC(5)\n", "TRANS Z1\nG91\nZ5\n", "TRANS X5\nATRANS Y5\nG91 X5\n",
        "ROT RPL=90\nG91 X5\n", "TRANS X5\nX=IC(5) Y2\n", "ATRANS X5\nG1 G91 X1 F100\n"}) {
    CAPTURE(lines);
    CHECK_FALSE(all_known(last(lines).moves.back().known_end));
  }
}

TEST_CASE("siemens: CYCLE800 without a swivel moves nothing, and with zeros may retract") {
  const std::string start = std::string(siemens_start) + "G1 Z-2 F100\n", move = "X5\n";
  const auto last = [&](const std::string& lines) { return siemens(start + lines + move).moves.back(); };
  CHECK(all_known(last("CYCLE800()\n").known_end));
  CHECK(all_known(last("CYCLE800() ; off\n").known_end));
  CHECK_FALSE(all_known(last("TRANS X5\nCYCLE800()\n").known_end));
  CHECK_FALSE(all_known(last("CYCLE800(1,\"T\",0,57,0,0,0,0,30)\nCYCLE800()\n").known_end));
  const std::string zero = "CYCLE800(1,\"TC, 1\",0,57,0,0,0,0,0,0,0,0,0,-1)\n";
  CHECK(siemens(start + zero).left_alone.back().machine_position);
  CHECK_FALSE(all_known(last(zero).known_end));
  const std::string position = "G0 X0 Y0 Z15\n";
  CHECK(all_known(last(zero + position).known_end));
  CHECK(all_known(last("CYCLE800(1,\"T\",0,57,0,0,0,0,30)\n" + zero + position).known_end));
  for (const std::string tilt :
       {"CYCLE800(1,\"T\",0,57,0,0,0,0,0,30)\n", "CYCLE800(1,\"T\",1,57,0,0,0,0,0,0)\n",
        "CYCLE800(1,\"T\",0,57,0,0,0,0,0,0,5)\n", "CYCLE800(1,\"T\",0,57,0,0,0,R1)\n", "CYCLE800(1)\n"}) {
    CAPTURE(tilt);
    CHECK(last(tilt + position).fixed[0]);
  }
}

TEST_CASE("siemens: words that only switch off or smooth move nothing") {
  for (const std::string word : {"DIAMOF", "TOROTOF", "PAROTOF", "CDOF", "CDON", "OSOF", "OSC", "G621"}) {
    CAPTURE(word);
    const Program program = siemens(std::string(siemens_start) + word + "\nG1 X5 F100\n");
    CHECK(all_known(program.moves.back().known_end));
    CHECK(program.left_alone.empty());
  }
  for (const std::string word : {"DIAMON", "TOROT", "PAROT", "CUT3DCC"})
    CHECK(siemens(std::string(siemens_start) + word + "\nG1 X5 F100\n").moves.back().fixed[0]);
}

TEST_CASE("siemens: G and M codes behind TRAFOOF and CYCLE832 act, and move nothing") {
  const std::string start(siemens_start);
  for (const std::string line :
       {"TRAFOOF G40", "TRAFOOF M8", "CYCLE832(0.01,1,1) G64", "CYCLE832() G64 ; OFF"}) {
    CAPTURE(line);
    CHECK(all_known(siemens(start + line + "\nX5\n").moves.back().known_end));
  }
  CHECK(siemens(start + "TRAFOOF G91\nX5\nX5\n").moves.back().end_mm.x() == 10);
  for (const std::string line : {"TRAFOOF G1 X5", "TRAFOOF L6", "TRAFOOF TRANS X5", "TRAFOOF M=QU(5) X1",
                                 "CYCLE832(0.01,1,1) G0Z5", "CYCLE832(0.01,1,1) POCKET"}) {
    CAPTURE(line);
    CHECK_FALSE(all_known(siemens(start + line + "\nX5\n").moves.back().known_end));
  }
}

TEST_CASE("siemens: RET behind axis words ends the program") {
  const Program program = siemens(std::string(siemens_start) + "X5 RET\nX6\nX7\n");
  CHECK(program.moves.back().fixed[0]);
  CHECK(program.block_count == siemens(std::string(siemens_start) + "X5 RET\n").block_count);
}

TEST_CASE("siemens: a label that begins with REPEAT repeats nothing, and ANG=90 keeps its axis") {
  const std::string start(siemens_start);
  CHECK(all_known(siemens(start + "REPEAT_LAB: G1 X5 F100\n").moves.back().known_end));
  CHECK_FALSE(all_known(siemens(start + "AA: G1 X5 F100\nREPEAT AA\n").moves.back().known_end));
  CHECK_FALSE(all_known(siemens(start + "AA: G1 X5 F100\nREPEATB AA\n").moves.back().known_end));
  for (const std::string repeat : {"N80REPEAT AA BB P3", ":80REPEATB AA", "END_REPEAT: REPEAT AA BB P=3"}) {
    CAPTURE(repeat);
    CHECK_FALSE(
        all_known(siemens(start + "AA: G91 G1 X5 F100\nBB:\n" + repeat + "\n").moves.back().known_end));
  }
  CHECK(siemens(start + "G1 X0 Y0 F100\nANG=90 Y20\n").moves.back().end_mm.x() == 0);
}
