#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/curve.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The arc of the last move of `text`, with the start at (0, 0, 0).
Move last_arc(const std::string& text, const std::string& dialect = "auto") {
  const Program program = read("G21 G90 F100\nG0 X0. Y0. Z0.\n" + text + "\n", dialect);
  REQUIRE(program.moves.back().arc.has_value());
  return program.moves.back();
}

double sweep_of(const Move& move) {
  const Vector3 normal = Vector3::Unit(move.arc->normal) * (move.arc->clockwise ? -1.0 : 1.0);
  return sweep_between(move.start_mm, move.end_mm, move.arc->centre_mm, normal, move.arc->turns);
}

constexpr double half_turn = 3.14159265358979323846;

}  // namespace

TEST_CASE("I, J and K are relative to the start, and missing ones are zero") {
  const Move move = last_arc("G3 X10. Y10. J10.");
  CHECK(move.motion == Motion::feed);
  CHECK(move.end_mm == Vector3(10, 10, 0));
  CHECK(move.arc->centre_mm == Vector3(0, 10, 0));
  CHECK_FALSE(move.arc->clockwise);
  CHECK_FALSE(move.arc->centre_words[0].has_value());
  CHECK(move.arc->centre_words[1]->decimals == 0);
  CHECK(sweep_of(move) == doctest::Approx(half_turn / 2));
}

TEST_CASE("an arc without a word of an axis ends at its start along that axis") {
  const Move move = last_arc("G2 X10. I5.");
  CHECK(move.end_mm == Vector3(10, 0, 0));
  CHECK(move.arc->centre_mm == Vector3(5, 0, 0));
  CHECK(sweep_of(move) == doctest::Approx(half_turn));
}

TEST_CASE("centre words without an axis word are a full circle, also in a modal block") {
  const Move circle = last_arc("G3 I -20.");
  CHECK(circle.end_mm == Vector3(0, 0, 0));
  CHECK(circle.arc->centre_mm == Vector3(-20, 0, 0));
  CHECK(sweep_of(circle) == doctest::Approx(2 * half_turn));
  CHECK(read("G21 G0 X0 Y0 Z0\nG3 I5 F100\nF50\nI5\n").moves.size() == 3);
}

TEST_CASE("G18 goes from Z to X and G19 from Y to Z counter-clockwise") {
  const Move zx = last_arc("G18 G3 Z-10. X10. K-10.");
  CHECK(zx.arc->normal == 1);
  CHECK(zx.arc->centre_mm == Vector3(0, 0, -10));
  CHECK(sweep_of(zx) == doctest::Approx(half_turn / 2));
  const Move yz = last_arc("G19 G2 Y10. Z10. J10.");
  CHECK(yz.arc->normal == 0);
  CHECK(yz.arc->centre_mm == Vector3(0, 10, 0));
  CHECK(sweep_of(yz) == doctest::Approx(half_turn / 2));
}

TEST_CASE("a helix keeps its height, P is the number of its turns") {
  const Move helix = last_arc("G2 X10. Y0. Z-3. I5. P3");
  CHECK(helix.end_mm.z() == -3);
  CHECK(helix.arc->centre_mm == Vector3(5, 0, 0));
  CHECK(helix.arc->turns == 2);
  CHECK(sweep_of(helix) == doctest::Approx(5 * half_turn));
}

TEST_CASE("P of an arc is the number of its turns in LinuxCNC and GRBL only") {
  const std::string arc = "G21 G90 G0 X0. Y0. Z0.\nG2 X0. Y0. I10. Z-15. F100. P3\n";
  CHECK(read(arc, "grbl").moves.back().arc->turns == 2);
  for (const char* dialect : {"fanuc", "haas", "mach3"})
    CHECK(diagnostic_of([&] { read(arc, dialect); }) == "p.ngc:2:29: error: no code in the block uses P");
  const Program offset = read("O1\nG21 G90 G54.1 P3 G0 X0. Y0. Z0.\nG54.1 P3 G2 X10. Y0. I5. F100.\n");
  CHECK(offset.moves.back().arc->turns == 0);
}

TEST_CASE("under G90.1 centres are coordinates, under G91.1 and G91 they are relative to the start") {
  CHECK(last_arc("G1 X5.\nG90.1 G2 X15. Y0 I10. J0").arc->centre_mm == Vector3(10, 0, 0));
  CHECK(last_arc("G1 X5.\nG90.1\nG91.1 G2 X15. Y0 I5. J0").arc->centre_mm == Vector3(10, 0, 0));
  const Move relative = last_arc("G1 X5.\nG91 G2 X10. Y0 I5. J0");
  CHECK(relative.relative);
  CHECK(relative.end_mm == Vector3(15, 0, 0));
  CHECK(relative.arc->centre_mm == Vector3(10, 0, 0));
}

TEST_CASE("R is the shorter arc, negative R the longer, on the side given by the direction") {
  for (const std::string g : {"G2", "G3"})
    for (const double r : {8.0, -8.0}) {
      CAPTURE(g);
      CAPTURE(r);
      const Move move = last_arc(g + " X6. Y8. R" + std::to_string(r));
      CHECK((move.arc->centre_mm - move.start_mm).norm() == doctest::Approx(8));
      CHECK((move.arc->centre_mm - move.end_mm).norm() == doctest::Approx(8));
      const double shorter = 2 * std::asin(5.0 / 8.0);
      CHECK(sweep_of(move) == doctest::Approx(r > 0 ? shorter : 2 * half_turn - shorter));
      CHECK(move.arc->radius_mm == r);
    }
}

TEST_CASE("an R that is too short by rounding is half a turn about the middle") {
  const Move move = last_arc("G2 X10. Y0. R4.96");
  CHECK(move.arc->centre_mm.isApprox(Vector3(5, 0, 0), 1e-12));
  CHECK(sweep_of(move) == doctest::Approx(half_turn));
}

TEST_CASE("an arc in inches has its centre in mm") {
  const Move move = last_arc("G20 G3 X1. I.5 J0");
  CHECK(move.arc->centre_mm.isApprox(Vector3(12.7, 0, 0)));
}

TEST_CASE("an arc that '/' may skip stays one block") {
  const Program program = read("G21 F100 G0 X0 Y0 Z2\n/G2 X5 I2.5\nG0 X0 Y0\nG2 X5 I2.5\n");
  CHECK(program.moves.at(1).arc.has_value());
  CHECK_FALSE(program.moves[1].may_split);
  CHECK_FALSE(program.moves[1].may_jump);
  CHECK(program.moves.at(3).may_split);
}

TEST_CASE("an arc with an unknown start is fixed on the words of its plane and unknown, other axes are not") {
  const Program program = read("G21 F100 G0 Y1 Z2\nG2 X5 Z3 I2.5\nG1 X0\n");
  const Move& arc = program.moves[1];
  CHECK_FALSE(arc.arc.has_value());
  CHECK(arc.fixed == std::array<bool, 3>{true, false, false});
  CHECK(arc.known_end == std::array<bool, 3>{false, true, true});
  CHECK_FALSE(arc.words[0].has_value());
  CHECK(arc.words[2].has_value());
  CHECK_FALSE(arc.may_split);
  CHECK(program.left_alone.at(0).why == "the start of the arc is not known");
  CHECK(program.moves[2].known_end == std::array<bool, 3>{true, true, true});
}

TEST_CASE("an arc with an expression as its centre is held, or fixed if the centre is a coordinate") {
  const Program held = read("G21 F100 G0 X0 Y0 Z0\nG2 X5 I#1\n");
  CHECK(held.moves[1].handling == Handling::held);
  CHECK(held.moves[1].words[0].has_value());
  CHECK(held.moves[1].known_end[0]);
  const Program fixed = read("G21 G90.1 F100 G0 X0 Y0 Z0\nG2 X5 I#1 J0\n");
  CHECK(fixed.moves[1].fixed[0]);
  CHECK_FALSE(fixed.moves[1].known_end[0]);
}

TEST_CASE("the way of an arc whose centre, radius or turns are an expression is not its chord") {
  struct Line {
    std::string arc, dialect;
  };
  for (const auto& line :
       {Line{"G3 X21. Y10. R#1", "linuxcnc"}, Line{"G3 X21. Y10. I#1 J#2", "linuxcnc"},
        Line{"G3 X21. Y10. I.5 J-50. P#1", "linuxcnc"}, Line{"G3 X21. Y10. R#1", "fanuc"},
        Line{"G3 X21. Z-1. I#1", "fanuc"}, Line{"G3 Z-1. I#1", "fanuc"}, Line{"G3 X21. CR=R1", "siemens"},
        Line{"G3 X21. Y10. I=R1 J0", "siemens"}, Line{"G3 X21. Y10. I.5 J-50. TURN=R1", "siemens"}}) {
    CAPTURE(line.arc);
    CAPTURE(line.dialect);
    const std::string modes = line.dialect == "siemens" ? "G71 G90" : "G21 G90";
    const Program program =
        read(modes + "\nG0 X20. Y10. Z0.\n" + line.arc + " F100\nG1 X40.\n", line.dialect);
    const Move& move = program.moves.at(1);
    CHECK_FALSE(all_known(move.known_start));
    CHECK(all_known(move.known_end));
    CHECK(all_known(move.moved_only_by_program));
    CHECK(all_known(program.moves.at(2).known_start));
  }
  CHECK(read("G21 G90 G93\nG0 X0 Y0 Z0\nG3 X1 R#1 F9\n").moves.at(1).feed_mm_min == 0);
}

TEST_CASE("the height that a machine position leaves unknown stays unknown on an arc that is not followed") {
  const Program program = read("G21 G90\nG0 X0 Y0 Z0\nG28 Z0\nG3 X1 R#1 F9\n");
  CHECK(program.moves.at(1).moved_only_by_program == std::array<bool, 3>{true, true, false});
}

TEST_CASE("F of G93 applies to one move: the feed follows from its length") {
  const Program program = read("G21 G0 X0 Y0 Z0\nG93 G1 X10 F2\nG2 X20 I5 F4\nX30 Y0 R5\nG94 G1 X0 F100\n");
  CHECK(program.moves[1].feed_mode == FeedMode::inverse_time);
  CHECK(program.moves[1].feed_per_min == 2);
  CHECK(program.moves[1].feed_mm_min == doctest::Approx(20));
  CHECK(program.moves[2].feed_mm_min == doctest::Approx(4 * 5 * half_turn));
  CHECK(program.moves[3].feed_mm_min == 0);
  CHECK(program.moves[4].feed_mode == FeedMode::length);
  CHECK(program.moves[4].feed_mm_min == 100);
}

TEST_CASE("a move of G93 whose time is not a plain number is not split") {
  const Program program = read("G21 F100 G0 X0 Y0 Z0\nG93 G1 X10 F2\nX20 F[1+1]\nX30 F#1\nX40\n");
  CHECK(program.moves[1].may_split);
  for (const std::size_t unknown : {2U, 3U, 4U}) {
    CAPTURE(unknown);
    CHECK_FALSE(program.moves[unknown].may_split);
    CHECK_FALSE(program.moves[unknown].may_jump);
  }
}

TEST_CASE("a centre word across the plane is ignored as in GRBL, and stays") {
  const std::string text = "G21 G90\nG0 X0. Y0. Z0.\nG2 X10. Y0. Z-1. I5. J0. K-.5 F100\n";
  const Program program = read(text, "grbl");
  REQUIRE(program.moves.at(1).arc);
  CHECK(program.moves[1].arc->centre_mm == Vector3(5, 0, 0));
  const MoveEdit edit{.move = 1, .end_mm = {10.5, 0, -1.5}, .centre_mm = Vector3(5.5, 0, 0)};
  const MoveEdit before{.move = 0, .end_mm = {.5, 0, -.5}};
  CHECK(rewrite(program, {before, edit}, {}).text.find("G2 X10.5 Y0. Z-1.5 I5. J0. K-.5 F100\n") !=
        std::string::npos);
  CHECK_THROWS(read(text, "linuxcnc"));
}
