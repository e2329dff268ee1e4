#include <doctest/doctest.h>

#include <algorithm>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string origin_block = "G21 G90 F100 G0 X0. Y0. Z10.\n";

bool is_fixed(const Move& move) {
  return move.fixed[0] || move.fixed[1] || move.fixed[2];
}

/// Whether each move behind `origin_block` is fixed.
std::vector<bool> fixed_moves(const std::string& text, const std::string& dialect = "linuxcnc") {
  std::vector<bool> fixed;
  const Program program = read(origin_block + text, dialect);
  for (const Move& move : program.moves) fixed.push_back(is_fixed(move));
  return {fixed.begin() + 1, fixed.end()};
}

using Fixed = std::vector<bool>;

}  // namespace

TEST_CASE("an expression or a variable fixes its axis and makes it unknown, until a plain word sets it") {
  for (const char* value :
       {"[1+2]", "#5", "#<width>", "-#5", "SIN[30]", "ATAN[1]/[2]", "[#1*[2+3]]", "##2", "#[1+2]"}) {
    CAPTURE(value);
    const Program program = read(origin_block + "G1 X" + value + " Y2\nX1\n");
    const Move& move = program.moves[1];
    CHECK(move.fixed == std::array<bool, 3>{true, false, false});
    CHECK(move.known_end == std::array<bool, 3>{false, true, true});
    CHECK_FALSE(move.words[0].has_value());
    CHECK(move.end_mm.y() == 2);
    CHECK_FALSE(move.may_split);
    CHECK(program.left_alone.size() == 1);
    CHECK(program.moves[2].known_end[0]);
    CHECK_FALSE(is_fixed(program.moves[2]));
  }
}

TEST_CASE("a relative expression is unknown and not fixed: a shift applies to later moves, too") {
  const Program program = read(origin_block + "G91 X[1+2]\n");
  CHECK_FALSE(program.moves[1].fixed[0]);
  CHECK_FALSE(program.moves[1].known_end[0]);
}

TEST_CASE("assignments do not move, and their values may end at a comment") {
  CHECK(read(origin_block + "#1=5\n#<a_b> = [#1+2] (note)\n#5=-1.5 G1 X1\nN10 #[2]=SIN[30]\n").moves.size() ==
        2);
  CHECK(read("O1\n" + origin_block + "#100=#101+5.*2 (X9)\n#3000=1(ALARM)\n", "fanuc").moves.size() == 1);
}

TEST_CASE("F, S and T may be variables; a code that is a variable has an unknown effect") {
  const Program program =
      read(origin_block +
           "G1 X1 F#4 S[5*2]\nT#<tool> M6\nG#5 X2\nX3\nG90 G17 G21 G54 G90.1 G98 G40 G1 X4 Y4 Z4\nX5\n");
  CHECK(program.moves[1].known_end[0]);
  CHECK(program.moves[1].feed_mm_min == 0);
  CHECK(program.moves[2].fixed == std::array<bool, 3>{true, true, true});
  CHECK(is_fixed(program.moves[3]));
  CHECK_FALSE(is_fixed(program.moves[4]));
}

TEST_CASE("moves in conditions and loops of O-words are fixed, and positions after them are unknown") {
  CHECK(fixed_moves("o1 if [#1 GT 2]\nX1\no1 else\nX2\no1 endif\nX3\n") == Fixed{true, true, false});
  CHECK(fixed_moves("o1 while [#1 LT 2]\nX1\no1 endwhile\nX3\n") == Fixed{true, false});
  CHECK(fixed_moves("o<a> do\nX1\no<a> while [#1 LT 2]\nX3\n") == Fixed{true, false});
  CHECK(fixed_moves("O1 repeat [3]\nX1\no2 IF [1]\nX4\no2 endif\nX5\nO1 endrepeat\nX3\n") ==
        Fixed{true, true, true, false});
  const Program program = read(origin_block + "o1 if [1]\nX1\no1 endif\nX3\n");
  CHECK(program.moves[2].known_start == std::array<bool, 3>{false, false, false});
}

TEST_CASE("a state that a condition sets is unknown afterwards, until a plain block sets it") {
  CHECK(fixed_moves("o1 if [1]\nG91\no1 endif\nX3\nG90 X4\n") == Fixed{true, false});
  CHECK(fixed_moves("o1 if [1]\nG1\no1 endif\nX3\nG0 X4\n") == Fixed{true, false});
  CHECK(fixed_moves("o1 if [1]\nG55\no1 endif\nX3\nG54 X4\n") == Fixed{true, false});
  CHECK(fixed_moves("o1 if [1]\nG20\no1 else\nG21\no1 endif\nX3\nG21 X4\n") == Fixed{true, false});
}

TEST_CASE("the body of a subprogram does not run at its place, and a call may move all axes") {
  const Program body = read("o<cut> sub\nX1\nG1 Z[#1]\no<cut> endsub\n" + origin_block + "X5\n");
  CHECK(is_fixed(body.moves[0]));
  CHECK(is_fixed(body.moves[1]));
  CHECK(body.moves[3].known_start == std::array<bool, 3>{true, true, true});
  const Program call = read(origin_block + "o<cut> call [1] [2]\nG90 G0 X5\n");
  CHECK(call.moves[1].fixed == std::array<bool, 3>{true, true, true});
  CHECK(call.moves[1].known_end == std::array<bool, 3>{false, false, false});
  CHECK_FALSE(is_fixed(call.moves[2]));
  REQUIRE(call.remarks.size() == 1);
  CHECK(call.remarks[0].line == 2);
  CHECK(
      call.remarks[0].what ==
      "assumed from here on: called programs do not change the unit, the work offset, the coordinates "
      "(shift, "
      "rotation, mirror image, scale, tilt), the tool, its length, G40 to G42 and G93 to G97; see that their "
      "text agrees");
  CHECK(fixed_moves("M98 P100\nX5\nG90 G0 X6\n", "fanuc") == Fixed{true, true, false});
  CHECK(fixed_moves("G65 P9010 I1. J2. I3.\nG90 G17 G98 G40 G0 X6.\n", "fanuc") == Fixed{true, false});
}

TEST_CASE("LinuxCNC executes nothing of a definition: behind it everything is as before") {
  const std::string begin = origin_block + "G1 X20. F300\n(SLOT)\n#1=5\n", end = "X30.\nY#1\n";
  ReadOptions options;
  options.dialect = "linuxcnc";
  options.evaluate = true;
  const auto moves_of = [&](const std::string& text) { return read_program(text, "p.ngc", options).moves; };
  const std::vector<Move> expected = moves_of(begin + end);
  for (const char* const definition :
       {"o1 sub\nG1 X30.\no1 endsub\n", "o<cut> sub\nG53 G0 Z0.\no<CUT> endsub [1]\n",
        "o1 sub\n(OTHER)\n#1=7 G91 G20 G18 G93\nM6 T5\nG0 Z3.\nM2\no1 endsub\n",
        "o1 sub\nG92 X3. Y2.\nG10 L2 P1 X4.\nG55 G41.1 D3\nX1.\no1 endsub\n", "o[1] sub\nX3.\no[1] endsub\n",
        "o1 sub\no2 sub\nX3.\no2 endsub\nX4.\no1 endsub\n", "o1 sub\no2 if [1]\nX3.\no01 endsub\n",
        "o1 sub\no3 call\nX3.\no1 endsub\n", "o1 sub\no1 endsub\n"}) {
    CAPTURE(definition);
    const std::vector<Move> moves = moves_of(begin + definition + end);
    REQUIRE(moves.size() == expected.size());
    for (std::size_t m = 0; m < moves.size(); ++m) {
      CHECK(moves[m].known_start == expected[m].known_start);
      CHECK(moves[m].known_end == expected[m].known_end);
      CHECK(moves[m].end_mm == expected[m].end_mm);
      CHECK(moves[m].feed_mm_min == expected[m].feed_mm_min);
      CHECK(moves[m].unit == expected[m].unit);
      CHECK(moves[m].frame == expected[m].frame);
      CHECK(moves[m].tool == expected[m].tool);
      CHECK(moves[m].operation == expected[m].operation);
      CHECK_FALSE(is_fixed(moves[m]));
    }
  }
}

TEST_CASE("a subprogram whose begin '/' may skip is refused: its body may run at its place") {
  for (const bool expands : {false, true}) {
    ReadOptions options;
    options.dialect = "linuxcnc";
    options.expand_subprograms = expands;
    const std::string text = origin_block + "/o1 sub\nX30.\n/o1 endsub\nX40.\n";
    CHECK(diagnostic_of([&] { read_program(text, "p.ngc", options); }).find("p.ngc:2:") == 0);
  }
}

TEST_CASE("behind a call arcs need G90.1 or G91.1 only where the control has them, and cycles never") {
  const std::string call = "M98 P100\nG90 G17 G98 G40 G0 X0. Y0. Z20.\n";
  const std::string arc = "G2 X10. Y10. I10. J0.\n", cycle = "G81 X10. Y10. Z-5. R2.\n";
  for (const char* dialect : {"fanuc", "haas"})
    CHECK(fixed_moves(call + arc + "G0 X0. Y0.\n" + cycle, dialect) ==
          Fixed{true, false, false, false, false});
  CHECK(fixed_moves(call + cycle, "mach3") == Fixed{true, false, false});
  CHECK(fixed_moves(call + arc, "mach3") == Fixed{true, false, true});
  CHECK(fixed_moves(call + "G91.1 " + arc, "mach3") == Fixed{true, false, false});
}

TEST_CASE("a block names the state that is unknown behind a call") {
  const auto why = [](const std::string& words, const std::string& block) {
    return read(origin_block + "M98 P100\n" + words + " X0. Y0. Z20.\n" + block, "mach3")
        .left_alone.back()
        .why;
  };
  const std::string arc = "G2 X10. Y10. I10. J0.\n", cycle = "G81 X10. Y10. Z-5. R2.\n";
  const std::string call = " is unknown (a condition, a call or a '/' block may have set it)";
  CHECK(why("G90 G17 G98 G0", arc) == "G90.1 or G91.1" + call);
  CHECK(why("G90 G98 G0", arc) == "G17, G18 or G19" + call);
  CHECK(why("G90 G17 G0", cycle) == "G98 or G99" + call);
  CHECK(why("G90 G17 G98", "X5.\n") == "its motion" + call);
}

TEST_CASE("numbered subprograms before or behind a program end at M99") {
  const std::string main = origin_block + "M98 P2\nM30\n", sub = "G1 X5.\nM99\n";
  CHECK(read("O1\n" + main + "O2\n" + sub).moves.size() == 2);
  const Program before = read("O2\n" + sub + "O1\n" + main);
  REQUIRE(before.moves.size() == 3);
  CHECK(is_fixed(before.moves[0]));
  CHECK_FALSE(is_fixed(before.moves[1]));
  CHECK(is_fixed(before.moves[2]));
  CHECK(is_fixed(read(":2\n" + sub + ":1\n" + main).moves[0]));
  // A single program repeats itself.
  CHECK(fixed_moves("X1.\nM99\n", "fanuc") == Fixed{false});
}

TEST_CASE("M99 of a main program is refused if the repetition begins with another state") {
  const auto refusal = [](const std::string& text, const char* dialect = "fanuc") {
    const std::string message = diagnostic_of([&] { read(text + "M99\n", dialect); });
    const std::size_t begin = message.find("its end ");
    return begin == std::string::npos ? message
                                      : message.substr(begin + 8, message.find(", which") - begin - 8);
  };
  const std::string begin = "O1\nG21 G90 G54 G17\nG0 X0. Y0. Z5.\n";
  CHECK(refusal(begin + "G1 X5. F100.\n") == "none");
  CHECK(refusal(begin + "G1 X5. F100.\nG55 G20 G18 G91\nG28 Z0.\n") == "none");
  CHECK(refusal(begin + "G52 X3. Y2.\n") == "G52 shifts the coordinates");
  CHECK(refusal(begin + "G52 X3. Y2.\nG52 X0. Y0. Z0.\n") == "none");
  CHECK(refusal("O1\nG52 X0. Y0. Z0.\n" + begin.substr(3) + "G52 X3. Y2.\n") == "none");
  CHECK(refusal(begin + "G92 X5.\n") == "G92 or G52 has set the coordinates");
  CHECK(refusal("O1\nG21 G92 X0. Y0. Z0.\n" + begin.substr(3)) == "G92 or G52 has set the coordinates");
  CHECK(refusal(begin + "G68 X0. Y0. R30.\n") == "the coordinates are rotated");
  CHECK(refusal(begin + "G68 X0. Y0. R30.\nG69\n") == "none");
  CHECK(refusal(begin + "G10 L2 P1 X5.\n") == "G10 has changed a work offset");
  CHECK(refusal("O1\nG21 G90 G10 L2 P1 X5.\n" + begin.substr(3)) == "none");
  CHECK(refusal("G21\nG0 X0. Y0. Z5.\nG55\n") == "the work offset is not G54");
  CHECK(refusal("G21\nG0 X0. Y0. Z5.\nG91\n") == "G91 is active");
  CHECK(refusal("G21\nG0 X0. Y0. Z5.\nG18\n") == "G17 is not active");
  CHECK(refusal(begin + "G1 X5. F100.\nT2 M6\n") == "the tool was changed");
  CHECK(refusal("O1\nG21 G90 G54 G17 T1 M6\nG0 X0. Y0. Z5.\nG1 X5. F100.\nT2 M6\n") == "none");
  const std::string plain = "O1\nG21 G90 G54 G17 G1 F100.\nG10 L2 P1 X5. Y5. Z5.\nX0. Y0. Z5.\n";
  CHECK(refusal(plain + "X5.\n") == "none");
  CHECK(refusal(plain + "G10 L2 P1 X6.\nX5.\n") == "G10 has changed a work offset");
  const std::string preset = "O1\nG21 G90 G54 G17 G92.1";
  CHECK(refusal(preset + "\n" + begin.substr(3) + "G92 Y5.\n") == "none");
  CHECK(refusal(preset + " X0\n" + begin.substr(3) + "G92 Y5.\n") == "G92 or G52 has set the coordinates");
  CHECK(refusal("G21\nG0 X0. Y0. Z5.\n/G18\n") == "G17 is not known to be active");
  CHECK(refusal("G52 X0 Y0 Z0\n" + begin.substr(3) + "G52 X3.\n", "mach3") == "none");
  CHECK(diagnostic_of([&] { read(begin.substr(3) + "G52 X3.\nM47\n", "mach3"); }).find("M47 repeats") !=
        std::string::npos);
}

TEST_CASE("a loop of Macro B is fixed, and GOTO makes the whole program fixed") {
  CHECK(fixed_moves("WHILE [#1 LT 5] DO1\nX1.\nEND1\nG0 X2.\n", "fanuc") == Fixed{true, false});
  CHECK(fixed_moves("IF [#1 EQ 0] THEN #2=5\nX2.\n", "fanuc") == Fixed{false});
  CHECK(fixed_moves("X1.\nIF [#1 EQ 0] GOTO 10\nX2.\nN10 X3.\n", "haas") == Fixed{true, true, true});
  CHECK(fixed_moves("X1.\n(GOTO WORK)\nX2.\n", "haas") == Fixed{false, false});
}

TEST_CASE("a second program behind the end is not changed, and gets a remark") {
  const Program program = read(origin_block + "M30\n%\nO2 whatever [\n");
  CHECK(program.remarks.at(0).what == "the text behind the end of the program is not changed");
  CHECK(read(origin_block + "M30\n%\n\n").remarks.empty());
}

TEST_CASE("a block with words behind an assignment or THEN has an unknown effect") {
  for (const char* const line : {"#1=5 G1 X20", "#1=#2 X20.", "IF[#1EQ1]THEN X20", "IF [#1 EQ 1] THENG1X20",
                                 "IF[#1EQ1]THEN #2=1 Y5"}) {
    CAPTURE(line);
    const Program program = read("O1\nG21 G90\nG0 X0 Y0 Z0\n" + std::string(line) + "\nY50.\n", "fanuc");
    REQUIRE(program.moves.size() == 3);
    CHECK(program.moves[1].fixed == std::array{true, true, true});
    CHECK(program.moves[2].fixed[1]);
  }
  for (const char* const line :
       {"#1=#2+SIN[#3]*5", "#1=#2MOD5", "#1=ATAN[1]/[2] (X20)", "IF[#1EQ1]THEN #2=#3AND5", "#1=ROUND[#2]"}) {
    CAPTURE(line);
    CHECK(read("O1\nG21 G90\nG0 X0 Y0 Z0\n" + std::string(line) + "\nG1 Y50. F100\n", "fanuc").moves.size() ==
          2);
  }
  const Program linuxcnc = read("G21 G90\nG0 X0 Y0 Z0\n#1=5 G1 X20 F100\n", "linuxcnc");
  CHECK(linuxcnc.moves.back().end_mm.x() == 20);
}

TEST_CASE("a feed mode or a tool of a condition or of a skippable block is unknown until it is stated") {
  const auto is_followed = [](const std::string& lines, const std::string& dialect) {
    return !is_fixed(read(origin_block + lines, dialect).moves.back());
  };
  CHECK_FALSE(is_followed("/G93\nG1 X5. F5\n", "linuxcnc"));
  CHECK(is_followed("/G93\nG94 G1 X5. F5\n", "linuxcnc"));
  CHECK_FALSE(is_followed("G93\no1 if [#1 EQ 7]\nG94\no1 endif\nG0 X0. Y0. Z0.\nG1 X5. F5\n", "linuxcnc"));
  CHECK_FALSE(is_followed("/T2 M6\nG0 X0. Y0. Z0.\nG1 X5.\n", "fanuc"));
  CHECK(is_followed("/T2 M6\nT3 M6\nG0 X0. Y0. Z0.\nG1 X5.\n", "fanuc"));
  const std::string choice = "T1\no1 if [#1 EQ 7]\nT2\no1 endif\n";
  CHECK(is_followed(choice + "G0 X0. Y0. Z0.\nG1 X5.\n", "linuxcnc"));
  CHECK_FALSE(is_followed(choice + "M6\nG0 X0. Y0. Z0.\nG1 X5.\n", "linuxcnc"));
  CHECK(is_followed(choice + "T2 M6\nG0 X0. Y0. Z0.\nG1 X5.\n", "linuxcnc"));
}

TEST_CASE("M99 P and M96 P of shop controls jump to a block number") {
  for (const char* const line : {"/M99 P100\n", "M99P100\n", "m99 p100\n"}) {
    CAPTURE(line);
    CHECK(fixed_moves(line + std::string("G1 X60.\nN100 Y20.\nM30\n"), "fanuc") == Fixed{true, true});
  }
  CHECK(fixed_moves("M96 P10 Q8\nG1 X60.\nN10 Y20.\nM30\n", "haas") == Fixed{true, true});
  CHECK(fixed_moves("M96 P10\nG1 X60.\nM30\n", "fanuc") == Fixed{false});
  CHECK(fixed_moves("G1 X60. (M99 P100)\nM30\n", "fanuc") == Fixed{false});
}

TEST_CASE("behind IF only GOTO and an assignment are known") {
  for (const char* const tail : {"THEN M98 P100", "M98 P100", "THEN M8", "GO 10"}) {
    CAPTURE(tail);
    const Program program =
        read(origin_block + "G1 X50. F100\nIF [#1 EQ 1] " + tail + "\nG1 Y20.\nM30\n", "haas");
    CHECK(is_fixed(program.moves.back()));
  }
  CHECK(fixed_moves("IF [#1 EQ 1] THEN #2=5\nG1 Y20.\nM30\n", "haas") == Fixed{false});
}

TEST_CASE("H alone changes the tool length while one acts on a shop control, and takes no inserted word") {
  const auto last = [](const std::string& lines, const std::string& dialect) {
    return read(origin_block + "G43 H1 Z10.\nG1 X50.\n" + lines, dialect).moves.back();
  };
  CHECK_FALSE(last("G1 X60. H2\n", "fanuc").may_insert_words);
  CHECK_FALSE(last("G1 X60. H0\n", "haas").may_insert_words);
  CHECK_FALSE(last("G1 X60. H2\nX70.\n", "fanuc").known_start[2]);
  CHECK(last("G1 X60. H1\nX70.\n", "fanuc").known_start[2]);
  CHECK(last("G49\nG1 X60. Z1. H2\nX70.\n", "fanuc").known_start[2]);
}
