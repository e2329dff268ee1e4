#include <doctest/doctest.h>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("Klartext: an arc that '/' may skip stays one block") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "/C X+20 Y+0 DR- F300",
                                         "L X+0 Y+0", "CC X+10 Y+0", "C X+20 Y+0 DR-"}));
  CHECK_FALSE(program.moves.at(1).may_split);
  CHECK(program.moves.back().may_split);
}

TEST_CASE("klartext: an arc about CC moves with its centre") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "C X+0 Y+0 DR-"}));
  REQUIRE(program.moves.size() == 3);
  REQUIRE(program.moves[1].arc);
  CHECK(program.moves[1].arc->clockwise);
  CHECK(program.moves[1].arc->centre_mm == Vector3(10, 0, 0));
  CHECK(klartext_shifted(program) == klartext({"L X+0.5 Y-0.25 Z+0.125 FMAX", "CC X+10.5 Y-0.25",
                                               "C X+20.5 Y-0.25 DR- F300", "C X+0.5 Y-0.25 DR-"}));
}

TEST_CASE("klartext: an arc that shares its centre gets a CC of its own if the centre must differ") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "C X+0 Y+0 DR-"}));
  const std::vector<MoveEdit> edits{{.move = 1, .end_mm = {20, 0, 0}, .centre_mm = Vector3(10, 0.5, 0)}};
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0.5", "C X+20 Y+0 DR- F300", "CC X+10.000 Y+0.000",
                  "C X+0 Y+0 DR-"}));
}

TEST_CASE("klartext: arcs are split into arcs or lines") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300"}));
  MoveEdit edit{.move = 1,
                .inserted = {{{10, 10, 0}, Vector3(10, 0, 0)}},
                .end_mm = {20, 0, 0},
                .centre_mm = Vector3(10, 0, 0)};
  CHECK(
      rewrite(program, {edit}, {}).text ==
      klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+10.000 Y+10.000 DR- F300", "C X+20 Y+0 DR- F300"}));
  edit.inserted[0].centre_mm.reset();
  edit.centre_mm.reset();
  CHECK(rewrite(program, {edit}, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "L X+10.000 Y+10.000 F300", "L X+20 Y+0 F300"}));
}

TEST_CASE("klartext: CR arcs turn about the centre given by their radius and sign") {
  const Program program =
      read(klartext({"L X+0 Y+0 Z+0 FMAX", "CR X+10 Y+10 R+10 DR- F100", "CR X+20 Y+0 R-10 DR+"}));
  REQUIRE(program.moves[1].arc);
  CHECK((program.moves[1].arc->centre_mm - Vector3(10, 0, 0)).norm() < 1e-12);
  REQUIRE(program.moves[2].arc);
  CHECK((program.moves[2].arc->centre_mm - Vector3(10, 0, 0)).norm() < 1e-12);
  CHECK(klartext_shifted(program) ==
        klartext(
            {"L X+0.5 Y-0.25 Z+0.125 FMAX", "CR X+10.5 Y+9.75 R+10 DR- F100", "CR X+20.5 Y-0.25 R-10 DR+"}));
}

TEST_CASE("klartext: CT is the arc tangent to the move before it, and becomes C if its words change") {
  const std::string text =
      klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "CT X+20 Y+10", "CT X+10 Y+20", "CT Y+30", "L X+0"});
  const Program program = read(text);
  const Move &quarter = program.moves[2], &next = program.moves[3], &half = program.moves[4];
  REQUIRE(quarter.arc.has_value());
  CHECK((quarter.arc->centre_mm - Vector3(10, 10, 0)).norm() < 1e-12);
  CHECK_FALSE(quarter.arc->clockwise);
  REQUIRE(next.arc.has_value());
  CHECK((next.arc->centre_mm - Vector3(10, 10, 0)).norm() < 1e-12);
  REQUIRE(half.arc.has_value());
  CHECK((half.arc->centre_mm - Vector3(10, 25, 0)).norm() < 1e-12);
  CHECK(half.arc->clockwise);
  std::vector<MoveEdit> edits = edits_to_original(program);
  CHECK(rewrite(program, edits, {}).text == text);
  for (MoveEdit& edit : edits) {
    edit.end_mm.x() += 0.5;
    if (edit.centre_mm) edit.centre_mm->x() += 0.5;
  }
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0.5 Y+0 Z+0 F100", "L X+10.5", "CC X+10.500 Y+10.000", "C X+20.5 Y+10 DR+",
                  "C X+10.5 Y+20 DR+", "CC X+10.500 Y+25.000", "C Y+30 DR-", "L X+0.5"}));
}

TEST_CASE("klartext: CT is held with a height, after an unknown move, straight ahead or to its own start") {
  for (const char* block : {"CT X+20 Y+10 Z+5", "CT X+20", "CT X+10 Y+0"}) {
    CAPTURE(block);
    const Program program = read(klartext({"L X+0 Y+0 Z+0 F100", "L X+10", block, "L X+0"}));
    CHECK(program.moves[2].handling == Handling::held);
    CHECK_FALSE(program.moves[2].arc.has_value());
  }
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "CT X+20 Y+10 F100", "L X+0"}));
  CHECK(program.moves[1].handling == Handling::held);
}

TEST_CASE("klartext: an arc whose ends are not equally far from its CC is refused with both radii") {
  const auto reads = [](const char* end) {
    read(klartext({"L X+10 Y+0 Z+0 FMAX", "CC X+0 Y+0", fmt::format("C X{} Y+0 DR+ F100", end)}));
  };
  CHECK_NOTHROW(reads("-10.016"));
  const std::string what = diagnostic_of([&] { reads("-10.017"); });
  CHECK(what.find("10.0000 mm at the arc's start and 10.0170 mm at its end") != std::string::npos);
}

TEST_CASE(
    "klartext: a CC with one incremental word is kept, and written again if the tool's position changes") {
  const std::string text =
      klartext({"L X+10 Y-2.5 Z+0 FMAX", "CC X+0 IY+0", "C X-10 Y-2.5 DR+ F100", "L X+0"});
  const Program program = read(text);
  REQUIRE(program.moves[1].arc.has_value());
  CHECK((program.moves[1].arc->centre_mm - Vector3(0, -2.5, 0)).norm() < 1e-12);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK(klartext_shifted(program).find("CC X+0 IY+0\n3 CC X+0.500 Y-2.750\n") != std::string::npos);
}

TEST_CASE("klartext: an arc moves its CC also if other moves are between them") {
  const Program program =
      read(klartext({"L X+4 Y+0 Z+5 FMAX", "CC X+0 Y+0", "L X+5 F100", "C X-5 Y+0 DR+", "C X+5 Y+0 DR+"}));
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  CHECK(klartext_shifted(program) == klartext({"L X+4.5 Y-0.25 Z+5.125 FMAX", "CC X+0.5 Y-0.25",
                                               "L X+5.5 F100", "C X-4.5 Y-0.25 DR+", "C X+5.5 Y-0.25 DR+"}));
}

TEST_CASE("klartext: after an arc that is not changed no other arc about the same CC is followed") {
  for (const char* arc : {"C X+5", "/C X-5 Y+0 DR+", "C X+Q1 Y+0 DR+"}) {
    const std::string text =
        klartext({"L X+5 Y+0 Z+5 FMAX", "CC X+0 Y+0", arc, "L X+5 Y+0 F100", "C X-5 Y+0 DR+"});
    CAPTURE(text);
    const Program program = read(text);
    CHECK(program.moves.back().fixed[0]);
    CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  }
}

TEST_CASE("klartext: arcs get no Z word, the lines around them do") {
  const Program program = read(
      klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "CR X+0 Y+0 R+10 DR-", "L X-5"}));
  const std::vector<MoveEdit> edits{{.move = 0, .end_mm = {0, 0, 0}},
                                    {.move = 1, .end_mm = {20, 0, 0.01}, .centre_mm = Vector3(10, 0, 0)},
                                    {.move = 2, .end_mm = {0, 0, 0.01}, .centre_mm = Vector3(10, 0, 0)},
                                    {.move = 3, .end_mm = {-5, 0, 0.01}}};
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "C X+20 Y+0 DR- F300", "CR X+0 Y+0 R+10 DR-",
                  "L X-5 Z+0.010"}));
  const MoveEdit chords{.move = 1, .inserted = {{{10, 10, 0.005}}}, .end_mm = {20, 0, 0.01}};
  CHECK(rewrite(program, {chords}, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "CC X+10 Y+0", "L X+10.000 Y+10.000 Z+0.005 F300",
                  "L X+20 Y+0 Z+0.010 F300", "CR X+0 Y+0 R+10 DR-", "L X-5"}));
}
