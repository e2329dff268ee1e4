// Feeds and spindle speeds of a Sinumerik that have names or expressions; 0 is unknown.
#include <doctest/doctest.h>

#include <optional>
#include <utility>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using SiemensSpeeds = std::pair<double, double>;

Program siemens_speed_program(const std::string& lines, bool evaluate) {
  ReadOptions options;
  options.dialect = "siemens";
  options.evaluate = evaluate;
  const std::string head = "G71 G90 G17 G94\nG54\nS8000 M3\nG0 X0 Y0 Z0\nG1 X1 F500\n";
  return read_program(head + lines, "p.mpf", options);
}

/// Feed (mm/min) and spindle speed (1/min) of a move behind `lines`.
SiemensSpeeds behind_siemens(const std::string& lines, bool evaluate = false) {
  const Program program = siemens_speed_program(lines + "G1 X9\n", evaluate);
  return {program.moves.back().feed_mm_min, program.moves.back().spindle_rpm};
}

/// Feeds of the moves behind the first two.
std::vector<double> siemens_feeds(const std::string& lines, bool evaluate = false) {
  const Program program = siemens_speed_program(lines, evaluate);
  std::vector<double> feeds;
  for (std::size_t i = 2; i < program.moves.size(); ++i) feeds.push_back(program.moves[i].feed_mm_min);
  return feeds;
}

/// Feed (mm/min) of G1 X2 behind `lines`, on a control whose basic system is `unit`.
double siemens_feed_in(const std::string& lines, std::optional<LengthUnit> unit) {
  ReadOptions options;
  options.dialect = "siemens";
  options.unit = unit;
  const std::string program = lines + "G90 G17 G94 G54\nG0 X0 Y0 Z0\nG1 X1 F600\nX2\nX3 F600\n";
  return read_program(program, "p.mpf", options).moves.back().feed_mm_min;
}

}  // namespace

TEST_CASE("siemens: G70 and G71 set the unit of lengths, G700 and G710 that of F, too") {
  constexpr LengthUnit mm_min = LengthUnit::millimetres, inch_min = LengthUnit::inches;
  constexpr double inches = 600 * 25.4;
  CHECK(siemens_feed_in("G70\n", mm_min) == 600);
  CHECK(siemens_feed_in("G71\n", mm_min) == 600);
  CHECK(siemens_feed_in("G700\n", mm_min) == doctest::Approx(inches));
  CHECK(siemens_feed_in("G710\n", inch_min) == 600);
  CHECK(siemens_feed_in("G70\n", inch_min) == doctest::Approx(inches));
  CHECK(siemens_feed_in("G71\n", inch_min) == doctest::Approx(inches));
  CHECK(siemens_feed_in("G70\nG700\n", mm_min) == doctest::Approx(inches));
  CHECK(siemens_feed_in("G700\nG70\n", mm_min) == 600);
  CHECK(siemens_feed_in("G700\n", std::nullopt) == doctest::Approx(inches));
  CHECK(siemens_feed_in("G71\n", std::nullopt) == 600);
  CHECK(siemens_feed_in("G70\n", std::nullopt) == 0);
}

TEST_CASE("siemens: a speed that is an expression is unknown, or its value with --evaluate") {
  for (const std::string lines : {"R2=4000\nS=R2\n", "S=1000*4\n", "R2=4000\nX2 S=R2\n"}) {
    CAPTURE(lines);
    CHECK(behind_siemens(lines).second == 0);
    CHECK(behind_siemens(lines, true).second == 4000);
  }
  CHECK(behind_siemens("S=R2\nS=3000\n").second == 3000);
  CHECK(behind_siemens("S=R7\n", true).second == 0);
}

TEST_CASE("siemens: the speed of a numbered spindle is that of the tool if SETMS makes it the main one") {
  CHECK(behind_siemens("S1=4000\n").second == 0);
  CHECK(behind_siemens("S2=4000\n").second == 0);
  CHECK(behind_siemens("SETMS(1)\nS3000\nS1=4000\n").second == 4000);
  CHECK(behind_siemens("SETMS(1)\nS3000\nS2=4000\n").second == 3000);
  CHECK(behind_siemens("SETMS(1)\nR1=4000\nS1=R1\n").second == 0);
  CHECK(behind_siemens("SETMS(1)\nR1=4000\nS1=R1\n", true).second == 4000);
  CHECK(behind_siemens("SETMS(2)\n").second == 0);
  CHECK(behind_siemens("SETMS(2)\nS3000\n").second == 3000);
  CHECK(behind_siemens("SETMS(1)\nSETMS\nS1=4000\n").second == 0);
  CHECK(behind_siemens("SETMS(1)\nS3000\n/ SETMS(2)\nS2000\nS1=4000\n").second == 0);
  CHECK(behind_siemens("S1=4000\nS3000\n").second == 3000);
  CHECK(behind_siemens("G4 S2=40\n").second == 8000);
  CHECK(behind_siemens("SETMS(1)\nS3000\n/ S1=4000\n").second == 0);
}

TEST_CASE("siemens: M1=5 stops the main spindle, and SPOS= positions it") {
  CHECK(behind_siemens("M1=5\n").second == 0);
  CHECK(behind_siemens("M1=5\nM1=3\n").second == 0);
  CHECK(behind_siemens("SETMS(1)\nS3000\nM1=5\nM1=3\n").second == 3000);
  CHECK(behind_siemens("SETMS(1)\nS3000\nM2=5\n").second == 3000);
  CHECK(behind_siemens("M1=3\n").second == 8000);
  CHECK(behind_siemens("M1=8\n").second == 8000);
  CHECK(behind_siemens("SPOS=90\n").second == 0);
  CHECK(behind_siemens("SPOS=90\nM3\n").second == 8000);
}

TEST_CASE("siemens: FB= is the feed of its block alone") {
  CHECK(siemens_feeds("X2 FB=100\nX3\n") == std::vector<double>{100, 500});
  CHECK(siemens_feeds("G2 X2 Y1 CR=2 FB=100\nG1 X3\nX4\n") == std::vector<double>{100, 500, 500});
  CHECK(siemens_feeds("X2 FB=R1\nX3\n") == std::vector<double>{0, 500});
  CHECK(siemens_feeds("R1=100\nX2 FB=R1\nX3\n", true) == std::vector<double>{100, 500});
}

TEST_CASE("siemens: FZ=, OVR= and SVC= leave feed and speed unknown until they end") {
  CHECK(siemens_feeds("X2 FZ=0.02\nX3\nX4 F100\n") == std::vector<double>{0, 0, 100});
  CHECK(behind_siemens("OVR=20\n").first == doctest::Approx(100));
  CHECK(behind_siemens("OVR=20\nF1000\n").first == doctest::Approx(200));
  CHECK(behind_siemens("OVR=20\nOVR=100\n").first == 500);
  CHECK(behind_siemens("OVR=R1\nF1000\n").first == 0);
  CHECK(behind_siemens("/ OVR=20\nF1000\n").first == 0);
  CHECK(behind_siemens("SVC=100\n") == SiemensSpeeds{500, 0});
  CHECK(behind_siemens("SVC=100\nS2000\n").second == 2000);
}

TEST_CASE("siemens: G96 and G97 have the feed per turn, G961 and G971 that per minute") {
  CHECK(behind_siemens("G96 S100 F0.1\n") == SiemensSpeeds{0, 0});
  CHECK(behind_siemens("G96 S100 F0.1\nG97 S2000\n").first == doctest::Approx(200));
  CHECK(behind_siemens("G961 S100 F300\n") == SiemensSpeeds{300, 0});
  CHECK(behind_siemens("G961 S100 F300\nS50\nG971\n") == SiemensSpeeds{300, 0});
  CHECK(behind_siemens("G96 S100\nG94 F300\nS2000\n") == SiemensSpeeds{300, 2000});
}

TEST_CASE("siemens: a feed and a speed beside text that is not read are unknown") {
  CHECK(behind_siemens("X2 F100 S2000 _WORD=5\n") == SiemensSpeeds{0, 0});
  CHECK(behind_siemens("X2 _WORD=5\n") == SiemensSpeeds{0, 0});
  CHECK(behind_siemens("X2 F100 FLIN\n") == SiemensSpeeds{0, 0});
  CHECK(behind_siemens("IF R1==1\nS2000 F100\nENDIF\n") == SiemensSpeeds{0, 0});
}

TEST_CASE("siemens: F is not the feed of the path while FGROUP names some of X, Y and Z") {
  CHECK(behind_siemens("FGROUP(X)\n").first == 0);
  CHECK(behind_siemens("FGROUP(X,Y)\nF300\n").first == 0);
  CHECK(behind_siemens("FGROUP(X)\nFGROUP()\n").first == 500);
  CHECK(behind_siemens("FGROUP(X)\nFGROUP( X , Y,Z,C)\nF300\n").first == 300);
  CHECK(behind_siemens("/FGROUP(X)\n").first == 0);
}
