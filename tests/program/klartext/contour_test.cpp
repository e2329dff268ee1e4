#include <doctest/doctest.h>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext: a contour under RL is one group from the move above its plunge to its retraction") {
  const Program program = read(klartext({"L X+50 Y-7 R0 FMAX", "L Z+2 FMAX", "L Z-10 F200", "L Y+2 RL",
                                         "L X+7", "L Y-7 R0", "L Z+2 FMAX", "L X+51 Y+62 FMAX"}));
  std::vector<int> groups;
  for (const Move& move : program.moves) groups.push_back(move.group);
  CHECK(groups == std::vector<int>{1, 1, 1, 1, 1, 1, 1, 0});
  CHECK(program.moves[3].handling == Handling::group);
  CHECK(program.moves[7].handling == Handling::own);
}

TEST_CASE("klartext: moves beside a contour know the side of the cutter") {
  constexpr auto none = CutterSide::none, left = CutterSide::left, right = CutterSide::right;
  const auto sides_of = [](const std::vector<std::string>& lines) {
    std::vector<CutterSide> sides;
    for (const Move& move : read(klartext(lines)).moves) sides.push_back(move.cutter_side);
    return sides;
  };
  using Sides = std::vector<CutterSide>;
  CHECK(sides_of({"L X+50 Y-7 Z+2 R0 FMAX", "L Y+2 RL F200", "L X+7", "L X+5 Y+9", "L Y-7 R0"}) ==
        Sides{none, none, left, left, none});
  CHECK(sides_of({"L X+50 Y-7 Z+2 R0 FMAX", "L Y+2 RR F200", "L X+7 RR", "L X+5 Y+9 RR", "L Y-7 R0"}) ==
        Sides{none, none, right, right, none});
  CHECK(sides_of({"L X+120 Y+0 Z+1 R0 FMAX", "APPR LCT X+45 Y+0 R20 RL F220", "L X+45 Y-18", "L X+18 Y-45",
                  "DEP LCT X+120 Y+0 R20"}) == Sides{none, none, left, left, none});
}

TEST_CASE("klartext: a contour is shifted with its polar arcs") {
  const Program program = read(
      klartext({"L X+10 Y+0 Z+5 FMAX", "L X+9 RL F100", "CC X+4 Y+0", "CP IPA+90 DR+", "L X+3", "L Y-7 R0"}));
  CHECK(program.moves[2].handling == Handling::group);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+10.5 Y-0.25 Z+5.125 FMAX", "L X+9.5 RL F100", "CC X+4.5 Y-0.25", "CP IPA+90 DR+",
                  "L X+3.5", "L Y-7.25 R0"}));
}

TEST_CASE("klartext: APPR and DEP are shifted with the contour between them") {
  const std::string text =
      klartext({"L X+120 Y+0 Z+1 R0 FMAX", "L Z-10 F100", "APPR LCT X+45 Y+0 R20 RL F220", "L X+45 Y-18",
                "RND R4", "L X+18 Y-45", "DEP LCT X+120 Y+0 R20", "L Z+1 R0 FMAX", "L X+150 FMAX"});
  const Program program = read(text);
  REQUIRE(program.moves.size() == 8);
  std::vector<int> groups;
  for (const Move& move : program.moves) groups.push_back(move.group);
  CHECK(groups == std::vector<int>{1, 1, 1, 1, 1, 1, 1, 0});
  CHECK(program.moves[2].end_mm == Vector3(45, 0, -10));
  CHECK(program.moves[2].feed_mm_min == 220);
  CHECK_FALSE(all_known(program.moves[2].known_start));
  CHECK(all_known(program.moves[3].known_start));
  CHECK(program.moves[6].start_mm == Vector3(120, 0, -10));
  CHECK(program.left_alone.at(0).why == "APPR is shifted with its contour; its path is not computed");
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+120.5 Y-0.25 Z+1.125 R0 FMAX", "L Z-9.875 F100", "APPR LCT X+45.5 Y-0.25 R20 RL F220",
                  "L X+45.5 Y-18.25", "RND R4", "L X+18.5 Y-45.25", "DEP LCT X+120.5 Y-0.25 R20",
                  "L Z+1.125 R0 FMAX", "L X+150.5 FMAX"}));
}

TEST_CASE("klartext: the end of a DEP without a point is unknown, the contour before it is known") {
  const Program program = read(klartext({"L X+20 Y+0 Z+1 FMAX", "APPR LT X+45 Y+0 Z-5 LEN10 RL F220",
                                         "L X+60", "DEP LT LEN10", "L Z+1 FMAX", "L X+0 Y+0 FMAX"}));
  REQUIRE(program.moves.size() == 6);
  CHECK(program.moves[1].end_mm.z() == -5);
  CHECK(program.moves[3].known_end == std::array<bool, 3>{false, false, true});
  CHECK(program.moves[3].fixed == std::array<bool, 3>{});
  CHECK(all_known(program.moves[5].known_end));
}

TEST_CASE("klartext: the reason for APPR and DEP that are not followed names the block") {
  for (const char* block :
       {"APPR LT X+Q1 Y+2 LEN10 RR", "APPR PLT PR+5 PA+3 LEN10 RL", "APPR LT IX+1 Y+2 LEN10 RR",
        "APPR LT X+1 Y+2 LEN10", "DEP LT LEN10", "APPR LN X+1 Y+2 LEN+2 RL M3"}) {
    CAPTURE(block);
    const Program program = read(klartext({"L X+20 Y+0 Z+1 FMAX", block, "L X+60 Y+0"}));
    CHECK(program.moves[1].fixed[0]);
    CHECK(program.left_alone.at(0).why.find("needs X and Y as plain numbers") != std::string::npos);
  }
}

TEST_CASE("klartext: each kind of APPR and DEP is written with its corrected point") {
  for (const char* kind : {"CT X+10 Y+20 CCA180 R+10", "CT X+10 Y+20 R+10 CCA180", "LCT X+10 Y+20 R10",
                           "LT X+10 Y+20 LEN10", "LN X+10 Y+20 LEN10"}) {
    CAPTURE(kind);
    const Program program =
        read(klartext({"L X-20 Y-20 Z+10 R0 FMAX", "L Z-2 F500", fmt::format("APPR {} RR F100", kind),
                       "L X+40", "DEP CT CCA90 R+5", "L Z+50 FMAX"}));
    const std::string text = klartext_shifted(program);
    CHECK(text.find("X+10.5 Y+19.75") != std::string::npos);
    CHECK(diagnostic_of([&] { read(text); }) == "none");
  }
}
