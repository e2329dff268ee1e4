// Feeds and spindle speeds that the text gives, and those that it leaves unknown (0).
#include <doctest/doctest.h>

#include <utility>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using FeedAndSpeed = std::pair<double, double>;

constexpr double speed_before = 8000, feed_before = 500;

/// Feed (mm/min) and spindle speed (1/min) of a move behind `lines`.
FeedAndSpeed behind(const std::string& lines, const std::string& dialect = "linuxcnc") {
  const std::string start = "G21 G90 G94 G17\nG54\nS8000 M3\nG0 X0. Y0. Z0.\nG1 X1. F500\n";
  const Program program = read(start + lines + "G1 X9.\n", dialect);
  return {program.moves.back().feed_mm_min, program.moves.back().spindle_rpm};
}

}  // namespace

TEST_CASE("a feed and a speed that a '/' block sets are unknown until another block sets them") {
  CHECK(behind("/ F1000\n") == FeedAndSpeed{0, speed_before});
  CHECK(behind("/ S2000\n") == FeedAndSpeed{feed_before, 0});
  CHECK(behind("/ G1 X2. F1000 S2000\n") == FeedAndSpeed{0, 0});
  CHECK(behind("/ F500 S8000\n") == FeedAndSpeed{feed_before, speed_before});
  CHECK(behind("/ F1000 S2000\nF200\n") == FeedAndSpeed{200, 0});
  CHECK(behind("/ F1000 S2000\nX3. F200 S3000\n") == FeedAndSpeed{200, 3000});
  CHECK(behind("/ G96 S100\nS2000\n").second == 0);
  CHECK(behind("/ G96 S100\nG97 S2000\n").second == 2000);
}

TEST_CASE("a feed is unknown while its unit is") {
  CHECK(behind("/ G95\nF0.1\n").first == 0);
  CHECK(behind("/ G95\nG94 F100\n").first == 100);
  CHECK(behind("/ G20\nF5\n").first == 0);
}

TEST_CASE("a feed and a speed that one path through a condition or a loop sets are unknown behind it") {
  CHECK(behind("o1 if [#1 GT 0]\nF1000 S2000\no1 endif\n") == FeedAndSpeed{0, 0});
  CHECK(behind("o1 if [#1 GT 0]\nF200\no1 else\nF300\no1 endif\n") == FeedAndSpeed{0, speed_before});
  CHECK(behind("WHILE [#1 LT 5] DO1\nS2000\nEND1\n", "fanuc") == FeedAndSpeed{feed_before, 0});
}

TEST_CASE("a feed and a speed are unknown behind a called subprogram, M72 and text that is not read") {
  for (const auto& of : {std::pair{"M98 P100\n", "fanuc"},
                         {"G65 P9010 F3. S4.\n", "fanuc"},
                         {"G66 P9010 F3.\nG67\n", "fanuc"},
                         {"G[#1]\n", "linuxcnc"},
                         {"o<cut> call [1]\n", "linuxcnc"},
                         {"M70\nM72\n", "linuxcnc"}}) {
    const std::string lines = of.first, dialect = of.second;
    CAPTURE(lines);
    CHECK(behind(lines, dialect) == FeedAndSpeed{0, 0});
    CHECK(behind(lines + "G21 G94 F200 S3000\n", dialect) == FeedAndSpeed{200, 3000});
  }
}

TEST_CASE("S is a cutting speed from G96 to G97, and a limit beside G92 of a Fanuc") {
  CHECK(behind("G96 S100\n").second == 0);
  CHECK(behind("G96 S100\nS150\n").second == 0);
  CHECK(behind("G96 S100\nG97\n").second == 0);
  CHECK(behind("G96 S100\nG97 S2000\n").second == 2000);
  CHECK(behind("G92 S9000\n", "fanuc").second == 0);
}

TEST_CASE("a spindle that may be off has no speed until M3 or M4") {
  CHECK(behind("M5\n").second == 0);
  CHECK(behind("M5\nS2000\n").second == 0);
  CHECK(behind("M5\nM3\n").second == speed_before);
  CHECK(behind("M5\nS2000 M4\n").second == 2000);
  CHECK(behind("M19\n").second == 0);
  CHECK(behind("/ M5\n").second == 0);
  CHECK(behind("M5\n/ M3\n").second == 0);
  CHECK(read("G21 G90 S8000 M3\nG1 X1 F500\nX2 M5\n").moves.back().spindle_rpm == speed_before);
}

TEST_CASE("F of a thread is a lead, except on LinuxCNC") {
  for (const char* const dialect : {"fanuc", "haas"}) {
    CAPTURE(dialect);
    CHECK(behind("G33 X3. F2.\nG1 X4.\n", dialect).first == 0);
    CHECK(behind("G33 X3. K2.\nX4. F2.\nG1 X4.\n", dialect).first == 0);
    CHECK(behind("G33 X3. F2.\nG1 X4. F300\n", dialect).first == 300);
  }
  const auto siemens = [](const std::string& lines) {
    const Program program = read("G71 G90 G94 G17\nG0 X0 Y0 Z0\nG1 X1 F500\n" + lines, "siemens");
    return program.moves.back().feed_mm_min;
  };
  CHECK(siemens("G34 X3 K2 F0.1\nG1 X4\n") == 0);
  CHECK(siemens("G33 X3 K2\nG1 X4\n") == 500);
  CHECK(behind("G33 X3 K2 F300\nG1 X4\n").first == 300);
}
