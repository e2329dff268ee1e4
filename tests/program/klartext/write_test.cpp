#include <doctest/doctest.h>

#include "program/klartext/klartext_text.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("klartext: unchanged text is reproduced byte for byte") {
  const std::string text =
      "0 BEGIN PGM 2.5D COVER MM\r\n1 CYCL DEF 247 PRESET ~\r\n    Q339=1 ;NUMBER\r\n\r\n2 * - FACE\r\n"
      "3 TOOL CALL 1 Z S1500\r\n4  L  X+5,25   Y-7 R0 FMAX ; start\r\n5 L Z2 FMAX\r\n6 CC X+10 Y-7\r\n"
      "7 C X+14,75 DR-\r\n8 CR X+5,25 R-4,8 DR+ F200\r\n9 CALL LBL 7\r\n10 L Z+50 FMAX M91\r\n11 FN18: "
      "SYSREAD Q2 = ID270\r\n"
      "12 M30\r\n13 END PGM 2.5D COVER MM\r\nmore";
  const Program program = read(text);
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (MoveEdit& edit : edits)
    if (const auto& arc = program.moves[edit.move].arc) edit.centre_mm = arc->centre_mm;
  CHECK(rewrite(program, edits, {}).text == text);
  CHECK(rewrite(program, {}, {}).text == text);
}

TEST_CASE("klartext: words keep their comma, their sign style and their decimals") {
  CHECK(klartext_shifted(read(klartext({"L X+10 Y-2,5 Z+50,1234 R0 FMAX M3"}))) ==
        klartext({"L X+10,5 Y-2,75 Z+50,2484 R0 FMAX M3"}));
  CHECK(klartext_shifted(read(klartext({"L X10 Y2.5 Z3. FMAX", "L X0.5"}))) ==
        klartext({"L X10.5 Y2.25 Z3.125 FMAX", "L X1.0"}));
}

TEST_CASE("klartext: a missing word is inserted behind the last coordinate if it is needed") {
  const Program program = read(klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L X+20 F200 M8"}));
  const auto out =
      rewrite(program, {{.move = 0, .end_mm = {10, 10, 5}}, {.move = 1, .end_mm = {20, 10.01, 5}}}, {});
  CHECK(out.text == klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L X+20 Y+10.010 F200 M8"}));
  CHECK(out.inserted_words == 1);
}

TEST_CASE("klartext: incremental words are differences of positions in the text") {
  const Program program = read(klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L IX+5 F200", "L IX+5"}));
  const auto out = rewrite(
      program, {{.move = 1, .end_mm = {15.0014, 10, 5}}, {.move = 2, .end_mm = {20.0028, 10.25, 5}}}, {});
  CHECK(out.text == klartext({"L X+10 Y+10 Z+5 R0 FMAX", "L IX+5.001 F200", "L IX+5.002 IY+0.250"}));
}

TEST_CASE("klartext: blocks are renumbered without gaps only if lines are inserted") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 R0 FMAX", "L X+20 F200", "L Y+20"}));
  const std::vector<MoveEdit> edits{{.move = 1, .inserted = {{{10, 0.1, 0}}}, .end_mm = {20, 0, 0}}};
  CHECK(rewrite(program, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 R0 FMAX", "L X+10.000 Y+0.100 F200", "L X+20 Y+0.000 F200", "L Y+20"}));
  const Program plain = read("BEGIN PGM A MM\nL X0 Y0 Z0 FMAX\nL X20 F200\nEND PGM A MM\n");
  CHECK(rewrite(plain, {{.move = 1, .inserted = {{{10, 0.1, 0}}}, .end_mm = {20, 0, 0}}}, {}).text ==
        "BEGIN PGM A MM\nL X0 Y0 Z0 FMAX\nL X10.000 Y0.100 F200\nL X20 Y0.000 F200\nEND PGM A MM\n");
}

TEST_CASE(
    "klartext: the header is written behind BEGIN PGM as comments without numbers, and is found there") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 R0 FMAX"}));
  const std::string text = rewrite(program, {}, {.header = {"Counterflex 1 made", "~ two"}}).text;
  CHECK(text ==
        "0 BEGIN PGM COVER MM\n; COUNTERFLEX 1 MADE\n;   TWO\n1 L X+0 Y+0 Z+0 R0 FMAX\n2 END PGM COVER MM\n");
  CHECK(is_corrected(read(text)));
  CHECK_FALSE(is_corrected(program));
}

TEST_CASE(
    "klartext: a block that starts a spindle is the first of its pieces, one that stops it is not split") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 FMAX", "L X+20 F200 M3", "L X+40 M5"}));
  CHECK(rewrite(program, {{.move = 1, .inserted = {{{10, 0, 0}}}, .end_mm = {20, 0, 0}}}, {}).text ==
        klartext({"L X+0 Y+0 Z+0 FMAX", "L X+10. F200 M3", "L X+20.000", "L X+40 M5"}));
  CHECK(program.moves[1].may_split);
  CHECK_FALSE(program.moves[2].may_split);
}

TEST_CASE("klartext: moves beside corners by RND and CHF are not split") {
  const Program program = read(klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "RND R2", "L Y+10", "L X+0"}));
  CHECK_FALSE(program.moves[1].may_split);
  CHECK_FALSE(program.moves[2].may_split);
  CHECK(program.moves[3].may_split);
  // Both are in the plane of the corner. Behind the part removed by the corner their heights may change.
  for (const std::size_t m : {1u, 2u}) CHECK(changes_height_inside(program.moves[m]));
  CHECK(program.moves[1].corners->end_mm == doctest::Approx(2));
  CHECK(program.moves[2].corners->begin_mm == doctest::Approx(2));
  CHECK(program.moves[1].takes_no_z);
  CHECK_FALSE(program.moves[2].takes_no_z);
  const Program wide = read(klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "RND R9.5", "L Y+10", "L X+0"}));
  for (const std::size_t m : {1u, 2u}) CHECK_FALSE(changes_height_inside(wide.moves[m]));
  std::vector<MoveEdit> edits = edits_to_original(wide);
  for (MoveEdit& edit : edits) edit.end_mm.z() = 0.01 * static_cast<double>(edit.move);
  CHECK(rewrite(wide, edits, {}).text ==
        klartext({"L X+0 Y+0 Z+0 F100", "L X+10", "RND R9.5", "L Y+10", "L X+0 Z+0.030"}));
}
