#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("the depth and the retract plane of a cycle are modal, and each block after it is a hole") {
  const Program program = read("G21 G90 G0 X0 Y0 Z10\nG98 G81 X1 Y2 Z-5 R2 F100\nX3\nZ-6 Y4\nG80\nG0 X9\n");
  REQUIRE(program.moves.size() == 5);
  const Move& first = program.moves[1];
  REQUIRE(first.cycle.has_value());
  CHECK(first.cycle->first);
  CHECK(first.cycle->bottom_mm == -5);
  CHECK(first.cycle->retract_mm == 2);
  CHECK(first.cycle->bottom_word.has_value());
  CHECK_FALSE(first.words[2].has_value());
  CHECK(first.end_mm == Vector3(1, 2, 10));
  CHECK(first.handling == Handling::own);
  CHECK_FALSE(first.may_split);
  const Move& second = program.moves[2];
  CHECK_FALSE(second.cycle->first);
  CHECK(second.cycle->bottom_mm == -5);
  CHECK_FALSE(second.cycle->bottom_word.has_value());
  CHECK(second.cycle->may_insert_bottom);
  CHECK(second.end_mm == Vector3(3, 2, 10));
  CHECK(program.moves[3].cycle->bottom_mm == -6);
  CHECK_FALSE(program.moves[4].cycle.has_value());
}

TEST_CASE("G99 leaves the tool at R, G98 at the start of the series, or at R if that is higher") {
  const Program program =
      read("G21 G90 G0 X0 Y0 Z10\nG99 G81 X1 Y2 Z-5 R2 F100\nG98 X3\nG80 G0 Z1\nG98 G82 X5 Z-5 R3 P.5\n");
  CHECK(program.moves[1].end_mm.z() == 2);
  CHECK(program.moves[1].cycle->returns_to_retract);
  CHECK(program.moves[2].end_mm.z() == 10);
  CHECK(program.moves[4].end_mm.z() == 3);
}

TEST_CASE("a cycle that begins at an unknown height leaves Z unknown under G98") {
  const Program program = read("G21 G90 G0 X0 Y0\nG99 G81 X1 Y2 Z-5 R2 F100\nG98 X3\n");
  CHECK(program.moves[1].known_end[2]);
  CHECK_FALSE(program.moves[2].known_end[2]);
}

TEST_CASE("LinuxCNC keeps G98 or G99 of the program before, so a height that differs by them is not known") {
  const auto end_of = [](const std::string& level, const std::string& r, const std::string& dialect) {
    return read("G21 G90" + level + " G0 X0. Y0. Z10.\nG81 X1. Y2. Z-5. R" + r + " F100.\n", dialect)
        .moves[1];
  };
  CHECK_FALSE(end_of("", "2.", "linuxcnc").known_end[2]);
  CHECK_FALSE(end_of("\n/G98\n", "2.", "linuxcnc").known_end[2]);
  CHECK(end_of("", "10.", "linuxcnc").known_end[2]);
  CHECK(end_of(" G98", "2.", "linuxcnc").known_end[2]);
  CHECK(end_of(" G99", "2.", "linuxcnc").end_mm.z() == 2);
  CHECK(end_of("", "2.", "fanuc").end_mm.z() == 10);
  const Program program = read("G21 G90 G0 X0 Y0 Z10\nG81 X1 Y2 Z-5 R2 F100\nX3\n", "linuxcnc");
  CHECK(program.moves[2].handling == Handling::own);
  REQUIRE(program.remarks.size() == 1);
  CHECK(program.remarks[0].what.starts_with("G98 or G99 is not programmed before this cycle"));
}

TEST_CASE("relative cycles and repeats are held") {
  const Program program = read("O1\nG21 G90 G0 X0. Y0. Z10.\nG82 Z-5. R1. F100.\nG91 X2. L3\nY-1.\n");
  CHECK(program.moves[1].handling == Handling::own);
  const Move& row = program.moves[2];
  CHECK(row.handling == Handling::held);
  CHECK(row.cycle->repeats == 3);
  CHECK(row.end_mm == Vector3(6, 0, 10));
  CHECK(row.cycle->bottom_mm == -5);
  CHECK_FALSE(row.cycle->may_insert_bottom);
  CHECK(program.moves[3].end_mm == Vector3(6, -1, 10));
}

TEST_CASE("in a relative cycle R is relative to the start and Z to R") {
  const Program program = read("G21 G90 G0 X0 Y0 Z10\nG91 G81 X1 Z-4 R-7 F100\nG90 G80\n");
  CHECK(program.moves[1].cycle->retract_mm == 3);
  CHECK(program.moves[1].cycle->bottom_mm == -1);
}

TEST_CASE("R under G91 is relative to the start of the series, also behind holes under G98 and G99") {
  const auto last_of = [](const char* dialect, const std::string& level) {
    return read("G21 G90 G0 X1. Y1. Z-50.\nG91\n" + level +
                    " G81 X3. Z-1. R-.5 F300.\nG99 Y4.\nX1. Z-49.5 R-.5\n",
                dialect)
        .moves.back();
  };
  for (const char* level : {"G98", "G99"}) {
    CAPTURE(level);
    for (const char* dialect : {"linuxcnc", "fanuc", "haas"}) {
      CAPTURE(dialect);
      const Move hole = last_of(dialect, level);
      REQUIRE(hole.cycle.has_value());
      CHECK(hole.cycle->retract_mm == -50.5);
      CHECK(hole.cycle->bottom_mm == -100);
      CHECK(hole.end_mm == Vector3(5, 5, -50.5));
      CHECK(hole.known_end[2]);
    }
    // RS274/NGC counts from the height of the tool.
    for (const char* dialect : {"grbl", "mach3"}) {
      CAPTURE(dialect);
      const Move hole = last_of(dialect, level);
      CHECK_FALSE(hole.cycle.has_value());
      CHECK(hole.makes_hole);
      CHECK(hole.known_end == std::array<bool, 3>{true, true, false});
    }
  }
}

TEST_CASE("R under G91 gives no height if Z is unknown where the series begins") {
  for (const char* before : {"G28 Z0\n", "G43 H1\n", "/G43 H1\n", "G55\n"}) {
    CAPTURE(before);
    const Program between =
        read(std::string("G21 G90 G98 G0 X0 Y0 Z10\nG91 G81 X3 Z-1 R-.5 F300\nG99 Y4\n") + before + "X1\n");
    CHECK_FALSE(between.moves.back().cycle.has_value());
    CHECK_FALSE(between.moves.back().known_end[2]);
  }
  const Program program = read("G21 G90 G98 G0 X0 Y0\nG91 G81 X3 Z-1 R-.5 F300\nX4\n");
  CHECK(program.moves[1].makes_hole);
  CHECK(program.moves[2].makes_hole);
  CHECK(program.moves[2].end_mm.x() == 7);
  CHECK(program.left_alone.at(0).why.starts_with("R under G91 is a difference from a height"));
}

TEST_CASE(
    "depths that change from coordinates to differences cannot be shifted, unless they are programmed "
    "again") {
  const std::string start = "G21 G90 G0 X0 Y0 Z10\n", hole = "G81 X1 Y1 Z-2 R.5 F100\n";
  for (const char* turned : {"G91 X.1 L3\n", "G91 X1 Z-3\n", "G91 X1 R-9\n", "G91 G81 X1 Y1\n"}) {
    CAPTURE(turned);
    const Program program = read(start + hole + turned + "X1\nG80\n");
    CHECK(program.moves[2].fixed[2]);
    CHECK_FALSE(program.moves[2].known_end[2]);
    CHECK(program.left_alone.at(0).line == 3);
  }
  CHECK(read(start + "G91 G81 X1 Z-3 R-8\nG90 X5\n").moves[2].fixed[2]);
  CHECK_FALSE(read(start + hole + "G91 X.1 Z-3 R-9 L3\n").moves[2].fixed[2]);
  CHECK_FALSE(read("O1\n" + start + hole + "G91 X1.\n", "fanuc").moves[2].fixed[2]);
}

TEST_CASE("a cycle without holes stores its words and does not move") {
  const Program program = read("O1\nG21 G90 G0 X0. Y0. Z10.\nG81 X7. Z-5. R1. F100. L0\nX2.\n");
  CHECK(program.moves[1].end_mm == Vector3(0, 0, 10));
  CHECK(program.moves[2].end_mm.x() == 2);
  CHECK(program.moves[2].cycle->bottom_mm == -5);
}

TEST_CASE("the position in X and Y is not known behind a cycle without holes") {
  const std::string start = "O1\nG21 G90 G0 X0. Y0. Z10.\nG81 Z-5. R1. F100. ";
  CHECK_FALSE(read(start + "X20. Y50. K0\nX30.\n", "fanuc").moves.back().known_end[1]);
  CHECK(read(start + "X20. Y50. K0\nX30. Y50.\n", "fanuc").moves.back().known_end[1]);
  CHECK(read(start + "X20. L0\nX30.\n", "haas").moves.back().known_end[1]);
}

TEST_CASE("RS274/NGC refuses a cycle without holes") {
  for (const char* dialect : {"linuxcnc", "grbl", "mach3"})
    CHECK(diagnostic_of([&] { read("G21 G90 G0 X0 Y0 Z5\nG81 X5 Z-1 R1 F50 L0\n", dialect); }) ==
          "p.ngc:2:19: error: L0 is not a number of repeats: expected an integer from 1; program Z and R in "
          "the first block with a hole");
}

TEST_CASE("a cycle is not followed if the count of its repeats is not one that a control takes") {
  for (const char* count : {"L10000", "L2.5", "L-1"}) {
    CAPTURE(count);
    const Program program =
        read(std::string("G21 G90 G0 X0 Y0 Z10\nG91 G81 X1 Z-4 R-7 F100 ") + count + "\nX1\n");
    CHECK_FALSE(program.moves[1].known_end[0]);
    CHECK(program.left_alone.at(0).why.find("repeats") != std::string::npos);
  }
}

TEST_CASE("K is a count on a Fanuc, and the least peck on a Haas or beside I and J") {
  const auto ends_at = [](const char* dialect, const char* words) {
    const std::string text =
        std::string("G21 G90 G0 X0. Y0. Z10.\nG91 G83 X1. Z-4. R-7. F100. ") + words + "\n";
    return read(text, dialect).moves[1].end_mm.x();
  };
  CHECK(ends_at("fanuc", "Q1. K2") == 2);
  CHECK(ends_at("fanuc", "I2. J1. K2.") == 1);
  CHECK(ends_at("haas", "Q1. K2.") == 1);
  CHECK(ends_at("haas", "I2. J1. K0.5") == 1);
  CHECK(ends_at("haas", "Q1. L2") == 2);
}

TEST_CASE("a cycle in another plane than G17 is not followed, and Z is unknown behind it") {
  for (const char* hole : {"G18 G99 G81 X1 Z2 Y-14 R-2", "G19 G98 G81 X-14 Y1 Z2 R-2",
                           "G18 G99 G91 G81 X1 Y-14 R-2", "G81 X1 Y1 Z2 R3\nG18 X3"}) {
    CAPTURE(hole);
    const Program program = read(std::string("G21 G90 G0 X0 Y0 Z10\n") + hole + " F100\nG90 G17 G1 X5\n");
    const Move &before_last = program.moves[program.moves.size() - 2], &last = program.moves.back();
    CHECK_FALSE(before_last.cycle.has_value());
    CHECK_FALSE(last.known_start[2]);
    CHECK_FALSE(last.known_start[hole[2] == '9' ? 0 : 1]);
    CHECK(program.left_alone.at(0).why == "cycles are corrected in G17 only");
  }
}

TEST_CASE("a cycle with an expression is fixed") {
  const Program program = read("G21 G90 G0 X0 Y0 Z10\nG81 X[1+2] Y2 Z-5 R2 F100\nX3 Z#1\n");
  CHECK(program.moves[1].fixed[0]);
  CHECK_FALSE(program.moves[1].known_end[0]);
  CHECK(program.moves[2].fixed[2]);
  CHECK_FALSE(program.moves[2].cycle.has_value());
  CHECK(program.moves[2].makes_hole);
}

TEST_CASE("after a hole that is not followed, the initial height of its series is unknown") {
  const std::string text = "G21 G90\nG0 X0. Y0. Z5.\nG81\nX10. Y0. Z5.\nG80\nX10.\n";
  const Program program = read(text, "fanuc");
  CHECK_FALSE(program.moves.back().known_end[2]);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}

TEST_CASE("after a change of work offset between holes the initial height of their series is unknown") {
  const std::string text = "G21 G90\nG0 X0. Y0. Z5.\nG81 X10. Z-5. R2.\nX20. G55\nG80\nG0 X10. Y10.\n";
  const Program program = read(text, "grbl");
  CHECK_FALSE(program.moves.back().known_end[2]);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
}

TEST_CASE("a depth that was programmed in a block that may not run is not repeated in later holes") {
  const std::string start = "G21 G90\nG0 X0. Y0. Z5.\nG81 X10. Z-5. R2.\n", end = "X30.\nX40. Z-7.\nX50.\n";
  for (const std::string hole : {"/ X20. Z-6.\n", "X#1 Z-6.\n"}) {
    const std::string text = start + hole + end;
    CAPTURE(text);
    const Program program = read(text);
    REQUIRE(program.moves.size() == 6);
    CHECK_FALSE(program.moves[3].cycle->may_insert_bottom);
    CHECK(program.moves[5].cycle->may_insert_bottom);
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  }
}

TEST_CASE("every drilling code is a cycle, G76 of linuxcnc is a thread") {
  for (const char* g : {"G73", "G74", "G76", "G81", "G82", "G83", "G84", "G85", "G86", "G87", "G88", "G89",
                        "G84.2", "G84.3"}) {
    CAPTURE(g);
    const Program program = read(std::string("O1\nG21 G0 X0. Y0. Z5.\n") + g + " X1. Z-1. R1. F100.\nX2.\n");
    CHECK(program.moves.at(2).cycle.has_value());
  }
  CHECK(read("G21 G0 X0 Y0 Z5\nG76 Z-1 P1 I-1 J.1 K.5\n").moves.at(1).handling == Handling::held);
}
