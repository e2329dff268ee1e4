#include "counterflex/program/rewrite.hpp"

#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr char start[] = "G21 G0 X0. Y0. Z0.\n";

/// The last block of `start` and `block` after its end was edited to `end_mm`.
std::string rewritten(const std::string& block, const Vector3& end_mm, const std::string& dialect = "auto") {
  const std::string text = with_last_move(start + block, {.end_mm = end_mm}, dialect);
  return text.substr(sizeof start - 1);
}

}  // namespace

TEST_CASE("a changed word keeps its decimals, sign style and leading zero, and always has a decimal point") {
  CHECK(rewritten("G0 X10.0000\n", {10.25, 0, 0}) == "G0 X10.2500\n");
  CHECK(rewritten("G0 X10.0000\n", {10.12345678, 0, 0}) == "G0 X10.1235\n");
  CHECK(rewritten("G0 X10.\n", {11, 0, 0}) == "G0 X11.\n");
  CHECK(rewritten("G0 X10\n", {11, 0, 0}) == "G0 X11.\n");
  CHECK(rewritten("G0 X10\n", {10.002, 0, 0}) == "G0 X10.002\n");
  CHECK(rewritten("G0 X10.5\n", {10.6, 0, 0}) == "G0 X10.6\n");
  CHECK(rewritten("G0 X+1.5\n", {1.6, 0, 0}) == "G0 X+1.6\n");
  CHECK(rewritten("G0 X+.001\n", {-0.002, 0, 0}) == "G0 X-.002\n");
  CHECK(rewritten("G0 X.5\n", {0.625, 0, 0}) == "G0 X.625\n");
  CHECK(rewritten("G0 X-.5\n", {-1.5, 0, 0}) == "G0 X-1.5\n");
  CHECK(rewritten("G0 X0.001\n", {-0.0001, 0, 0}) == "G0 X0.000\n");
  CHECK(rewritten("G0 X.5\n", {0, 0, 0}) == "G0 X.0\n");
  CHECK(rewritten("G0 X 1 0. 5\n", {10.6, 0, 0}) == "G0 X 10.6\n");
  CHECK(rewritten("G20 X1.\n", {25.4 * 1.00012, 0, 0}) == "G20 X1.0001\n");
}

TEST_CASE("a word whose new value rounds to its original value stays") {
  CHECK(rewritten("G0 X10\n", {10.0004, 0, 0}) == "G0 X10\n");
  CHECK(rewritten("G0 X-0.000\n", {-0.0004, 0, 0}) == "G0 X-0.000\n");
  CHECK(rewritten("G0 X1.23456\n", {1.234564, 0, 0}) == "G0 X1.23456\n");
  const Program program = read("G21 G0 X1.23456 Y2.\n");
  const MoveEdit edit{.end_mm = {1.23496, 2, 0}};
  CHECK(rewrite(program, {edit}, {.decimals = 3}).text == program.text);
  CHECK(rewrite(program, {edit}, {.decimals = 4}).text == "G21 G0 X1.2350 Y2.\n");
}

TEST_CASE("a missing word is inserted behind the last axis word in the block's spacing and case") {
  CHECK(rewritten("G1 X1. F100\n", {1, 0.002, 0}) == "G1 X1. Y0.002 F100\n");
  CHECK(rewritten("G1 X1. F100\n", {1, 0.002, -0.01}) == "G1 X1. Y0.002 Z-0.010 F100\n");
  CHECK(rewritten("n5g1x1.f100 (c)\n", {1.001, 0.002, 0}) == "n5g1x1.001y0.002f100 (c)\n");
  CHECK(rewritten("G1\tX1.\tF100\n", {1, 0.002, 0}) == "G1\tX1.\tY0.002\tF100\n");
  CHECK(rewritten("G1   X1.\n", {1, 0.002, 0}) == "G1   X1. Y0.002\n");
  CHECK(rewritten("X1.(c)\n", {1, 0.002, 0}) == "X1. Y0.002(c)\n");
  CHECK(rewritten("G20 X1.\n", {25.4, 0.0127, 0}) == "G20 X1. Y0.0005\n");
  CHECK(with_last_move("G21G0X0.Y0.Z0.\nX1.\n", {.end_mm = {1, 0.002, 0}}) == "G21G0X0.Y0.Z0.\nX1.Y0.002\n");
}

TEST_CASE("a word is inserted only if the position in the text differs, and again to move back") {
  const Program program = read("G21 G0 X0. Y0. Z0.\nG1 X1. F100\nX2.\nX3.\n");
  const std::vector<MoveEdit> edits{{.move = 1, .end_mm = {1, 0.002, 0}},
                                    {.move = 2, .end_mm = {2, 0.002, 0}},
                                    {.move = 3, .end_mm = {3, 0, 0}}};
  const Rewritten out = rewrite(program, edits, {});
  CHECK(out.text == "G21 G0 X0. Y0. Z0.\nG1 X1. Y0.002 F100\nX2.\nX3. Y0.000\n");
  CHECK(out.changed_words == 0);
  CHECK(out.inserted_words == 2);
  CHECK(out.inserted_blocks == 0);
}

TEST_CASE("no word is inserted for an axis that is unknown, nor into a block with G43") {
  const Program unknown = read("G21 G0 X1. Y1.\nX2.\n");
  CHECK(rewrite(unknown, {{.move = 1, .end_mm = {2.001, 1, 7}}}, {}).text == "G21 G0 X1. Y1.\nX2.001\n");
  const Program length = read("G21 G0 X1. Y1.\nG43 H1 Z5.\nZ6.\n");
  const std::vector<MoveEdit> edits{{.move = 1, .end_mm = {1.5, 1, 5.25}},
                                    {.move = 2, .end_mm = {1.5, 1, 6}}};
  CHECK(rewrite(length, edits, {}).text == "G21 G0 X1. Y1.\nG43 H1 Z5.25\nZ6. X1.500\n");
}

TEST_CASE("an axis with a word inserted into a skippable block is unknown afterwards and programmed again") {
  const Program program = read("G21 G0 X0. Y0. Z0.\n/ X1.\nX2.\nX3.\n");
  const std::vector<MoveEdit> edits{{.move = 1, .end_mm = {1, 0.5, 0}},
                                    {.move = 2, .end_mm = {2, 0.5, 0}},
                                    {.move = 3, .end_mm = {3, 0.5, 0}}};
  CHECK(rewrite(program, edits, {}).text == "G21 G0 X0. Y0. Z0.\n/ X1. Y0.500\nX2. Y0.500\nX3.\n");
}

TEST_CASE("pieces of a split move precede it and copy motion, feed and block delete, but no comment") {
  const MoveEdit edit{.inserted = {{{1, 0.25, 0}}, {{2, 0.25, 0}}}, .end_mm = {3, 0, 0}};
  CHECK(rewritten("N10 G01 X3. F100. (edge)\n", {3, 0, 0}) == "N10 G01 X3. F100. (edge)\n");
  CHECK(with_last_move(std::string(start) + "N10 G01 X3. F100. (edge)\r\n", edit) ==
        std::string(start) +
            "N10 G01 X1.000 Y0.250 F100.\r\nG01 X2.000 F100.\r\nG01 X3. Y0.000 F100. (edge)\r\n");
  CHECK(with_last_move(std::string(start) + "G1 F100\n/ x3.\n", edit) ==
        std::string(start) + "G1 F100\n/ x1.000 y0.250\n/ x2.000\n/ x3. y0.000\n");
}

TEST_CASE("the first piece of a split block has its N, so that a restart there runs the whole move") {
  const MoveEdit edit{.inserted = {{{1, 0.25, 0}}}, .end_mm = {3, 0, 0}};
  const auto split = [&](const std::string& block, const std::string& dialect) {
    return with_last_move(start + block, edit, dialect).substr(sizeof start - 1);
  };
  CHECK(split("N50 G1 X3. F9.\n", "fanuc") == "N50 G1 X1.000 Y0.250 F9.\nG1 X3. Y0.000 F9.\n");
  CHECK(split("G01 N50 X3. F9.\n", "haas") == "N50 G01 X1.000 Y0.250 F9.\nG01 X3. Y0.000 F9.\n");
  CHECK(split("n50g1x3.f9.\n", "grbl") == "n50g1x1.000y0.250f9.\ng1x3.y0.000f9.\n");
  CHECK(split("/N50 G1 X3. F9\n", "linuxcnc") == "/N50 G1 X1.000 Y0.250 F9\n/G1 X3. Y0.000 F9\n");
  CHECK(split("N50 G1 X3. F9 M8\n", "mach3") == "N50 G1 X1. Y0.250 F9 M8\nG1 X3.000 Y0.000 F9\n");
  CHECK(with_last_move("G71 G0 X0. Y0. Z0.\nN50 NEXT: G1 X3. F9\n", edit, "siemens") ==
        "G71 G0 X0. Y0. Z0.\nN50 NEXT: G1 X1. Y0.250 F9\nG1 X3.000 Y0.000 F9\n");
  const std::string fed = std::string(start) + "F9.\n";
  CHECK(with_last_move(fed + "N50 Z5.\n", {.jump = Via{Vector3(0, 1, 0)}, .end_mm = {0, 1, 5}}) ==
        fed + "N50 G1 Y1.000\nG0 Z5.\n");
}

TEST_CASE("the other pieces are numbered if the program has free numbers, and counted otherwise") {
  const auto split = [](const std::string& text) {
    const Program program = read(text, "mach3");
    BlockNumbers numbers;
    numbers.add(text);
    numbers.finish();
    const MoveEdit edit{.move = 1, .inserted = {{{1, 0.25, 0}}, {{2, 0.25, 0}}}, .end_mm = {3, 0, 0}};
    return rewrite(program, {edit}, {.number_pieces = &numbers});
  };
  const std::string head = "G21 G0 X0. Y0. Z0.\n";
  CHECK(split(head + "N0050 G1 X3. F9\nN0053 X4.\n").text ==
        head + "N0050 G1 X1.000 Y0.250 F9\nN0051 G1 X2.000 F9\nN0052 G1 X3. Y0.000 F9\nN0053 X4.\n");
  const std::string bare = "N50 G1 X1.000 Y0.250 F9\nG1 X2.000 F9\nG1 X3. Y0.000 F9\n";
  for (const std::string rest : {"N52 X4.\n", "(BACK TO N51)\n", "N50 X4.\n"}) {
    CAPTURE(rest);
    const Rewritten out = split(head + "N50 G1 X3. F9\n" + rest);
    CHECK(out.text == head + bare + rest);
    CHECK(out.unnumbered_pieces == 2);
    CHECK(out.first_unnumbered_line == 2);
  }
  CHECK(split(head + "N9998 G1 X3. F9\n").unnumbered_pieces == 2);
  CHECK(split("N10000 " + head + "N9990 G1 X3. F9\n").unnumbered_pieces == 0);
  CHECK(split(head + "G1 X3. F9\n").unnumbered_pieces == 0);
}

TEST_CASE("a last line without a line end gets none, and its pieces have the line end of the file") {
  const MoveEdit edit{.inserted = {{{1, 0, 0.5}}}, .end_mm = {2, 0, 0}};
  CHECK(with_last_move("G21 G0 X0. Y0. Z0.\r\nG1 X2. F100", edit) ==
        "G21 G0 X0. Y0. Z0.\r\nG1 X1.000 Z0.500 F100\r\nG1 X2. Z0.000 F100");
  CHECK(with_last_move("G21 G0 X0. Y0. Z0.\r\nG1 X2. F100 M8", edit) ==
        "G21 G0 X0. Y0. Z0.\r\nG1 X1. Z0.500 F100 M8\r\nG1 X2.000 Z0.000 F100");
}

TEST_CASE("a block with other words is itself the first piece") {
  const MoveEdit edit{.inserted = {{{1, 0.25, 0}}, {{2, 0.25, 0}}}, .end_mm = {3, 0, 0}};
  CHECK(with_last_move(std::string(start) + "N10 G1 G54 X3. Y0. Z0. F100 S900 M3\nM5\n", edit) ==
        std::string(start) +
            "N10 G1 G54 X1. Y0.25 Z0. F100 S900 M3\nG1 X2.000 F100\nG1 X3.000 Y0.000 F100\nM5\n");
}

TEST_CASE("the other pieces do not repeat an F that is read in the unit before the block") {
  const MoveEdit edit{.inserted = {{{12.7, 0.25, 0}}}, .end_mm = {25.4, 0, 0}};
  const std::string block = std::string(start) + "G20 G1 X1. F20\n";
  CHECK(with_last_move(block, edit, "linuxcnc") ==
        std::string(start) + "G20 G1 X0.5 Y0.0098 F20\nG1 X1.0000 Y0.0000\n");
  CHECK(with_last_move(block, edit, "fanuc") ==
        std::string(start) + "G20 G1 X0.5 Y0.0098 F20\nG1 X1.0000 Y0.0000 F20\n");
}

TEST_CASE("a block that sets the force is itself the first piece") {
  const MoveEdit edit{.inserted = {{{1, 0.25, 0}}}, .end_mm = {3, 0, 0}};
  CHECK(with_last_move(std::string(start) + "G1 X3. F100 (FORCE FX=5)\n", edit) ==
        std::string(start) + "G1 X1. Y0.250 F100 (FORCE FX=5)\nG1 X3.000 Y0.000 F100\n");
}

TEST_CASE("points that round to the point before them give no block") {
  const MoveEdit edit{.inserted = {{{0.0001, 0, 0}}, {{1, 0, 0}}, {{1.0002, 0, 0}}}, .end_mm = {3, 0, 0}};
  const Program program = read(std::string(start) + "G1 X3. F100\n");
  const Rewritten out = rewrite(program, {{.move = 1, .inserted = edit.inserted, .end_mm = edit.end_mm}}, {});
  CHECK(out.text == std::string(start) + "G1 X1.000 F100\nG1 X3. F100\n");
  CHECK(out.inserted_blocks == 1);
}

TEST_CASE("a feed move before a rapid is a G1, and the rapid gets a G0") {
  const std::string text = std::string(start) + "G1 X1. F100\nG0\nZ5.\n";
  const MoveEdit edit{.jump = Via{Vector3(1, 0.25, 0)}, .end_mm = {1, 0, 5}};
  CHECK(with_last_move(text, edit) == std::string(start) + "G1 X1. F100\nG0\nG1 Y0.250\nG0 Z5. Y0.000\n");
  CHECK(with_last_move(std::string(start) + "G1 X1. F100\nG00 Z5.\n", edit) ==
        std::string(start) + "G1 X1. F100\nG01 Y0.250\nG00 Z5. Y0.000\n");
  CHECK(with_last_move(std::string(start) + "G1 X1. F100\nX2.\n",
                       {.jump = Via{Vector3(1, 0.25, 0)}, .end_mm = {2, 0.25, 0}}) ==
        std::string(start) + "G1 X1. F100\nY0.250\nX2.\n");
}

TEST_CASE("an ambiguous integer word in a block that must be rewritten is refused") {
  const std::string text = "O1\nG21 G0 X5 Y0 Z1.\n";
  const auto shift = [&](const Vector3& d, IntegerWords words) {
    ReadOptions options;
    options.integer_words = words;
    const Program program = read_program(text, "p.nc", options);
    return rewrite(program, shifted(program, d), {}).text;
  };
  CHECK(shift({0, 0, 0}, IntegerWords::unspecified) == text);
  CHECK(diagnostic_of([&] {
          shift({0, 0, 0.5}, IntegerWords::unspecified);
        }) ==
        "p.nc:2:8: error: X5 has no decimal point: it may mean units or increments; give "
        "--integer-words units or --integer-words increments");
  CHECK(shift({0.5, 0, 0}, IntegerWords::units) == "O1\nG21 G0 X5.5 Y0 Z1.\n");
  CHECK(shift({0.5, 0, 0}, IntegerWords::increments) == "O1\nG21 G0 X0.505 Y0 Z1.\n");
  CHECK(with_last_move("G21 G0 X5 Y0 Z1.\n", {.end_mm = {5, 0, 2}}) == "G21 G0 X5 Y0 Z2.\n");
}

TEST_CASE("K of a Fanuc's cycle is a count, not an ambiguous length") {
  const std::string before = "O1\nG21 G90 G0 X0. Y0. Z5.\nG98 G81 X5. Y5. Z-5. R2. F100.\n";
  const Program program = read_program(before + "Y9. K2\nG80\n", "p.nc", {});
  CHECK(rewrite(program, shifted(program, {0, 0.25, 0}), {}).text.find("Y9.25 K2\n") != std::string::npos);
}

TEST_CASE("a block that would be longer than the control reads is refused") {
  const std::string comment(230, 'c');
  const std::string text = std::string(start) + "G1 X1. F100 (" + comment + ")\n";
  CHECK(diagnostic_of([&] {
          with_last_move(text, {.end_mm = {1, 0.5, 0.5}});
        }) == "p.ngc:2:256: error: the corrected line would have 258 characters; linuxcnc reads 255");
  CHECK(with_last_move(text, {.end_mm = {1, 0.5, 0.5}}, "grbl").size() > text.size());
}

TEST_CASE("the header is written behind '%' and the O line, in upper case, with the line end of the file") {
  const WriteOptions options{.header = {"counterflex 1 (0.1.0)", "input 0123"}};
  const auto with_header = [&](const std::string& text) { return rewrite(read(text), {}, options).text; };
  CHECK(with_header("G21\n") == "(COUNTERFLEX 1  0.1.0 )\n(INPUT 0123)\nG21\n");
  CHECK(with_header("%\r\n(PART)\r\nG21\r\n%\r\n") ==
        "%\r\n(COUNTERFLEX 1  0.1.0 )\r\n(INPUT 0123)\r\n(PART)\r\nG21\r\n%\r\n");
  CHECK(with_header("%\nO1001 (PART)\nG21\n") ==
        "%\nO1001 (PART)\n(COUNTERFLEX 1  0.1.0 )\n(INPUT 0123)\nG21\n");
  CHECK(with_header("O1001") == "O1001\n(COUNTERFLEX 1  0.1.0 )\n(INPUT 0123)\n");
  CHECK(is_corrected(read(with_header("%\nO1001\nG21\n"))));
}

TEST_CASE("the position in the text is known before it is written") {
  const Program program = read("G21 G0 X0.12345 Y0. Z0.\nG1 X1. F100\n");
  const TextPosition start_held{0.12345, 0.0, 0.0};
  const TextPosition position =
      text_position_after(program.moves[1], start_held, {1.00024, 0.00049, 0.0127}, {});
  CHECK(position == TextPosition{1.0, 0.0, 0.013});
  CHECK(text_position_after(program.moves[0], {}, {0.1234549, 0.0006, 0}, {}) ==
        TextPosition{0.12345, 0.001, 0.0});
  CHECK(as_written_mm({1.23456, -0.0004, 2}, LengthUnit::millimetres, {4, 3, 3}) == Vector3(1.2346, 0, 2));
  CHECK(as_written_mm({25.4, 12.7127, 0}, LengthUnit::inches, {4, 4, 4})
            .isApprox(Vector3(25.4, 0.5005 * 25.4, 0)));
}
