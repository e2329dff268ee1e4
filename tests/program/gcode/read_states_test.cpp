#include <doctest/doctest.h>

#include <algorithm>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string known_start_block = "G21 G90 F100 G0 X0. Y0. Z10.\n";

bool stays(const Move& move) {
  return move.fixed[0] && !move.words[0] && !move.known_end[0];
}

}  // namespace

TEST_CASE("moves under a displacement are fixed, and moves after it are not") {
  struct State {
    const char *on, *off, *dialect, *why;
  };
  for (const State& s : {State{"G52 X#1", "G52 X0. Y0. Z0.", "fanuc", "G52 shifts the coordinates"},
                         State{"G92 X#1", "G92.1", "linuxcnc", "G92 has set the position"},
                         State{"G68 X0. Y0. R#1", "G69", "haas", "coordinates are rotated"},
                         State{"G51 X0. Y0. P2.", "G50", "fanuc", "coordinates are scaled"},
                         State{"G51.1 X0.", "G50.1 X0.", "fanuc", "coordinates are mirrored"},
                         State{"G16", "G15", "fanuc", "coordinates are polar"},
                         State{"G43.4 H1", "G49", "fanuc", "tool centre point control is active"},
                         State{"M428", "", "linuxcnc", "the kinematics were switched"},
                         State{"A90.", "A0.", "linuxcnc",
                               "a word of A, B, C, U, V or W is not zero: further axes are not supported; "
                               "write corners as ,C and ,R"},
                         State{"U.5", "", "linuxcnc",
                               "a word of A, B, C, U, V or W is not zero: further axes are not supported; "
                               "write corners as ,C and ,R"},
                         State{"G10 L2 P1 X#1", "", "linuxcnc", "G10 has set the work offset"},
                         State{"G10 L20 P2 X5\nG55", "", "grbl", "G10 has set the work offset"}}) {
    CAPTURE(s.on);
    const std::string ends = s.off;
    const Program program =
        read(known_start_block + s.on + "\nX1.\n" + ends + "\nX2. Y2. Z2.\nX3.\n", s.dialect);
    REQUIRE(program.moves.size() == 4);
    CHECK(stays(program.moves[1]));
    const auto& left = program.left_alone;
    CHECK(std::any_of(left.begin(), left.end(), [&](const LeftAlone& l) { return l.why == s.why; }));
    const bool for_good = ends.empty() || ends == "A0.";
    CHECK(stays(program.moves[3]) == for_good);
    CHECK(program.moves[2].known_start == std::array<bool, 3>{false, false, false});
  }
}

TEST_CASE(
    "positions of holes of a modal macro are corrected in the plane, its heights and the position after it "
    "are not") {
  const Program program =
      read(known_start_block + "G66 P9001 Z-5. R2.\nX1. Y2.\nX3.\nX#1\nG67\nG0 X4. Y5. Z6.\n", "fanuc");
  REQUIRE(program.moves.size() == 5);
  const Move &hole = program.moves[1], &next = program.moves[2], &variable = program.moves[3];
  CHECK((hole.words[0] && hole.words[1] && hole.end_mm.head<2>() == Vector3(1, 2, 0).head<2>()));
  CHECK(hole.fixed == std::array<bool, 3>{false, false, true});
  CHECK(hole.known_end == std::array<bool, 3>{false, false, false});
  CHECK((next.words[0] && !next.words[1] && next.fixed[2]));
  CHECK((variable.fixed[0] && !variable.words[0]));
  CHECK(all_known(program.moves[4].known_end));
  CHECK(program.left_alone.at(0).why == "every move calls a macro; its heights are not corrected");
}

TEST_CASE(
    "blocks that are not followed move only by program words, except on axes that the machine has moved by "
    "itself") {
  const auto moved_only = [](const std::string& blocks, const char* dialect = "linuxcnc") {
    return read(known_start_block + blocks + "\n", dialect).moves.back().moved_only_by_program;
  };
  CHECK(moved_only("X1 A90.\nX2") == std::array<bool, 3>{true, true, true});
  CHECK(moved_only("G53 Z0.\nA90.\nX2.") == std::array<bool, 3>{true, true, false});
  CHECK(moved_only("G28\nA90.\nX2.") == std::array<bool, 3>{});
  CHECK(moved_only("T1 M6\nA90.\nX2.", "haas") == std::array<bool, 3>{});
  CHECK(moved_only("T1 M6\nA90.\nX2.") == std::array<bool, 3>{true, true, true});
  CHECK(moved_only("o1 if [#1 GT 2]\nX2.") == std::array<bool, 3>{true, true, true});
  CHECK(moved_only("o1 sub\nX2.") == std::array<bool, 3>{});
  CHECK(moved_only("G53 Z0.\nX2.") == std::array<bool, 3>{});
}

TEST_CASE("words of zero for axes other than X, Y and Z are ignored, and a shift of zero is not a shift") {
  const Program program = read(known_start_block + "A0 B0. C-0.0 X1\nG52 X0 Y0\nX2\n");
  CHECK(program.left_alone.empty());
  CHECK(program.moves[2].known_start == std::array<bool, 3>{true, true, true});
}

TEST_CASE("G10 for another work offset applies when that offset is selected") {
  const Program program = read(known_start_block + "G54 X1 Y1 Z1\nG10 L2 P2 X#1\nX2\nG55 X3\nG54 X4\n");
  CHECK_FALSE(stays(program.moves[2]));
  CHECK(program.moves[2].known_start[0]);
  CHECK(stays(program.moves[3]));
  CHECK_FALSE(stays(program.moves[4]));
}

TEST_CASE("G10 for tools makes their known lengths invalid") {
  ReadOptions options;
  options.tool_lengths_mm = {{1, 50}};
  const auto read_with = [&](const std::string& block, const std::string& dialect = "linuxcnc") {
    options.dialect = dialect;
    return read_program(known_start_block + block + "\nG43 H1 Z2.\nX1.\n", "p.nc", options);
  };
  const auto refusal = [&](const std::string& block, const std::string& dialect = "linuxcnc") {
    const std::string message = diagnostic_of([&] { read_with(block, dialect); });
    return message.find("may set the length of T1, which is given as 50 mm") != std::string::npos;
  };
  CHECK(refusal("G10 L1 P1 Z30"));
  CHECK(refusal("G10 L1 P#1 Z30"));
  CHECK(refusal("G10 L11 P1 Z50"));
  CHECK(refusal("G10 L1 P1 Z30", "mach3"));
  for (const char* words : {"L10 P1 R150.", "P1 R300.", "L1 P1 R50.", "L11 P1 R1.", "L10 P#1 R60."}) {
    CAPTURE(words);
    CHECK(refusal(std::string("G10 ") + words, "fanuc"));
  }
  CHECK(refusal("G91 G10 L10 P1 R50.\nG90", "fanuc"));
  // The same length, a radius, or another tool.
  for (const char* words : {"L10 P1 R50.", "L12 P1 R5.", "L10 P2 R60."}) {
    CAPTURE(words);
    const Program program = read_with(std::string("G10 ") + words, "fanuc");
    CHECK(program.remarks.empty());
    CHECK(program.moves.back().known_end[2]);
  }
  CHECK(read_with("G10 L1 P1 Z50").remarks.empty());
}

TEST_CASE("parameters between G10 L50 and G11 do not move") {
  const Program program = read(known_start_block + "G10 L50\nN1815 P1 R00100000\nN3 R5\nG11\nX1.\n", "fanuc");
  CHECK(program.moves.size() == 2);
}

TEST_CASE("additional work offsets have one name in all their spellings") {
  const auto name = [](const std::string& code, const std::string& dialect) {
    const Program program = read("G21 " + code + "\nG0 X1.\n", dialect);
    return program.frames[program.moves[0].frame].work_offset;
  };
  CHECK(name("G54.1 P3", "fanuc") == "G54.1 P3");
  CHECK(name("G54 P3", "fanuc") == "G54.1 P3");
  CHECK(name("G154 P3", "haas") == "G54.1 P3");
  CHECK(name("G112", "haas") == "G54.1 P3");
  CHECK(name("G59.3", "linuxcnc") == "G59.3");
}

TEST_CASE("states set in a skippable block are unknown, and not an error") {
  for (const char* block : {"/G20", "/G55", "/G1", "/G91"}) {
    CAPTURE(block);
    const Program program = read(known_start_block + block + "\nX1\nG21 G54 G0 G90 X2 Y2 Z2\nX3\n");
    CHECK(stays(program.moves[1]));
    CHECK_FALSE(stays(program.moves[3]));
    CHECK(program.left_alone.at(0).line == 3);
  }
}

TEST_CASE("probing, splines and threads are held; the position after probing is unknown") {
  for (const char* block : {"G38.2 X5 F10", "G33 X5 K1", "G5 I1 J1 P1 Q1 X5 Y5"}) {
    CAPTURE(block);
    const Program program = read(known_start_block + block + "\n");
    CHECK(program.moves[1].handling == Handling::held);
    CHECK(program.moves[1].words[0].has_value());
    CHECK_FALSE(program.moves[1].may_split);
  }
  CHECK_FALSE(read(known_start_block + "G38.2 X5 F10\n").moves[1].known_end[0]);
  CHECK(read(known_start_block + "G31 X5. F10.\nX6.\n", "fanuc").moves[2].motion == Motion::rapid);
}

TEST_CASE("the way of a spline or a pocket is not that from its start to its end") {
  for (const auto& feed :
       {std::pair{"G5 I1 J1 P1 Q1 X5 Y5", "linuxcnc"}, std::pair{"G5.1 I1 J1 X5 Y5", "linuxcnc"},
        std::pair{"G13 Z-2. I5. K10. Q1. D1 F50.", "haas"}}) {
    CAPTURE(feed.first);
    const Move move = read(known_start_block + feed.first + "\n", feed.second).moves.at(1);
    CHECK_FALSE(all_known(move.known_start));
    CHECK(all_known(move.known_end));
    CHECK(all_known(move.moved_only_by_program));
  }
  CHECK(all_known(read(known_start_block + "G5 P10000\nG1 X5. F100.\n", "fanuc").moves.at(1).known_start));
}

TEST_CASE("pockets end at their start, motions defined by the control are fixed") {
  const Program pocket = read(known_start_block + "G13 Z-2. I5. K10. Q1. D1 F50.\nX1.\n", "haas");
  CHECK(pocket.moves[1].handling == Handling::held);
  CHECK(pocket.moves[1].end_mm == Vector3(0, 0, -2));
  const Program own = read(known_start_block + "G150 P10 X1. Y2. Z-1. Q.1 F15.\n", "haas");
  CHECK(own.moves[1].fixed == std::array<bool, 3>{true, true, true});
}

TEST_CASE("engraved text is shifted with its depth and its plane, and its end is unknown") {
  const std::string start = known_start_block, text = "G47 P0 (TEXT) X1. Y2. I0. J.1 R.5 Z-.005 F15. E10.\n";
  const Program program = read(start + text + "X3. Y4. Z5.\n", "haas");
  const Move& move = program.moves[1];
  CHECK(move.handling == Handling::held);
  CHECK(move.known_end == std::array<bool, 3>{});
  CHECK(rewrite(program, edits_to_original(program), {}).text == program.text);
  const MoveEdit edit{.move = 1,
                      .end_mm = move.end_mm + Vector3(.5, -.25, .125),
                      .bottom_mm = move.cycle->bottom_mm + .125,
                      .retract_mm = move.cycle->retract_mm + .125};
  CHECK(rewrite(program, {edit}, {}).text ==
        start + "G47 P0 (TEXT) X1.5 Y1.75 I0. J.1 R.625 Z.120 F15. E10.\nX3. Y4. Z5.\n");
  for (const char* fixed : {"G91 G47 P0 X1. Y2. J.1 R.5 Z-.005\n", "G47 P0 X#1 Y2. J.1 R.5 Z-.005\n",
                            "G47 P0 X1. Y2. J.1 Z-.005\n"}) {
    CAPTURE(fixed);
    CHECK(read(start + fixed, "haas").moves[1].fixed[0]);
  }
}

TEST_CASE("mach3 reads G70 and G71 as units, returns to G0 after G80 and reads unclosed comments") {
  const Program program = read("G70 G0 X1\nG71 X1 (open\nG81 X2 Z-1 R1\nG80\nX3\n", "mach3");
  CHECK(program.moves[0].end_mm.x() == doctest::Approx(25.4));
  CHECK(program.moves[1].end_mm.x() == 1);
  CHECK(program.moves[3].motion == Motion::rapid);
}

TEST_CASE("after an unknown code no move is followed, and the program is reproduced unchanged") {
  const std::string text = "O1\n" + known_start_block + "G0 X1. Y1.\nG333 X2. P3\nG0 X4. Y5. Z6.\nG1 X7.\n";
  const Program program = read(text);
  REQUIRE(program.moves.size() == 5);
  CHECK(program.moves[2].fixed == std::array<bool, 3>{true, true, true});
  CHECK(program.moves[2].moved_only_by_program == std::array<bool, 3>{true, true, true});
  for (const std::size_t later : {3u, 4u}) CHECK(stays(program.moves[later]));
  CHECK(program.left_alone.at(0).why == "G333 is not known in dialect fanuc");
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  CHECK_THROWS_WITH(read(text, "linuxcnc"), doctest::Contains("G333 is not known in dialect linuxcnc"));
}

TEST_CASE("polar interpolation displaces positions until it ends") {
  for (const std::string on : {"G112\n", "G12.1\n"}) {
    const Program program = read("O1\n" + known_start_block + on + "G1 X1.\n" +
                                 (on == "G112\n" ? "G113" : "G13.1") + "\nX2. Y2. Z2.\n");
    CHECK(stays(program.moves[1]));
    CHECK(all_known(program.moves[2].known_end));
  }
}

TEST_CASE("G70 and G71 of shop controls are units if they have no pattern of holes") {
  CHECK(read("O1\nG70 G90\nG0 X1.\n").moves.at(0).end_mm.x() == doctest::Approx(25.4));
  CHECK(read("O1\nG71 G90\nG0 X1.\n").moves.at(0).end_mm.x() == 1);
  CHECK(read("O1\n" + known_start_block + "G70 I5. J0. L6\n", "haas").moves.at(1).fixed[0]);
}

TEST_CASE("the blocks of a corner are not split, but their ends are corrected") {
  const std::string text = "O1\n" + known_start_block + "G1 X20.,R3.\nY20. ,C2.\nX0.\nY0.\nZ5.\n";
  const Program program = read(text);
  REQUIRE(program.moves.size() == 6);
  for (const std::size_t corner : {1u, 2u, 3u}) {
    CHECK_FALSE(program.moves[corner].may_split);
    CHECK_FALSE(program.moves[corner].may_jump);
  }
  CHECK(program.moves[4].may_split);
  CHECK(program.moves[1].end_mm.x() == 20);
  CHECK(rewrite(program, {{.move = 1, .end_mm = {20.5, .25, 10}}}, {}).text.find("G1 X20.5 Y0.250,R3.\n") !=
        std::string::npos);
}

TEST_CASE("after M25 no inserted word of Z moves back to the tool's position before it") {
  const std::string text = known_start_block + "M25\nX300. Y200.\nZ10.\n";
  const Program program = read(text);
  CHECK(program.moves.at(1).known_end == std::array<bool, 3>{true, true, false});
  CHECK(rewrite(program, {{.move = 1, .end_mm = {300, 200, 10.5}}}, {}).text == text);
}

TEST_CASE("of two tools in a block the first one is loaded") {
  CHECK(read("O1\nG21 G90 T3 T4 M6\nG0 X1.\n").moves.at(0).tool == 3);
  CHECK_THROWS(read("G21 G90 T3 T4 M6\nG0 X1.\n"));
}

TEST_CASE("M61 states the tool in the spindle, and the machine stays") {
  const Program program = read("G21 G90 G0 X0 Y0 Z0\nM61 Q2\nG0 X1.\n");
  CHECK(program.moves.at(1).tool == 2);
  CHECK(program.moves.at(1).known_start == std::array<bool, 3>{true, true, true});
  CHECK_THROWS(read("G21 G90 G0 X0 Y0 Z0\nM60 Q2\nG0 X1.\n"));
}

TEST_CASE("a repeated code is read once on shop controls") {
  CHECK(read("O1\nG21 G90 G0 G90 G0 X1.\n").moves.size() == 1);
  CHECK_THROWS(read("O1\nG21 G90 G0 G91 X1.\n"));
}

TEST_CASE("comments may be nested and N may be anywhere if the control allows it") {
  CHECK(read("O1\nG21 G0 X1. (A (B C) N5\nN7 X2.\n").moves.size() == 2);
  CHECK(read("G21 G0 X1 N5 (no end\n", "grbl").moves.at(0).block_number == 5);
}

TEST_CASE(
    "the end of a mirror image, of a modal call or of a position is that of the named axes or call only") {
  const auto followed = [](const std::string& blocks, const char* dialect = "fanuc") {
    const Program program = read(known_start_block + blocks + "\nX2. Y2. Z2.\nX3.\n", dialect);
    return !stays(program.moves.back());
  };
  CHECK_FALSE(followed("G51.1 X0. Y0.\nG50.1 Y0."));
  CHECK(followed("G51.1 X0. Y0.\nG50.1 Y0.\nG50.1 X0."));
  CHECK(followed("G51.1 X0. Y0.\nG50.1"));
  CHECK_FALSE(followed("G101 X0. Y0.\nG100 Y0.", "haas"));
  CHECK(followed("G101 X0. Y0.\nG100 X0. Y0.", "haas"));
  CHECK_FALSE(followed("/G51.1 Y0.\nG50.1 X0."));
  CHECK_FALSE(followed("G92 X#1 Y#2\nG92.1 X0."));
  CHECK(followed("G92 X#1 Y#2\nG92.1 X0. Y0. Z0."));
  const auto calls = [](const std::string& blocks) {
    return read(known_start_block + blocks + "\nX2. Y2. Z2.\n", "fanuc").moves.back().makes_hole;
  };
  CHECK(calls("G66 P9001\nG66 P9002\nG67"));
  CHECK_FALSE(calls("G66 P9001\nG66 P9002\nG67\nG67"));
  CHECK_FALSE(calls("G66 P9001\nG67\nG66 P9001\nG67"));
}

TEST_CASE("G100 and G101 of Haas mirror about their words and do not move") {
  CHECK(read(known_start_block + "G1 X1.\nG100 X0\nX2.\n", "haas").moves.size() == 3);
  CHECK(read(known_start_block + "G1 X1.\nG101 X0\nX2.\n", "haas").moves.size() == 3);
}

TEST_CASE("codes that only Haas has are unknown on a Fanuc, and so is G100 with a tool of Brother") {
  const auto followed = [](const std::string& block, const char* dialect) {
    const Program program = read(known_start_block + block + "\nX2. Y2. Z2.\nX3.\n", dialect);
    return !stays(program.moves.back());
  };
  for (const char* block : {"G100 X0.", "G101 X0.\nG50.1", "G103 P1", "G187 P1"}) {
    CAPTURE(block);
    CHECK_FALSE(followed(block, "fanuc"));
  }
  CHECK(followed("G103 P1", "haas"));
  CHECK(followed("G187 P1", "haas"));
  const std::string change = "G100 T2 X100. Y200. G43 Z50. H2";
  CHECK_FALSE(followed(change, "fanuc"));
  CHECK_FALSE(followed(change, "haas"));
  CHECK(stays(read("O1\n" + known_start_block + change + "\nX2. Y2. Z2.\nX3.\n").moves.back()));
}

TEST_CASE("G5 of Fanuc switches modes, and moves axes with P10001 to P10999") {
  const auto position_known = [](const std::string& words) {
    return read(known_start_block + "G05 " + words + "\nX2.\n", "fanuc").moves.back().known_end[1];
  };
  for (const char* words : {"P0", "P1", "P2", "P10000"}) CHECK(position_known(words));
  for (const char* words : {"P10001", "P10999 L2", "P#1"}) CHECK_FALSE(position_known(words));
}

TEST_CASE("G92 with S and without an axis limits the speed of the spindle and sets no position") {
  const Program program = read(known_start_block + "G92 S2000\nG1 X1. F100.\n", "fanuc");
  CHECK_FALSE(stays(program.moves.back()));
  CHECK(program.moves.back().frame == program.moves.front().frame);
}

TEST_CASE("G92.1 of Fanuc presets the named axes to the work offset and does not move") {
  const Program program = read(known_start_block + "G92 X5. Y6. Z7.\nG92.1 X0. Z0.\nG1 X1.\nY3.\n", "fanuc");
  REQUIRE(program.moves.size() == 4);
  const ProgramFrame& frame = program.frames[program.moves.back().frame];
  CHECK(frame.origin_mm == Vector3(0, -6, 0));
  CHECK(program.moves[2].start_mm == Vector3(0, 6, 10));
  CHECK(program.moves[2].known_start == std::array{true, true, true});
}

TEST_CASE("G10 L2 P0 of Fanuc and Haas shifts all work offsets") {
  for (const char* const dialect : {"fanuc", "haas"}) {
    CAPTURE(dialect);
    const Program program =
        read(known_start_block + "G54 X1. Y1. Z1.\nG10 L2 P0 X100.\nG55 X2. Y2. Z2.\nX3.\n", dialect);
    CHECK(stays(program.moves.back()));
  }
  CHECK_FALSE(
      stays(read(known_start_block + "G54 X1 Y1 Z1\nG10 L2 P0 X#1\nG55 X2 Y2 Z2\nX3\n").moves.back()));
}

TEST_CASE("reference positions of an option are machine positions, as those of G28 and G30") {
  struct Code {
    const char *words, *dialect;
  };
  for (const Code& code : {Code{"G30.1 X0. Y0. Z5.", "fanuc"}, Code{"G28.1 X0. Y0. Z5.", "mach3"}}) {
    CAPTURE(code.words);
    const Program program = read(known_start_block + code.words + "\nG1 X2.\n", code.dialect);
    REQUIRE(program.moves.size() == 2);
    CHECK(program.moves[1].known_start == std::array{false, false, false});
  }
  CHECK(read(known_start_block + "G28.1\nG1 X2.\n").moves[1].known_start == std::array{true, true, true});
}

TEST_CASE("M16 of Haas is a tool change") {
  const Program program = read(known_start_block + "T2 M16\nG1 X2.\n", "haas");
  CHECK(program.moves[1].known_start == std::array{false, false, false});
  CHECK(program.moves[1].tool == 2);
}

TEST_CASE("P of G59 selects a work offset of Mach3 by its number") {
  const auto offset = [](const std::string& code) {
    const Program program = read("G21 G90 " + code + "\nG0 X1\n", "mach3");
    return program.frames[program.moves[0].frame].work_offset;
  };
  CHECK(offset("G59 P3") == "G56");
  for (const char* const block : {"G54 G64 P0.5", "G10 L2 P1 X0 Y0 Z0 G54", "G54 G82 X1 Y1 Z-1 R2 P0.5 F100"})
    CHECK(offset(block) == "G54");
  CHECK(offset("G59") == "G59");
  CHECK(diagnostic_of([&] { offset("G59 P7"); }).find("G59 P7 selects a work offset") != std::string::npos);
  CHECK(diagnostic_of([&] { offset("G54 P20"); }).find("G54 P20 selects a work offset") != std::string::npos);
}

TEST_CASE("axis words select the axes of smooth interpolation, and D of G96 is a limit") {
  for (const char* const words : {"G5.1 Q2 X0 Y0 Z0", "G5.1 Q3 X0 Y0", "G5.1 Q0 X0 Y0 Z0"}) {
    CAPTURE(words);
    const std::string text = known_start_block + words + "\nG1 X2.\n";
    if (words[6] == '0') {
      CHECK_FALSE(diagnostic_of([&] { read(text, "fanuc"); }).empty());
      continue;
    }
    const Program program = read(text, "fanuc");
    REQUIRE(program.moves.size() == 2);
    CHECK(program.moves[1].known_start == std::array{true, true, true});
  }
  CHECK(read(known_start_block + "G96 D1000 S50 M3\nG1 X2\n").moves.size() == 2);
}
