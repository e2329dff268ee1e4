#include <doctest/doctest.h>

#include <cmath>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext: a cycle called in place keeps the position of its hole and makes the height unknown") {
  const Program program =
      read(klartext({"CYCL DEF 200 DRILLING ~\n    Q200=2 ;CLEARANCE ~\n    Q201=-20 ;DEPTH",
                     "L X+10 Y+10 Z+50 R0 FMAX", "L X+20 FMAX M99", "CYCL CALL", "L X+30 FMAX"}));
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].words[0]);
  CHECK(program.moves[1].fixed == std::array{false, false, true});
  CHECK(program.moves[2].fixed == std::array{false, false, true});
  CHECK(program.moves[3].known_start == std::array{true, true, false});
}

TEST_CASE(
    "klartext: each hole of a drilling cycle is corrected in X and Y, and the first one moves the surface") {
  const std::string text =
      klartext({"L X+1 Y+0 Z+50 FMAX",
                "CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203=+1.5 ;SURFACE ~\n  Q204=50",
                "L X+2 Y+3 FMAX M99", "L X+4 Y+3 FMAX M99", "CYCL CALL", "L X+0 Y+0 Z+50 FMAX"});
  const Program program = read(text);
  REQUIRE(program.moves.size() == 5);
  for (const std::size_t hole : {1U, 2U, 3U}) {
    const Move& move = program.moves[hole];
    CHECK(move.handling == Handling::own);
    CHECK(move.makes_hole);
    CHECK(move.words[2].has_value());
    CHECK(move.repeats_surface == (hole > 1));
    CHECK(move.motion == Motion::rapid);
    CHECK_FALSE(may_insert_word(move, 2));
    CHECK(all_known(move.known_end));
    CHECK(move.end_mm.z() == 1.5);
  }
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+1.5 Y-0.25 Z+50.125 FMAX",
                  "CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203=+1.625 ;SURFACE ~\n  Q204=50",
                  "L X+2.5 Y+2.75 FMAX M99", "L X+4.5 Y+2.75 FMAX M99", "CYCL CALL",
                  "L X+0.5 Y-0.25 Z+50.125 FMAX"}));
}

TEST_CASE("klartext: the bottom of a hole is Q201 above its surface, if that is a plain number") {
  const auto bottom_behind = [](const std::string& cycle, const std::string& parameter = "L X+1") {
    const Program program = read(
        klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF " + cycle + " ~\n  Q200=2 ~\n  Q203=+1.5 ~\n  Q204=50",
                  parameter, "L X+2 Y+3 FMAX M99"}));
    REQUIRE(program.moves.back().called);
    return program.moves.back().called->heights_mm[2];
  };
  CHECK(bottom_behind("200 DRILLING ~\n  Q201=-10.25 ;DEPTH") == -8.75);
  CHECK(bottom_behind("200 DRILLING ~\n  Q201=-10.25 ;DEPTH", "Q201 = -30") == -28.5);
  CHECK(bottom_behind("240 CENTERING ~\n  Q343=+0 ~\n  Q201=-3") == -1.5);
  CHECK(std::isnan(bottom_behind("200 DRILLING ~\n  Q201=+Q5")));
  CHECK(std::isnan(bottom_behind("200 DRILLING ~\n  Q201=-10", "FN 1: Q201 = +Q5 + +1")));
  CHECK(std::isnan(bottom_behind("200 DRILLING ~\n  Q201=-10", "Q201 = +Q5")));
  CHECK(std::isnan(bottom_behind("240 CENTERING ~\n  Q343=+1 ~\n  Q201=-3")));
  CHECK(std::isnan(bottom_behind("204 BACK BORING ~\n  Q249=+5")));
}

TEST_CASE("klartext: a hole at another height repeats the statement that has its cycle's surface") {
  const std::string begin = "L X+1 Y+0 Z+50 FMAX",
                    definition = "CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q203=";
  const std::string rest = " ;SURFACE ~\n  Q204=50";
  const auto with_heights = [](const Program& program, const std::vector<double>& z) {
    std::vector<MoveEdit> edits = edits_to_original(program);
    for (std::size_t k = 0; k < z.size(); ++k) edits.at(k + 1).end_mm.z() += z[k];
    return rewrite(program, edits, {}).text;
  };
  const std::vector<std::string> holes{"L X+2 Y+3 FMAX M99", "L X+4 FMAX M99", "L X+6 FMAX M99", "CYCL CALL"};
  const Program defined =
      read(klartext({begin, definition + "+1.5" + rest, holes[0], holes[1], holes[2], holes[3]}));
  CHECK(with_heights(defined, {0, 0.02, 0.02, 0}) ==
        klartext({begin, definition + "+1.5" + rest, holes[0], definition + "+1.52" + rest, holes[1],
                  holes[2], definition + "+1.5" + rest, holes[3]}));
  const std::string line = "Q203 = +1.5", definitions = "CYCL DEF 200 DRILLING",
                    clearances = "Q200=2\nQ204=50";
  const Program assigned = read("0 BEGIN PGM COVER MM\n" + begin + "\n" + definitions + "\n" + line +
                                " ;SURFACE\n" + clearances + "\n" + holes[0] + "\n" + holes[1] + "\n");
  CHECK(with_heights(assigned, {0.01, 0.03}).find(holes[0] + "\nQ203 = +1.53 ;SURFACE\n") !=
        std::string::npos);
}

TEST_CASE("klartext: under M89 a definition is not repeated, because it would end M89") {
  const Program program =
      read(klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 ~\n  Q200=2 ~\n  Q203=+1.5 ~\n  Q204=50",
                     "L X+2 Y+3 FMAX M89", "L X+4 FMAX", "L X+6 FMAX M99",
                     "CYCL DEF 200 ~\n  Q200=2 ~\n  Q203=+1.5 ~\n  Q204=50", "L X+8 FMAX"}));
  CHECK_FALSE(program.moves[2].words[2].has_value());
  CHECK(program.moves[2].makes_hole);
  CHECK(program.moves[3].makes_hole);
  CHECK_FALSE(program.moves[4].makes_hole);
}

TEST_CASE("klartext: a definition is not repeated if the program may have changed its parameters since") {
  const std::string definition = "CYCL DEF 200 ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203=+1.5 ~\n  Q204=50";
  for (const char* between : {"Q201 = -20", "FN 0: Q201 = -20", "LBL 1", "STOP"}) {
    CAPTURE(between);
    const Program program =
        read(klartext({"L X+1 Y+0 Z+50 FMAX", definition, "L X+2 Y+3 FMAX M99", between, "L X+4 FMAX M99"}));
    for (std::size_t hole = 2; hole < program.moves.size(); ++hole)
      CHECK_FALSE(program.moves[hole].words[2].has_value());
  }
}

TEST_CASE("klartext: holes are held if the height at which a cycle leaves the tool is unknown") {
  for (const char* clearances : {"Q200=2", "Q204=50", "Q200=2 ~\n  Q204=Q9"}) {
    CAPTURE(clearances);
    const Program program =
        read(klartext({"L X+1 Y+0 Z+50 FMAX", fmt::format("CYCL DEF 200 ~\n  Q203=+1.5 ~\n  {}", clearances),
                       "L X+2 Y+3 FMAX M99", "L X+4 FMAX M99"}));
    REQUIRE(program.moves.size() == 3);
    for (const std::size_t hole : {1U, 2U}) {
      CHECK(program.moves[hole].handling == Handling::held);
      CHECK_FALSE(program.moves[hole].known_end[2]);
    }
  }
}

TEST_CASE("klartext: the first call of a cycle may be a block without coordinates") {
  for (const char* call : {"CYCL CALL", "CYCL CALL M8", "M99", "M99 M8"}) {
    CAPTURE(call);
    const std::string begin = "L X+1 Y+0 Z+50 FMAX", cycle = "CYCL DEF 203 DRILLING ~\n  Q201=-10 ~\n  Q203=";
    const std::string text = klartext({begin, cycle + "+1.5", call, "L X+4 Y+3 FMAX M99"});
    const Program program = read(text);
    REQUIRE(program.moves.size() == 3);
    CHECK(program.moves[1].words[2]);
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
    CHECK(klartext_shifted(program) ==
          klartext({"L X+1.5 Y-0.25 Z+50.125 FMAX", cycle + "+1.625", call, "L X+4.5 Y+2.75 FMAX M99"}));
  }
}

TEST_CASE("klartext: holes are fixed if their surface is not a plain number used by them alone") {
  for (const char* surface :
       {"CYCL DEF 200 Q203=+Q5", "CYCL DEF 200 Q201=-5", "/CYCL DEF 200 Q203=+1", "CYCL DEF 252 Q203=+1"}) {
    CAPTURE(surface);
    const Program program = read(klartext({"L X+1 Y+0 Z+50 FMAX", surface, "L X+2 Y+3 FMAX M99"}));
    CHECK(program.moves[1].fixed[2]);
  }
  for (const char* call : {"/L X+2 Y+3 FMAX M99", "L X+2 Z+5 FMAX M99", "Q203 = Q5", "FN 0: Q203 = 5"}) {
    CAPTURE(call);
    const Program program =
        read(klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 Q203=+1", call, "L X+2 Y+3 FMAX M99"}));
    CHECK(program.moves.back().fixed[2]);
  }
}

TEST_CASE("klartext: incremental holes and a surface in a line of its own are held") {
  const std::string text =
      klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 DRILLING", "Q201 = -15 ;DEPTH", "Q203 = +1.5   ;SURFACE",
                "L IX+2 FMAX M99", "L IY+5 M99", "L X+0 Y+0 Z+50 FMAX"});
  const Program program = read(text);
  CHECK(program.moves[1].handling == Handling::held);
  CHECK(program.moves[2].handling == Handling::held);
  CHECK(program.moves[2].known_end == std::array<bool, 3>{true, true, false});
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+1.5 Y-0.25 Z+50.125 FMAX", "CYCL DEF 200 DRILLING", "Q201 = -15 ;DEPTH",
                  "Q203 = +1.625   ;SURFACE", "L IX+2 FMAX M99", "L IY+5 M99",
                  "L X+0.5 Y-0.25 Z+50.125 FMAX"}));
}

TEST_CASE("klartext: behind holes with a surface in a line of its own Z is that of the second clearance") {
  for (const char* hole : {"L IX+2 FMAX M99", "L X+9 FMAX M99"}) {
    CAPTURE(hole);
    const std::string text =
        klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 DRILLING", "Q200 = 2", "Q203 = +1.5", "Q204 = 10",
                  "L X+5 Y+5 FMAX M99", hole, "L X+0 Y+0 FMAX"});
    const Program program = read(text);
    CHECK(all_known(program.moves[2].known_end));
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
    const std::string shifted = klartext_shifted(program);
    CHECK(shifted.find("Q203 = +1.625\n") != std::string::npos);
    CHECK(shifted.find("L X+0.5 Y-0.25 FMAX\n") != std::string::npos);
  }
}

TEST_CASE("klartext: holes of cycles that are relative to the tool are shifted with their positions") {
  const Program program = read(
      klartext({"L X+1 Y+0 Z+2 FMAX", "CYCL DEF 1.0 PECKING", "CYCL DEF 1.1 DIST 2", "CYCL DEF 1.2 DEPTH -10",
                "L FMAX M99", "L X+5 FMAX M99", "CYCL CALL", "L IX+5 M89", "L Y+7", "L X+0 M99", "L Y+9"}));
  REQUIRE(program.moves.size() == 6);
  for (const Move& move : program.moves) {
    CHECK(move.handling == Handling::own);
    CHECK(move.fixed == std::array<bool, 3>{});
  }
  CHECK(all_known(program.moves.back().known_end));
  const Program pocket =
      read(klartext({"L X+1 Y+0 Z+2 FMAX", "CYCL DEF 4.0 POCKET", "L X+5 FMAX M99", "L Y+9"}));
  CHECK(all_known(pocket.moves[1].known_start));
  CHECK(pocket.moves[1].mills_at_end);
  REQUIRE(pocket.left_alone.size() == 1);
  CHECK(pocket.left_alone[0].why.starts_with("the cycle is shifted as a whole"));
  CHECK(pocket.moves[2].known_start == std::array<bool, 3>{});
}

TEST_CASE("klartext: M89 calls the cycle at the end of all moves up to M99") {
  const Program program = read(klartext({"L X+1 Y+0 Z+50 FMAX", "CYCL DEF 200 DRILLING Q203=+0",
                                         "L X+2 FMAX M89", "L X+3", "L X+4 M99", "L X+5"}));
  std::vector<bool> held;
  for (const Move& move : program.moves) held.push_back(move.handling == Handling::held);
  CHECK(held == std::vector<bool>{false, true, true, true, false});
}

TEST_CASE("klartext: a cycle that may act by its definition makes the position unknown") {
  const auto behind = [](const std::string& definition) {
    return read(klartext({"TOOL CALL 1 Z S1000", "L X+0 Y+0 Z+5 FMAX", definition, "L X+10 F100"}))
        .moves.back()
        .known_start;
  };
  for (const char* definition :
       {"CYCL DEF 224 DATAMATRIX", "CYCL DEF 220 POLAR PATTERN", "CYCL DEF 800 ADJUST", "CYCL DEF 399 OEM"}) {
    CAPTURE(definition);
    CHECK(behind(definition) == std::array{false, false, false});
  }
  for (const char* definition :
       {"CYCL DEF 200 DRILLING", "CYCL DEF 251 RECTANGULAR POCKET", "CYCL DEF 9.0 DWELL",
        "CYCL DEF 32.0 TOLERANCE", "CYCL DEF 14.0 CONTOUR", "CYCL DEF 1271 OCM"}) {
    CAPTURE(definition);
    CHECK(behind(definition) == std::array{true, true, true});
  }
}

TEST_CASE("klartext: bore milling moves beside the point at which it is called") {
  const auto hole = [](const std::string& cycle) {
    return read(klartext({"TOOL CALL 1 Z S1000", "L X+0 Y+0 Z+50 FMAX",
                          "CYCL DEF " + cycle + " ~\n Q200=2 ~\n Q201=-15 ~\n Q203=+0 ~\n Q204=50",
                          "L X+20 FMAX M99"}));
  };
  const Program milled = hole("208 BORE MILLING"), drilled = hole("200 DRILLING");
  CHECK(milled.moves.back().mills_at_end);
  CHECK(milled.left_alone.back().why.starts_with("the cycle is shifted as a whole"));
  CHECK_FALSE(drilled.moves.back().mills_at_end);
  CHECK(klartext_shifted(milled).find("L X+20.5") != std::string::npos);
}
