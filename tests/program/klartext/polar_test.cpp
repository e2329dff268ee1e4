#include <doctest/doctest.h>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext: a helix of turns is followed, and keeps its polar words when it is shifted") {
  const std::string text = klartext({"TOOL CALL 3 Z S2500", "L X+10 Y+0 Z+5 FMAX", "L Z+0 F100",
                                     "CC X+4,5 Y+0", "CP IPA+720 IZ-2 DR+", "L X+12 Y+1 Z-2"});
  const Program program = read(text);
  REQUIRE(program.moves.size() == 4);
  REQUIRE(program.moves[2].arc);
  CHECK(program.moves[2].arc->turns == 1);
  CHECK(program.moves[2].end_mm == Vector3(10, 0, -2));
  CHECK(all_known(program.moves[2].known_end));
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program) ==
        klartext({"TOOL CALL 3 Z S2500", "L X+10,5 Y-0,25 Z+5,125 FMAX", "L Z+0,125 F100", "CC X+5,0 Y-0,25",
                  "CP IPA+720 IZ-2 DR+", "L X+12,5 Y+0,75 Z-1,875"}));
}

TEST_CASE("klartext: a helix becomes lines if polar words cannot hold its correction") {
  const Program program =
      read(klartext({"L X+10 Y+0 Z+0 F100", "CC X+4 Y+0", "CP IPA+360 IZ-2 DR+ F200 M8", "L X+12"}));
  const MoveEdit edit{.move = 1, .inserted = {{{-2, 0.1, -1}}}, .end_mm = {10, 0.1, -2.1}};
  CHECK(rewrite(program, {edit}, {}).text ==
        klartext({"L X+10 Y+0 Z+0 F100", "CC X+4 Y+0", "L X-2.000 Y+0.100 IZ-1. F200 M8",
                  "L X+10.000 IZ-1.100", "L X+12"}));
}

TEST_CASE("klartext: polar arcs end about their pole, in every plane") {
  const Program program = read(klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0", "CP IPA+90 DR+",
                                         "CP PA+180 DR+", "CP IPA-270 DR-", "CP IPA+360 DR+", "L Y-20 Z-5",
                                         "CC Y-10 Z-5", "CP IPA-90 DR-", "CC IY+5 IZ+0", "CP IPA+180 DR+"}));
  const auto ends_at = [&](std::size_t move, const Vector3& end) {
    CAPTURE(move);
    CHECK((program.moves.at(move).end_mm - end).norm() < 1e-12);
    CHECK(program.moves.at(move).arc.has_value());
  };
  ends_at(1, {0, 10, 0});
  ends_at(2, {-10, 0, 0});
  ends_at(3, {0, -10, 0});
  ends_at(4, {0, -10, 0});
  ends_at(6, {0, -10, 5});
  CHECK(program.moves[6].arc->normal == 0);
  ends_at(7, {0, 0, 5});
  CHECK_FALSE(program.moves[7].arc->absolute_centre);
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) ==
        klartext({"L X+10.5 Y-0.25 Z+0.125 F100", "CC X+0.5 Y-0.25", "CP IPA+90 DR+", "CP PA+180 DR+",
                  "CP IPA-270 DR-", "CP IPA+360 DR+", "L Y-20.25 Z-4.875", "CC Y-10.25 Z-4.875",
                  "CP IPA-90 DR-", "CC IY+5 IZ+0", "CP IPA+180 DR+"}));
}

TEST_CASE("klartext: a polar arc in the plane becomes C if its polar words cannot hold the correction") {
  const Program program =
      read(klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0", "CP  IPA+90 DR+ F50", "L X-1"}));
  const MoveEdit edit{.move = 1, .end_mm = {0, 10.02, 0}, .centre_mm = Vector3(0, 0.01, 0)};
  CHECK(rewrite(program, {edit}, {}).text ==
        klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0.01", "C X+0.000 Y+10.020 DR+ F50", "L X-1"}));
}

TEST_CASE("klartext: lines in polar coordinates are followed and become lines in X and Y") {
  const Program program =
      read(klartext({"CC X+50 Y+50", "LP PR+30 PA+0 FMAX", "L Z-2 F100", "LP PA+60", "LP IPA+30", "LP IPR-10",
                     "LP PA+180 IZ+1", "CC X+50 Y+51", "C X+30 Y+52 DR+"}));
  REQUIRE(program.moves.size() == 7);
  const auto ends_at = [&](std::size_t move, const Vector3& end) {
    CAPTURE(move);
    CHECK((program.moves.at(move).end_mm - end).norm() < 1e-12);
  };
  ends_at(1, {80, 50, -2});
  ends_at(2, {65, 50 + 15 * std::sqrt(3.0), -2});
  ends_at(3, {50, 80, -2});
  ends_at(4, {50, 70, -2});
  ends_at(5, {30, 50, -1});
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) ==
        klartext({"CC X+50 Y+50", "L X+80.500 Y+49.750 FMAX", "L Z-1.875 F100", "L X+65.500 Y+75.731",
                  "L X+50.500 Y+79.750", "L X+50.500 Y+69.750", "L X+30.500 Y+49.750 IZ+1",
                  "CC X+50.5 Y+50.75", "C X+30.5 Y+51.75 DR+"}));
}

TEST_CASE("klartext: a line in polar coordinates is rewritten if an arc has moved its pole") {
  const std::string text = klartext({"L X+10 Y+0 Z+0 F100", "CC X+0 Y+0", "CP IPA+90 DR+", "LP PR+20 PA+90"});
  const Program program = read(text);
  const MoveEdit edit{.move = 1, .end_mm = {0, 10, 0}, .centre_mm = Vector3(0.01, 0.01, 0)};
  CHECK(rewrite(program, {edit}, {}).text == klartext({"L X+10 Y+0 Z+0 F100", "CC X+0.01 Y+0.01",
                                                       "C X+0.000 Y+10.000 DR+", "L X+0.000 Y+20.000"}));
}

TEST_CASE("klartext: unknown polar coordinates are fixed, with the reason and the cure") {
  for (const auto& [block, why] :
       {std::pair{"LP PR+10 PA+Q5", "LP has no angle"},
        {"LP IPA+10", "LP is relative to the polar coordinates of the block before it"},
        {"CP IPA+90 DR-", "IPA and DR of CP have different signs"},
        {"CP IPA+90", "CP has no DR+ or DR-"},
        {"LP PR+10 PA+20 X+5", "LP with both polar and Cartesian"},
        {"CTP PR+10 PA+20", "CTP is not supported"}}) {
    const std::string shown = block;
    CAPTURE(shown);
    const Program program = read(klartext({"L X+10 Y+0 Z+5 FMAX", "CC X+4 Y+0", shown}));
    CHECK(program.moves.at(1).fixed == std::array<bool, 3>{true, true, true});
    CHECK(program.left_alone.at(0).why.starts_with(why));
  }
  const Program shared =
      read(klartext({"L X+10 Y+0 Z+5 FMAX", "CC X+4 Y+0", "LP PR+10 PA+0", "LP IPR+5 IPA+90",
                     "C X+4 Y-15 DR+", "LP PR+9 PA+0", "CTP PR+10 PA+20"}));
  CHECK((shared.moves.at(2).end_mm - Vector3(4, 15, 5)).norm() < 1e-12);
  CHECK_FALSE(shared.moves.at(3).arc);
  CHECK((shared.moves.at(4).end_mm - Vector3(13, 0, 5)).norm() < 1e-12);
  CHECK(shared.left_alone.at(0).why == "C has a CC that another block uses, which is not followed");
  const Program no_pole = read(klartext({"L X+10 Y+0 Z+5 FMAX", "CC X+Q4 Y+0", "CP IPA+90 DR+"}));
  CHECK(no_pole.left_alone.at(0).why.starts_with("CP needs a known pole"));
}
