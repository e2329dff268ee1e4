#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string dialect_of(const std::string& text) {
  return read(text).dialect;
}

std::string with_header(const std::string& text) {
  const Program program = read(text);
  return rewrite(program, edits_to_original(program), {.header = {"COUNTERFLEX 1"}}).text;
}

}  // namespace

TEST_CASE("a program number indicates a shop control in all spellings") {
  for (const char* number :
       {"O1001\n", "%\nO1001(PART)\n", "%O1001\n", ":1001\n", "%\n:0001 (PART)\n", "O0001 G21 G90\n",
        "N1 O1001\n", "%;\nO0007 (PART);\n", "(PART)\no7\n", "%\n<PART-1>(NAMED)\n", "%\nO<PART 1>\n"}) {
    CAPTURE(number);
    CHECK(dialect_of(std::string(number) + "G21 G90\nG0 X1. Y2. Z3.\n") == "fanuc");
  }
  CHECK(dialect_of("o100 sub\no100 endsub\nG21 G0 X1\n") == "linuxcnc");
}

TEST_CASE("codes that only one control has indicate that control") {
  const std::string begin = "%\nO1001\nG21 G90\n", end = "G0 X1. Y2. Z3.\nM30\n%\n";
  CHECK(dialect_of(begin + "G110\n" + end) == "haas");
  CHECK(dialect_of(begin + "(G110)\n" + end) == "fanuc");
  CHECK(dialect_of("G00G21G17G90G40\nN2G71G91.1\n" + end) == "mach3");
  CHECK(dialect_of("O1001 ; the plate\nG21 G90\nG1 F100 ; start here\n" + end) == "mach3");
  CHECK(dialect_of("O1001 ;\nG21 G90 ; (START)\n" + end) == "fanuc");
  CHECK(dialect_of("(Post Processor: grbl_post)\nG21 G90\n" + end) == "grbl");
  CHECK(dialect_of("%\nN1 G21 G90\n:2 T1 M6\n" + end) == "fanuc");
  CHECK(dialect_of("G21 G90 (G71)\n#<g71>=1 ; G71\n" + end) == "linuxcnc");
}

TEST_CASE("a name behind '%' indicates a shop control, with MPF or SPF a Sinumerik") {
  const std::string moves = "N10 G21 G90 G00 X1. Y2. Z3.\nM30\n";
  CHECK(dialect_of("(SAMPLE)\n\n%123\n" + moves) == "fanuc");
  CHECK(dialect_of("(A (B) C)\n%123\n" + moves) == "fanuc");
  CHECK(dialect_of("%PM (PART)\n" + moves) == "fanuc");
  CHECK(dialect_of("%MPF 90\nN10 G71 G90 G0 X1 Y2 Z3\nM30\n") == "siemens");
  CHECK(read_program("(SAMPLE)\n\n%123\n" + moves, "p.nc", {.unit = LengthUnit::millimetres}).moves.size() ==
        1);
}

TEST_CASE("nested and unclosed comments are read in dialects other than LinuxCNC") {
  const std::string text = "G21 G90 (tool (flat) 6 mm)\nG0 X1 Y2 Z3 (start\nG1 X5 F100\n";
  CHECK(dialect_of(text) == "mach3");
  CHECK(read(text).moves.size() == 2);
  const std::string shop = "O1 (A (B) X5.)\nG21 G90 (OPEN\nG0 X1. Y2. Z3. (BALL (R2))\n";
  CHECK(read(shop).moves.size() == 1);
  CHECK(read(shop).moves[0].end_mm.x() == 1);
}

TEST_CASE("a comment behind the searched beginning is not a sign of a control") {
  std::string text = "G21 G90\nG0 X1 Y2 Z3\n";
  while (text.size() < 2 << 20) text += "(a remark that is a little longer than most, and repeated often)\n";
  CHECK(dialect_of(text) == "linuxcnc");
  text.insert(text.find("G0"), "(open\n");
  CHECK(dialect_of(text) == "mach3");
}

TEST_CASE("the header follows the UTF-8 byte order mark and the program number") {
  const std::string moves = "G21 G90\nG0 X1. Y2. Z3.\n", header = "(COUNTERFLEX 1)\n";
  for (const char* begin : {"\xef\xbb\xbf", "%O1001\n", ":1001\n", "%\nO0001 G54\n", "%PART\nO1\n",
                            "\xef\xbb\xbf(PART)\n", "%\n<PART-1>\n"}) {
    CAPTURE(begin);
    CHECK(with_header(begin + moves) == begin + header + moves);
  }
}

TEST_CASE("control characters at both ends of a line are ignored") {
  const std::string nul(3, '\0');
  for (const std::string& text :
       {nul + "%\nO1\nG21 G90\nG0 X1. Y2. Z3.\nM30\n%\n\x1a" + nul,
        std::string("\x11%\n\r\rO1\n\r\rG21 G90\n\r\rG0 X1. Y2. Z3.\n\r\r%\x13"),
        std::string("\fG21 G90\n\f\nG0 X1. Y2. Z3.\f\n"), "\xef\xbb\xbfG21 G90\r\nG0 X1 Y2 Z3\r\n" + nul}) {
    const Program program = read(text);
    REQUIRE(program.moves.size() == 1);
    CHECK(program.moves[0].end_mm == Vector3(1, 2, 3));
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  }
}

TEST_CASE("additional words of a spindle, of G49 and of G43 are not errors") {
  CHECK(read("G21 G90 G49 H0\nM3 P100\nG43 H1 D1\nG0 X1 Y2 Z3\n").moves.size() == 1);
}

TEST_CASE(
    "a UTF-8 byte order mark belongs to no block: the first block is edited, refused and numbered as without "
    "it") {
  const std::string mark = "\xef\xbb\xbf", moving = "G0 X1. Y2. Z3.\nM30\n";
  ReadOptions options;
  options.unit = LengthUnit::millimetres;
  const Program program = read_program(mark + moving, "p.ngc", options);
  CHECK(rewrite(program, edits_to_original(program), {}).text == mark + moving);
  CHECK(rewrite(program, shifted(program, {1, 0, 0}), {.header = {"COUNTERFLEX 1"}}).text ==
        mark + "(COUNTERFLEX 1)\nG0 X2. Y2. Z3.\nM30\n");
  CHECK(diagnostic_of([&] { read(mark + "_X1\n", "linuxcnc"); }) ==
        diagnostic_of([&] { read("_X1\n", "linuxcnc"); }));
  const std::string numbered = "O1\nG21 G90\nG0 X1. Y1. Z1.\nM98 P2\nM30\nO2\nX2.\nM99\n";
  CHECK(read(mark + numbered).moves.size() == read(numbered).moves.size());
  CHECK(read(mark + numbered).left_alone.size() == read(numbered).left_alone.size());
}
