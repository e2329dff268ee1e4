// Feeds and spindle speeds of Klartext; 0 is unknown.
#include <doctest/doctest.h>

#include <utility>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using KlartextSpeeds = std::pair<double, double>;

/// Feed (mm/min) and spindle speed (1/min) of the last of `blocks`, which is a move.
KlartextSpeeds klartext_speeds(std::vector<std::string> blocks, bool evaluate = false) {
  blocks.insert(blocks.begin(), {"TOOL CALL 1 Z S2000 F500", "L X+0 Y+0 Z+0 R0 FMAX M3", "L X+1 R0 F500"});
  ReadOptions options;
  options.evaluate = evaluate;
  const Program program = read_program(klartext(blocks), "p.h", options);
  return {program.moves.back().feed_mm_min, program.moves.back().spindle_rpm};
}

}  // namespace

TEST_CASE("klartext: TOOL CALL sets the speed, or makes it unknown") {
  const std::string move = "L X+5";
  CHECK(klartext_speeds({"TOOL CALL S4000", move}).second == 4000);
  CHECK(klartext_speeds({"TOOL CALL SQ7", move}).second == 0);
  CHECK(klartext_speeds({"Q7 = +6000", "TOOL CALL SQ7", move}, true).second == 6000);
  CHECK(klartext_speeds({"TOOL CALL SQ7", move}, true).second == 0);
  CHECK(klartext_speeds({"TOOL CALL SQL7", move}).second == 0);
  CHECK(klartext_speeds({"TOOL CALL 5 Z S(VC = 120)", move}).second == 0);
  CHECK(klartext_speeds({"TOOL CALL Q5 Z S3000", move}).second == 3000);
  CHECK(klartext_speeds({"TOOL CALL Q5 S3000", move}).second == 3000);
  CHECK(klartext_speeds({"TOOL CALL QS5 Z S3000", move}).second == 3000);
  CHECK(klartext_speeds({"TOOL CALL \"S9 F8\" Z S3000 F200", "L X+5 F AUTO"}) == KlartextSpeeds{200, 3000});
  CHECK(klartext_speeds({"TOOL CALL 5 Z S3000 DL+0.1 DR-0.2 DR2+Q3", move}) == KlartextSpeeds{500, 3000});
  CHECK(klartext_speeds({"TOOL CALL 5 Z S3000~\n  F200", move}) == KlartextSpeeds{200, 3000});
}

TEST_CASE("klartext: TOOL CALL sets the feed, per minute or per turn, or makes it unknown") {
  const std::string move = "L X+5 R0 F AUTO";
  CHECK(klartext_speeds({"TOOL CALL S4000 F300", move}).first == 300);
  CHECK(klartext_speeds({"TOOL CALL S4000 FZ0.02", move}).first == 0);
  CHECK(klartext_speeds({"TOOL CALL S4000 FU0.1", move}).first == doctest::Approx(400));
  CHECK(klartext_speeds({"TOOL CALL FU0,1", "TOOL CALL S4000", move}).first == doctest::Approx(400));
  CHECK(klartext_speeds({"TOOL CALL S4000 FQ3", move}).first == 0);
  CHECK(klartext_speeds({"Q3 = +250", "TOOL CALL FQ3", move}, true).first == 250);
  CHECK(klartext_speeds({"TOOL CALL S4000 F300", "L X+4 F100 M136", move}).first == 0);
  CHECK(klartext_speeds({"TOOL CALL FUQ3", move}).first == 0);
}

TEST_CASE("klartext: a feed per turn follows the speed") {
  CHECK(klartext_speeds({"L X+4 FU0.1", "TOOL CALL S4000", "L X+5"}).first == doctest::Approx(400));
  CHECK(klartext_speeds({"L X+4 F0.1 M136", "L X+5"}).first == doctest::Approx(200));
  CHECK(klartext_speeds({"L X+4 F0.1 M136", "L X+5 M137"}).first == 0);
  CHECK(klartext_speeds({"TOOL CALL SQ7", "L X+4 FU0.1", "L X+5"}).first == 0);
}

TEST_CASE("klartext: F behind M103, M128 and M140 is not the feed of the path") {
  CHECK(klartext_speeds({"L X+4 F300 M128 F1000", "M129", "L X+5"}).first == 300);
  CHECK(klartext_speeds({"L X+4 F300 M140 MB10 F50", "L X+5"}).first == 300);
  CHECK(klartext_speeds({"L X+4 F300 M103 F20", "L X+5"}).first == 0);
  CHECK(klartext_speeds({"L X+4 F300 M103 F20", "L X+4 M103", "L X+5"}).first == 300);
}

TEST_CASE("klartext: a feed and a speed are unknown behind calls and blocks that are not read") {
  for (const std::string block :
       {"CALL PGM A.H", "FUNCTION S-PULSE P-TIME10 SCALE5", "L X+4 F300 QUICK", "CALL LBL 4"}) {
    CAPTURE(block);
    CHECK(klartext_speeds({block, "L X+5"}) == KlartextSpeeds{0, 0});
    CHECK(klartext_speeds({block, "TOOL CALL S3000", "L X+5 F200"}) == KlartextSpeeds{200, 3000});
  }
}

TEST_CASE("klartext: a spindle that may be off has no speed until M3, M4, M13 or M14") {
  CHECK(klartext_speeds({"L X+4 M5"}).second == 2000);
  CHECK(klartext_speeds({"L X+4 M5", "L X+5"}).second == 0);
  CHECK(klartext_speeds({"M5", "L X+5"}).second == 0);
  CHECK(klartext_speeds({"M5", "TOOL CALL S3000", "L X+5 M3"}).second == 3000);
  CHECK(klartext_speeds({"M5", "M13", "L X+5"}).second == 2000);
  CHECK(klartext_speeds({"/ M5", "L X+5"}).second == 0);
}

TEST_CASE("klartext: a block with FT, the time of all of it, stays whole") {
  const auto last = [](const std::string& block) {
    return read_program(klartext({"TOOL CALL 1 Z S2000", "L X+0 Y+0 Z+0 R0 FMAX M3", block}), "p.h", {})
        .moves.back();
  };
  CHECK(last("L X+5 F500").may_split);
  CHECK_FALSE(last("L X+5 FT10").may_split);
  CHECK(last("L X+5 FT10").stays_whole);
}
