#include <doctest/doctest.h>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext is detected by its first statement") {
  CHECK(read("\r\n0 BEGIN PGM A MM\r\n1 END PGM A MM\r\n").dialect == "heidenhain");
  CHECK(read("G21\nG0 X1\n").dialect == "linuxcnc");
  CHECK(read("BEGIN PGM A INCH\nL X+1 FMAX\n").moves.at(0).end_mm.x() == doctest::Approx(25.4));
}

TEST_CASE("klartext is detected by its first statement behind comments of any kind") {
  for (const char* comments : {"( Sheet\n(   Machine: \"A\"\n(\n( End\n", "; one\n\n * two\n", "-----\r\n",
                               "($Message(\"open\"))\n", "\xEF\xBB\xBF", "0 ; one\n"}) {
    CAPTURE(comments);
    const std::string text = std::string(comments) + "BEGIN PGM A MM\nL X+1 Y+0 Z+0 FMAX\nEND PGM A MM\n";
    const Program program = read(text);
    CHECK(program.dialect == "heidenhain");
    REQUIRE(program.moves.size() == 1);
    CHECK(program.left_alone.empty());
    CHECK(klartext_shifted(program) ==
          std::string(comments) + "BEGIN PGM A MM\nL X+1.5 Y-0.25 Z+0.125 FMAX\nEND PGM A MM\n");
  }
  CHECK(read("(BEGIN PGM A MM)\nG21\nG0 X1\n").dialect == "linuxcnc");
}

TEST_CASE("the extension of a file name decides the dialect if the text does not") {
  const auto dialect_of_file = [](const std::string& text, const std::string& file) {
    ReadOptions options;
    options.unit = LengthUnit::millimetres;
    return read_program(text, file, options).dialect;
  };
  CHECK(dialect_of_file("TOOL CALL 1 Z S100\nL X+1 FMAX\n", "part.H") == "heidenhain");
  CHECK(dialect_of_file("L X+1 FMAX\n", "part.h") == "heidenhain");
  CHECK(dialect_of_file("G21\nG0 X1\n", "part.h") == "linuxcnc");
  CHECK(dialect_of_file("G71 G90\nG0 X1\n", "part.MPF") == "siemens");
  CHECK(dialect_of_file("G71 G90\nG0 X1\n", "part.spf") == "siemens");
}
