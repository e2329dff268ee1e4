// Blocks that '/' or a jump may skip.
#include <doctest/doctest.h>

#include <algorithm>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// `block` behind '/', and in a stretch that a jump may skip.
std::vector<std::string> maybe(const std::string& block) {
  return {"/" + block, "FN 9: IF +Q1 EQU +0 GOTO LBL 7\n" + block + "\nLBL 7"};
}

Program read_blocks(const std::string& blocks) {
  return read("BEGIN PGM A MM\n" + blocks + "END PGM A MM\n", "heidenhain");
}

}  // namespace

TEST_CASE("klartext: coordinates that a block may have reset are unknown until a block surely states them") {
  for (const auto& [set, reset] : {std::pair{"CYCL DEF 10.1 ROT+30", "CYCL DEF 10.1 ROT+0"},
                                   {"CYCL DEF 10.1 ROT+0", "CYCL DEF 10.1 IROT+30"},
                                   {"CYCL DEF 8.1 Y", "CYCL DEF 8.1"},
                                   {"CYCL DEF 11.1 SCL 0.99", "CYCL DEF 11.1 SCL 1"},
                                   {"CYCL DEF 19.1 A+30 B+0 C+0", "CYCL DEF 19.1 A+0 B+0 C+0"},
                                   {"CYCL DEF 7.1 Y+500", "CYCL DEF 7.1 Y+0"},
                                   {"CYCL DEF 247 Q339=+1", "CYCL DEF 247 Q339=+2"},
                                   {"CYCL DEF 7.1 Y+500", "CYCL DEF 247 Q339=+1"},
                                   {"TRANS DATUM AXIS Y+500", "TRANS DATUM RESET"},
                                   {"M128", "M129"},
                                   {"PLANE SPATIAL SPA+30 SPB+0 SPC+0 STAY", "PLANE RESET STAY"}}) {
    for (const std::string& doubtful : maybe(reset)) {
      CAPTURE(doubtful);
      const std::string begin = std::string(set) + "\n" + doubtful + "\n";
      const Program program = read_blocks(begin + "L X+0 Y+0 Z+50 R0 FMAX\nL X+10 F100\n");
      CHECK(std::none_of(program.moves.begin(), program.moves.end(),
                         [](const Move& move) { return move.known_end[0] && !move.fixed[0]; }));
    }
  }
  const Program stated = read_blocks(
      "CYCL DEF 10.1 ROT+30\n/CYCL DEF 10.1 ROT+0\nCYCL DEF 10.1 ROT+20\nL X+0 Y+0 Z+50 R0 FMAX\nL X+10 "
      "F100\n");
  CHECK(all_known(stated.moves.back().known_start));
  CHECK(stated.frames.at(stated.moves.back().frame).turn_rad == doctest::Approx(0.34907).epsilon(1e-4));
  const Program unchanged = read_blocks("/CYCL DEF 10.1 ROT+0\nL X+0 Y+0 Z+50 R0 FMAX\nL X+10 F100\n");
  CHECK(all_known(unchanged.moves.back().known_start));
  const Program again = read_blocks(
      "CYCL DEF 247 Q339=+1\n/CYCL DEF 247 Q339=+2\nCYCL DEF 247 Q339=+1\nL X+0 Y+0 Z+50 R0 FMAX\nL X+10\n");
  CHECK(all_known(again.moves.back().known_start));
}

TEST_CASE("klartext: a tool, a feed and a speed that may not be set are unknown") {
  for (const std::string& doubtful : maybe("TOOL CALL 2 Z S2000 F300")) {
    CAPTURE(doubtful);
    const std::string begin = "TOOL CALL 1 Z S1000 F100\n" + doubtful + "\nL X+0 Y+0 Z+0\n";
    const Move move = read_blocks(begin).moves.back();
    CHECK(move.tool == 0);
    CHECK_FALSE(move.tool_in_spindle);
    CHECK(move.spindle_rpm == 0);
    CHECK(move.feed_mm_min == 0);
    CHECK(read_blocks(begin + "TOOL CALL 1 Z S1000 F100\nL X+1 Y+0 Z+0\n").moves.back().tool == 1);
  }
  CHECK(read_blocks("TOOL CALL 1 Z S1000\n/TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0\n").moves.back().tool == 1);
}

TEST_CASE("klartext: after M136 or M137 that may not run the unit of F is unknown until one of them runs") {
  for (const char* code : {"M136", "L X+5 M136"})
    for (const std::string& doubtful : maybe(code)) {
      CAPTURE(doubtful);
      const std::string begin = "TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 F100\n" + doubtful + "\nL X+10 F0.2\n";
      CHECK(read_blocks(begin).moves.back().feed_mm_min == 0);
      CHECK(read_blocks(begin + "L X+20 F500\n").moves.back().feed_mm_min == 0);
      CHECK(read_blocks(begin + "M136\nL X+20 F0.5\n").moves.back().feed_mm_min == doctest::Approx(500));
      CHECK(read_blocks(begin + "M137\nL X+20 F50\n").moves.back().feed_mm_min == doctest::Approx(50));
    }
  for (const std::string& doubtful : maybe("M137")) {
    CAPTURE(doubtful);
    const std::string begin = "TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 F100\n";
    CHECK(read_blocks(begin + doubtful + "\nL X+5 F200\n").moves.back().feed_mm_min == 200);
    CHECK(read_blocks(begin + "M136\n" + doubtful + "\nL X+5 F200\n").moves.back().feed_mm_min == 0);
  }
}

TEST_CASE("klartext: a preset ends the shift, the mirror image, the rotation and the scales before it") {
  const auto is_known = [](const std::string& before) {
    CAPTURE(before);
    const Program program =
        read_blocks(before + "\nCYCL DEF 247 Q339=+1\nL X+0 Y+0 Z+50 R0 FMAX\nL X+10 F100\n");
    const Move& last = program.moves.back();
    const ProgramFrame& frame = program.frames.at(last.frame);
    return all_known(last.known_start) && !last.fixed[0] && frame.origin_mm.isZero(0) && frame.turn_rad == 0;
  };
  for (const char* before :
       {"CYCL DEF 7.1 Y+Q5", "CYCL DEF 7.1 C+30", "CYCL DEF 8.1 Y", "CYCL DEF 10.1 ROT+Q1",
        "CYCL DEF 11.1 SCL 0.99", "CYCL DEF 26.1 X1.01", "TRANS DATUM AXIS Y+500", "TRANS MIRROR AXIS X",
        "CYCL DEF 247 Q339=+1", "CYCL DEF 7.1 Y+500\nCYCL DEF 10.1 ROT+30"}) {
    CHECK(is_known(before));
    for (const std::string& doubtful : maybe(before)) CHECK(is_known(doubtful));
  }
  CHECK(is_known("CYCL DEF 7.1 Y+500\n/CYCL DEF 7.1 Y+0"));
  CHECK(is_known("CYCL DEF 7.1 Y+500\n/CYCL DEF 247 Q339=+2"));
  for (const char* before : {"CYCL DEF 19.1 A+30 B+0 C+0", "PLANE SPATIAL SPA+30 SPB+0 SPC+0 STAY", "M128",
                             "CYCL DEF 247 Q339=+2", "FN 17: SYSWRITE ID210 NR4 = +1"})
    CHECK_FALSE(is_known(before));
}

TEST_CASE("klartext: a pole that may not be set is unknown until the next CC") {
  for (const std::string& doubtful : maybe("CC X+0 Y+75")) {
    CAPTURE(doubtful);
    const std::string begin = "CC X+0 Y+0\n" + doubtful + "\nL X-100 Y+0 Z+0 F100\n";
    CHECK_FALSE(read_blocks(begin + "C X+100 Y+0 DR-\n").moves.back().arc);
    CHECK(read_blocks(begin + "CC X+0 Y+0\nC X+100 Y+0 DR-\n").moves.back().arc);
    CHECK(read_blocks(begin + "CP IPA-90 DR-\n").moves.back().fixed[0]);
    CHECK(read_blocks(begin + "LP PR+10 PA+0\n").moves.back().fixed[0]);
  }
  const Program relative =
      read_blocks("L X+0 Y+0 Z+0 F100\nCC X+0 Y+0\nLP PR+30 PA+10\n/LP PR+40 PA+20\nLP IPR+1 IPA+5\n");
  CHECK(relative.moves.back().fixed[0]);
}

TEST_CASE("klartext: under M89 a definition that may not run does not end the calls") {
  const std::string begin =
      "CYCL DEF 200 DRILLING Q200=2 Q201=-20 Q203=+0 Q204=50\nL X+0 Y+0 Z+60 R0 FMAX M3\n";
  for (const std::string& doubtful : maybe("CYCL DEF 201 REAMING Q200=2 Q203=+0 Q204=50")) {
    CAPTURE(doubtful);
    const Program program =
        read_blocks(begin + "L X+10 Y+10 FMAX M89\n" + doubtful + "\nL X+20 FMAX\nL Y+5\n");
    CHECK(program.moves.at(2).fixed[2]);
    CHECK_FALSE(program.moves.at(2).known_end[2]);
    CHECK(program.moves.at(3).fixed[2]);
  }
  for (const char* doubtful : {"/L X+10 Y+10 FMAX M89\n", "L X+10 Y+10 FMAX M89\n/L X+15 M99\n"}) {
    const Move move = read_blocks(begin + doubtful + "L X+20 Y+20 FMAX\n").moves.back();
    CHECK(move.fixed[2]);
    CHECK_FALSE(move.known_end[2]);
  }
}

TEST_CASE("klartext: a program is read behind an end that may be skipped") {
  for (const char* end : {"M30", "L X+1 M2"})
    for (const std::string& doubtful : maybe(end)) {
      CAPTURE(doubtful);
      const Program program =
          read_blocks("L X+0 Y+0 Z+0 F100\n" + doubtful + "\nL X+5 Y+6 Z+7\nL X+8\nM30\nL X+9\n");
      CHECK(program.moves.back().end_mm == Vector3(8, 6, 7));
      CHECK(all_known(program.moves.back().known_start));
    }
  const Program expanded = expanded_klartext(
      klartext({"L X+0 Y+0 Z+5 FMAX", "/ M30", "CALL LBL 1", "M30", "LBL 1", "L IX+1 F100", "LBL 0"}));
  CHECK(expanded.expansion.calls == 1);
  CHECK(expanded.moves.back().end_mm == Vector3(1, 0, 5));
}
