#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/rewrite.hpp"
#include "program/reading.hpp"
#include "program/small_reader.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr char arc_start[] = "G21 G90 G17 G1 X10. Y0. Z0. F100.\n";

/// The text behind `arc_start` after an edit of the last move of `blocks`.
std::string arc_rewritten(const std::string& blocks, MoveEdit edit, const std::string& dialect = "linuxcnc") {
  const Program program = read_small(arc_start + blocks, dialect);
  edit.move = program.moves.size() - 1;
  return rewrite(program, {edit}, {}).text.substr(sizeof arc_start - 1);
}

/// Edits that move the last move of `blocks` and all moves before it by `d`.
std::string arc_moved(const std::string& blocks, const Vector3& d) {
  const Program program = read_small(arc_start + blocks);
  std::vector<MoveEdit> edits;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    edits.push_back({.move = i, .end_mm = program.moves[i].end_mm + d});
    if (program.moves[i].arc) edits.back().centre_mm = program.moves[i].arc->centre_mm + d;
  }
  const std::string text = rewrite(program, edits, {}).text;
  return text.substr(text.find('\n') + 1);
}

}  // namespace

TEST_CASE("an arc's own end and centre are written, and a word that rounds to its original value stays") {
  const std::string quarter = "G3 X0. Y10. I-10. J0. F50.\n";
  CHECK(arc_rewritten(quarter, {.end_mm = {0, 10, 0}, .centre_mm = Vector3::Zero()}) == quarter);
  CHECK(arc_rewritten(quarter, {.end_mm = {0.0004, 10, 0}, .centre_mm = Vector3(0.0003, 0, 0)}) == quarter);
  CHECK(arc_rewritten(quarter, {.end_mm = {0.01, 10.02, 0}, .centre_mm = Vector3(0.003, -0.004, 0)}) ==
        "G3 X0.01 Y10.02 I-9.997 J-0.004 F50.\n");
  CHECK(arc_rewritten(quarter, {.end_mm = {0, 10, 0.25}, .centre_mm = Vector3::Zero()}) ==
        "G3 X0. Y10. Z0.250 I-10. J0. F50.\n");
}

TEST_CASE("a common shift moves an arc's end and keeps its I and J") {
  CHECK(arc_moved("G3 X0. Y10. I-10. J0.\n", {0.5, -0.25, 0}) == "G3 X0.5 Y9.75 I-10. J0.\n");
  CHECK(arc_moved("G3 X0. Y10. R10.\n", {0.5, -0.25, 0}) == "G3 X0.5 Y9.75 R10.\n");
  CHECK(arc_moved("G2 I-10.\n", {0.5, -0.25, 0.125}) == "G2 I-10.\n");
  CHECK(arc_moved("g3x0.y10.i-10.\n", {0.5, -0.25, 0.125}) == "g3x0.5y9.75i-10.\n");
  CHECK(arc_moved("G90.1\nG3 X0. Y10. I0 J0\n", {0.5, -0.25, 0}) == "G90.1\nG3 X0.5 Y9.75 I0.5 J-0.25\n");
}

TEST_CASE("a missing word of an arc is inserted only if the correction needs it") {
  const MoveEdit edit{.end_mm = {-10, 0.02, 0}, .centre_mm = Vector3(0, 0.01, 0)};
  CHECK(arc_rewritten("G3 X-10. I-10.\n", edit) == "G3 X-10. Y0.020 I-10. J0.010\n");
  CHECK(arc_rewritten("G3 X-10. J0. I-10.\n", {.end_mm = {-10, 0, 0}, .centre_mm = Vector3::Zero()}) ==
        "G3 X-10. J0. I-10.\n");
  CHECK(arc_rewritten("G3 I-10. F50.\n", {.end_mm = {10.01, 0, 0}, .centre_mm = Vector3::Zero()}) ==
        "G3 X10.010 I-10. F50.\n");
  CHECK(arc_rewritten("G3I-10.F50.\n", {.end_mm = {10.01, 0, 0}, .centre_mm = Vector3(0, 0.5, 0)}) ==
        "G3X10.010I-10.J0.500F50.\n");
}

TEST_CASE("a split arc is written as arcs in its own format, with N on its first piece") {
  const double s = std::sqrt(50);
  MoveEdit edit{
      .inserted = {{{s, s, 0}, Vector3::Zero()}}, .end_mm = {0, 10, 0}, .centre_mm = Vector3::Zero()};
  CHECK(arc_rewritten("N7 G03 X0. Y10. I-10. J0. F50. (c)\n", edit) ==
        "N7 G03 X7.071 Y7.071 I-10.000 J0.000 F50.\nG03 X0. Y10. I-7.071 J-7.071 F50. (c)\n");
  CHECK(arc_rewritten("/g3x0.y10.i-10.\n", edit) == "/g3x7.071y7.071i-10.000\n/g3x0.y10.i-7.071j-7.071\n");
  CHECK(arc_rewritten("G3 X0. Y10. R10.\n", edit) == "G3 X7.071 Y7.071 R10.000\nG3 X0. Y10. R10.\n");
  CHECK(arc_rewritten("G90.1 G3 X0. Y10. I0 J0\n", edit) ==
        "G90.1 G3 X7.071 Y7.071 I0 J0\nG3 X0.000 Y10.000 I0.000 J0.000\n");
  edit.end_mm = {10, 0, 0};
  edit.inserted = {{{-10, 0, 0}, Vector3::Zero()}};
  CHECK(arc_rewritten("G2 I-10.\n", edit) == "G2 X-10.000 I-10.000\nG2 X10.000 I10.\n");
}

TEST_CASE("arcs of more than half a turn keep the sign of their radius") {
  const double s = std::sqrt(50);
  CHECK(arc_rewritten("G3 X0. Y-10. R-10.\n", {.end_mm = {0, -10.1, 0}, .centre_mm = Vector3(0, -0.05, 0)}) ==
        "G3 X0. Y-10.1 R-10.025\n");
  CHECK(arc_rewritten("G3 X0. Y-10. R-10.\n", {.inserted = {{{-s, s, 0}, Vector3::Zero()}},
                                               .end_mm = {0, -10, 0},
                                               .centre_mm = Vector3::Zero()}) ==
        "G3 X-7.071 Y7.071 R10.000\nG3 X0. Y-10. R10.\n");
}

TEST_CASE("chords of an arc are G1 without I, J, K, R and P, and keep F") {
  const double s = std::sqrt(50);
  const MoveEdit edit{.inserted = {{{s, s, 0}}}, .end_mm = {0, 10, 0}};
  CHECK(arc_rewritten("G03 X0. Y10. I-10. J0. F50.\n", edit) ==
        "G01 X7.071 Y7.071 F50.\nG01 X0. Y10. F50.\n");
  CHECK(arc_rewritten("N5 G3 X0. Y10. R10. P1 M8\n", edit) == "N5 G1 X7.071 Y7.071 M8\nG1 X0.000 Y10.000\n");
  CHECK(arc_rewritten("g3x0.y10.i-10.\n", edit) == "g1x7.071y7.071\ng1x0.y10.\n");
}

TEST_CASE("chords of an arc without axis words have axis words") {
  const MoveEdit edit{.inserted = {{{-10, 0, 0}}}, .end_mm = {10, 0.5, 0}};
  CHECK(arc_rewritten("g3 i-10. (round)\n", edit) == "g1 x-10.000\ng1 x10.000 y0.500 (round)\n");
  CHECK(arc_rewritten("G3 I-10. F50.\n", edit) == "G1 X-10.000 F50.\nG1 X10.000 Y0.500 F50.\n");
  CHECK(arc_rewritten("G3 I-5. J0. F50.\nN50 I-10. J0. (round)\n", edit) ==
        "G3 I-5. J0. F50.\nN50 G1 X-10.000\nX10.000 Y0.500 (round)\n");
  CHECK(arc_rewritten("G3 I-5. J0. F50.\nN50 I-10. M8\n", edit) ==
        "G3 I-5. J0. F50.\nN50 G1 X-10.000 M8\nX10.000 Y0.500\n");
}

TEST_CASE("the full turns of an arc are in its last piece, whichever block that is") {
  MoveEdit edit{
      .inserted = {{{-10, 0, 0}, Vector3::Zero()}}, .end_mm = {10, 0, -3}, .centre_mm = Vector3::Zero()};
  CHECK(arc_rewritten("G3 X10. Z-3. I-10. J0. P3\n", edit) ==
        "G3 X-10.000 I-10.000 J0.000\nG3 X10. Z-3. I10. J0. P3\n");
  CHECK(arc_rewritten("G3 X10. Z-3. I-10. J0. P3 M8\n", edit) ==
        "G3 X-10. Z0. I-10. J0. M8\nG3 X10.000 Z-3.000 I10.000 J0.000 P3\n");
}

TEST_CASE("half a turn keeps the sign of its radius") {
  for (const std::string radius : {"R5.", "R-5."}) {
    const std::string text = "G21 G90 G17\nG0 X5 Y-5.5 Z0\nG2 X15 " + radius + " F100\n";
    CAPTURE(text);
    const Program program = read(text);
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  }
}

TEST_CASE("half a turn keeps the sign of its radius when its ends are rounded") {
  const Vector3 shift{-0.4844, 0.2604, 0};
  for (const char* radius : {"R10.", "R-10."}) {
    CAPTURE(radius);
    const Program program = read(
        fmt::format("G21 G90 G17\nG0 X-114. Y-10. Z0\nG1 F100 X-114.\nG2 X-114. Y10. {}\nM30\n", radius));
    const std::string text = shifted_text(program, shift);
    CAPTURE(text);
    CHECK(contains(text, fmt::format("\nG2 X-114.484 Y10.26 {}\n", radius)));
  }
}

TEST_CASE("digits below the rounding errors do not change a word") {
  const std::string text = "G21 G90 G17\nG0 X5 Y-5.5 Z0\nG2 X15 Y-5. R-5.999999999999995 F100\n";
  const Program program = read(text);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}

TEST_CASE(
    "a block that relies on the motion of the arc before it gets a motion word behind chords; later blocks "
    "do not") {
  const std::string blocks = "G3 X0. Y10. I-10.\nX-10. Y0. J-10.\n";
  const auto chorded = [](const std::string& text, std::size_t move) {
    const Program program = read_small(arc_start + text);
    return rewrite(program, {{.move = move, .end_mm = program.moves[move].end_mm}}, {})
        .text.substr(sizeof arc_start - 1);
  };
  CHECK(chorded(blocks + "X0. Y-10. I10.\n", 1) == "G1 X0. Y10.\nG3 X-10. Y0. J-10.\nX0. Y-10. I10.\n");
  CHECK(chorded(blocks + "X0. Y-10. I10.\n", 2) == "G3 X0. Y10. I-10.\nG1 X-10. Y0.\nG3 X0. Y-10. I10.\n");
  CHECK(chorded("G3 X0. Y10. I-10.\nM8\nG1\nX5.\n", 1) == "G1 X0. Y10.\nM8\nG1\nX5.\n");
  CHECK(chorded("G3 X0. Y10. I-10.\nG0 X5.\n", 1) == "G1 X0. Y10.\nG0 X5.\n");
  CHECK(chorded("G3 X0. Y10. I-10.\n/X-10. Y0. J-10.\nX0. Y-10. I10.\n", 1) ==
        "G1 X0. Y10.\n/G3 X-10. Y0. J-10.\nG3 X0. Y-10. I10.\n");
}

TEST_CASE("a piece that ends at its start is not a full circle") {
  MoveEdit edit{.inserted = {{{9.9999, 0.0003, 0}, Vector3::Zero()}},
                .end_mm = {0, 10, 0},
                .centre_mm = Vector3::Zero()};
  CHECK(arc_rewritten("G3 X0. Y10. I-10.\n", edit) == "G3 X0. Y10. I-10.\n");
  CHECK(arc_rewritten("G3 X10. Y0.001 I-10.\n", {.end_mm = {10, 0.0001, 0}, .centre_mm = Vector3::Zero()}) ==
        "G1 X10. Y0.000\n");
  CHECK(arc_rewritten("G3 X10. Y0.001 I-10.\n", {.end_mm = {10, -0.001, 0}, .centre_mm = Vector3::Zero()}) ==
        "G1 X10. Y-0.001\n");
}

TEST_CASE("the pieces of a G93 move share its time by their lengths") {
  const std::string text = "G93\nG1 X4. F10.\n";
  CHECK(arc_rewritten(text, {.inserted = {{{9, 0, 0}}, {{7, 0, 0}}}, .end_mm = {4, 0, 0}}) ==
        "G93\nG1 X9.000 F60.00000\nG1 X7.000 F30.00000\nG1 X4. F20.\n");
  CHECK(arc_rewritten(text, {.end_mm = {4, 0.5, 0}}) == "G93\nG1 X4. Y0.500 F10.\n");
  const double s = std::sqrt(50);
  CHECK(arc_rewritten(
            "G93 G3 X0. Y10. I-10. F10.\n",
            {.inserted = {{{s, s, 0}, Vector3::Zero()}}, .end_mm = {0, 10, 0}, .centre_mm = Vector3::Zero()})
            .find("F20.00000\n") != std::string::npos);
}

TEST_CASE("an arc that is not followed keeps its motion word and its centre when it is held") {
  const Program program =
      read("G21 G90 G17 G0 X0. Y0. Z0.\nG91\n#1=5\nG3 X[#1] Y1. I1. J0. F100\nX1. Y1. I0.5\n");
  REQUIRE(program.moves.size() == 3);
  std::vector<MoveEdit> edits;
  for (std::size_t i = 0; i < 3; ++i)
    edits.push_back({.move = i, .end_mm = program.moves[i].end_mm + Vector3(0, 0.5, 0)});
  CHECK(rewrite(program, edits, {}).text ==
        "G21 G90 G17 G0 X0. Y0.5 Z0.\nG91\n#1=5\nG3 X[#1] Y1. I1. J0. F100\nX1. Y1. I0.5\n");
}

TEST_CASE("behind chords a call keeps its words, and after the end of a program no motion word is needed") {
  const std::string start = "G21 G90 G17 G1 X10. Y0. Z0. F100.\nG3 X0. Y10. I-10.\n";
  const auto chorded = [&](const std::string& rest) {
    const Program program = read(start + rest, "fanuc");
    const std::string text = rewrite(program, {{.move = 1, .end_mm = program.moves[1].end_mm}}, {}).text;
    return text.substr(text.find('\n', text.find('\n') + 1) + 1);
  };
  CHECK(chorded("G65 P100 X1. Y2.\nG0 X5.\n") == "G65 P100 X1. Y2.\nG0 X5.\n");
  CHECK(chorded("M30\n") == "M30\n");
  CHECK(chorded("X-10. Y0. J-10.\nM30\n") == "G3 X-10. Y0. J-10.\nM30\n");
}

TEST_CASE("an R that is slightly too short for its ends stays if the arc does not move") {
  const std::string text = "G21 G90 G17 F100\nG0 X10. Y13.5 Z0.\nG2 X30. Y10. R10.15\n";
  const Program program = read(text);
  REQUIRE(program.moves[1].arc);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}
