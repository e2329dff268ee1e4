#include "counterflex/program/read_program.hpp"

#include <doctest/doctest.h>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

using Known = std::array<bool, 3>;

std::string number_text(const Program& program, const Move& move, std::size_t axis) {
  const Span span = move.words[axis]->number;
  return program.text.substr(span.begin, span.end - span.begin);
}

}  // namespace

TEST_CASE("motion, units, feed, spindle, offset and block number are modal") {
  const Program program =
      read("%\nG20 G90 G54\nN10 G0 X1. Y2. Z.5\nS800 M3\nN20 G1 Z-.25 F10.\nX-1.5 Y2.\n%\n");
  REQUIRE(program.moves.size() == 3);
  const Move& plunge = program.moves[1];
  CHECK(plunge.motion == Motion::feed);
  CHECK(plunge.line == 5);
  CHECK(plunge.block_number == 20);
  CHECK(plunge.unit == LengthUnit::inches);
  CHECK(plunge.feed_mm_min == doctest::Approx(254));
  CHECK(plunge.spindle_rpm == 800);
  CHECK(program.frames[plunge.frame].work_offset == "G54");
  CHECK(plunge.start_mm.isApprox(Vector3(25.4, 50.8, 12.7)));
  CHECK(plunge.end_mm.isApprox(Vector3(25.4, 50.8, -6.35)));
  const Move& cut = program.moves[2];
  CHECK_FALSE(cut.block_number.has_value());
  CHECK(cut.end_mm.isApprox(Vector3(-38.1, 50.8, -6.35)));
  CHECK(cut.feed_mm_min == doctest::Approx(254));
  CHECK(program.block_count == 5);
}

TEST_CASE("spans include blanks inside the number, and its decimals are counted") {
  const Program program = read("g21\ng1 x 1 0. 5 0y-.25 Z+3\n");
  const Move& move = program.moves.at(0);
  CHECK(number_text(program, move, 0) == "1 0. 5 0");
  CHECK(number_text(program, move, 1) == "-.25");
  CHECK(number_text(program, move, 2) == "+3");
  CHECK(move.words[0]->decimals == 2);
  CHECK(move.words[2]->decimals == 0);
  CHECK(move.end_mm == Vector3(10.5, -0.25, 3));
  CHECK(program.text.substr(move.block.begin, move.block.end - move.block.begin) == "g1 x 1 0. 5 0y-.25 Z+3");
}

TEST_CASE("an axis is unknown until it is programmed") {
  const Program program = read("G21 G0 X1 Y2\nZ3\nX4\n");
  CHECK(program.moves[0].known_start == Known{false, false, false});
  CHECK(program.moves[0].known_end == Known{true, true, false});
  CHECK(program.moves[1].known_end == Known{true, true, true});
  CHECK(program.moves[2].known_start == Known{true, true, true});
  CHECK(program.moves[2].block_index == 2);
}

TEST_CASE("machine positions are not corrected, with their reason, and make their axes unknown") {
  const Program program = read("G21 G0 X1 Y2 Z3\nG53 Z0\nX5\nG28 X1\nY5\nG30\nX1\n");
  REQUIRE(program.moves.size() == 4);
  CHECK(program.moves[1].known_start == Known{true, true, false});
  CHECK(program.moves[2].known_start == Known{false, true, false});
  CHECK(program.moves[3].known_start == Known{false, false, false});
  REQUIRE(program.left_alone.size() == 3);
  CHECK(program.left_alone[0].line == 2);
  CHECK(program.left_alone[0].why == "G53 moves to a position of the machine");
  CHECK(program.left_alone[2].why == "G30 moves to a position of the machine");
}

TEST_CASE("a tool change makes no axis unknown in linuxcnc, all in fanuc, and otherwise the given ones") {
  const std::string text = "G21 G0 X1. Y2. Z3.\nT2 M6\nX5.\n";
  CHECK(read(text).moves[1].known_start == Known{true, true, true});
  CHECK(read("O1\n" + text).moves[1].known_start == Known{false, false, false});
  ReadOptions options;
  options.tool_change_moves = {'Z'};
  CHECK(read_program(text, "", options).moves[1].known_start == Known{true, true, false});
  options.tool_change_moves.emplace();
  CHECK(read_program("O1\n" + text, "", options).moves[1].known_start == Known{true, true, true});
  CHECK(read("G21 G0 X1. Y2. Z3.\nT2\nX5.\n", "fanuc").moves[1].known_start == Known{true, true, true});
}

TEST_CASE("an axis set by a skippable block is known at its end and unknown after it") {
  const Program program = read("G21 G0 X1 Y2 Z3\n/ G0 X5\nY1\nX2\n");
  CHECK(program.moves[1].block_delete);
  CHECK(program.moves[1].known_end == Known{true, true, true});
  CHECK(program.moves[2].known_start == Known{false, true, true});
  CHECK(program.moves[3].known_end == Known{true, true, true});
}

TEST_CASE("a skippable end of program does not end it, any other does") {
  CHECK(read("G21 G0 X1\n/M30\nX2\n").moves.size() == 2);
  CHECK(read("G21 G0 X1\nM30\nX2 <<<< second program\n").moves.size() == 1);
  CHECK(read("G21 G0 X1\nM02 X2\nX3\n").moves.size() == 2);
  CHECK(read("%\nG21 G0 X1\n%\nwhatever [#\n").moves.size() == 1);
}

TEST_CASE("a change of work offset makes every axis unknown") {
  const Program program = read("G21 G54 G0 X1 Y2 Z3\nG54 X2\nG55 X3\n");
  CHECK(program.moves[1].known_start == Known{true, true, true});
  CHECK(program.moves[2].known_start == Known{false, false, false});
  CHECK(program.frames[program.moves[2].frame].work_offset == "G55");
}

TEST_CASE(
    "a tool length that changes without Z makes Z unknown; with Z the tip is at the programmed position") {
  const Program unknown = read("G21 G0 X1 Y2 Z3\nG43 H1\nX2\nG49\nX3\n");
  CHECK(unknown.moves[1].known_start == Known{true, true, false});
  CHECK(unknown.moves[2].known_start == Known{true, true, false});
  const Program known = read("G21 G0 X1 Y2\nG43 Z15 H1\nG43 H1 X2\n");
  CHECK(known.moves[1].known_start == Known{true, true, false});
  CHECK(known.moves[1].known_end == Known{true, true, true});
  CHECK(known.moves[2].known_start == Known{true, true, true});
  CHECK_FALSE(known.moves[1].may_insert_words);
  REQUIRE(known.remarks.size() == 1);
  CHECK(known.remarks[0].what ==
        "G43: the length of T1 is not known; the tip of [tool] is used (give length_mm in [tools.T1], "
        "--tool-table, or --tool-length T1=MM)");
}

TEST_CASE("with given tool lengths the remark is about a tool without a length") {
  ReadOptions options;
  options.tool_lengths_mm = {{1, 50.0}};
  const Program program = read_program("G21 G0 X1 Y2\nG43 Z15 H1\nG43 Z15 H7\n", "part.ngc", options);
  REQUIRE(program.remarks.size() == 1);
  CHECK(program.remarks[0].line == 3);
  CHECK(program.remarks[0].what.starts_with("G43: the length of T7 is not known"));
}

namespace {

std::vector<Remark> remarks_with_lengths(const std::string& text, const std::string& dialect = "linuxcnc") {
  ReadOptions options;
  options.dialect = dialect;
  options.tool_lengths_mm = {{1, 80.0}, {2, 120.0}, {12, 120.0}};
  return read_program(text, "p.ngc", options).remarks;
}

}  // namespace

TEST_CASE("the length of another offset than that of the tool in the spindle is a warning") {
  const std::string cut = "G0 X0 Y0 Z9\nG1 Z0 F100\nX5\nX6\n";
  const auto other = remarks_with_lengths("G21 T2 M6\nG43 H1\n" + cut);
  REQUIRE(other.size() == 1);
  CHECK(other[0].line == 2);
  CHECK(
      other[0].what ==
      "H1 (80 mm) acts while T2 (120 mm) is in the spindle; the tip of T2 is used: see that offset 1 of the "
      "control holds the length of T2, or program H2");
  const auto unlisted = remarks_with_lengths("G21 T3 M6\nG0 G43 H23 Z9.\n" + cut, "fanuc");
  REQUIRE(unlisted.size() == 1);
  CHECK(
      unlisted[0].what.starts_with("H23 (length not known) acts while T3 (length not known) is in the "
                                   "spindle; the tip of [tool] is used"));
  CHECK(remarks_with_lengths("G21 T2 M6\nG43 H12\n" + cut).empty());
  CHECK(remarks_with_lengths("G21 T2 M6\nG43 H2\n" + cut).empty());
  CHECK(remarks_with_lengths("G21 T2 M6\nG43\n" + cut).empty());
  CHECK(remarks_with_lengths("G21 T2 M6\nG49\n" + cut).empty());
}

TEST_CASE("the length of the tool before is a warning where the next tool cuts") {
  const std::string first = "G21 T1 M6\nG43 H1\nG0 X0 Y0 Z9\nG1 Z0 F100\nG0 Z9\n";
  const auto kept = remarks_with_lengths(first + "T2 M6\nG0 X1\nG1 Z0\n");
  REQUIRE(kept.size() == 1);
  CHECK(kept[0].line == 8);
  CHECK(kept[0].what.starts_with("H1 (80 mm) acts while T2 (120 mm) is in the spindle"));
  CHECK(remarks_with_lengths(first + "T2 M6\nG98 G81 X1 Z-3 R1\n").size() == 1);
  CHECK(remarks_with_lengths(first + "T2 M6\nG0 X1\nG43 H2\nG1 Z0\n").empty());
  CHECK(remarks_with_lengths(first + "G53 G0 Z0\nT2 M6\nG1 X9\nG0 G43 H2 Z9\nG1 Z0\n").empty());
  CHECK(remarks_with_lengths(first + "T2\nG43 H2\nM6\nG1 Z0\n").empty());
}

TEST_CASE("a cut without a tool length is a warning where the program uses G43, once for each tool") {
  const std::string cut = "G0 X0 Y0 Z9\nG1 Z0 F100\nX5\nX6\n", with_length = "T2 M6\nG43 H2\n" + cut;
  const auto behind = remarks_with_lengths("G21 " + with_length + "G49\nT1 M6\n" + cut + "G49\n" + cut);
  REQUIRE(behind.size() == 1);
  CHECK(behind[0].line == 10);
  CHECK(behind[0].what ==
        "T1 (80 mm) cuts where the program applies no tool length (G49, or before the first G43); the tip of "
        "T1 is used: see that the work offset includes the length of T1, or program it (G43)");
  const auto before = remarks_with_lengths("G21 T1 M6\n" + cut + with_length + "G49\nT2 M6\n" + cut);
  REQUIRE(before.size() == 2);
  CHECK(before[0].line == 3);
  CHECK(before[0].what.starts_with("T1 (80 mm) cuts where the program applies no tool length"));
  CHECK(before[1].line == 15);
  CHECK(before[1].what.starts_with("T2 (120 mm) cuts where"));
  const auto hole =
      remarks_with_lengths("G21 " + with_length + "G49\nT1 M6\nG0 X0 Y0 Z9\nG98 G81 X1 Z-3 R1\n");
  REQUIRE(hole.size() == 1);
  CHECK(hole[0].what.starts_with("T1 (80 mm) cuts where"));
}

TEST_CASE("a tool length that acts, that is 0, or that no block uses is no warning about cuts without one") {
  const std::string cut = "G0 X0 Y0 Z9\nG1 Z0 F100\nX5\nX6\n", with_length = "T2 M6\nG43 H2\n" + cut;
  CHECK(remarks_with_lengths("G21 T1 M6\n" + cut + "G49\nT2 M6\n" + cut).empty());
  CHECK(remarks_with_lengths("G21 G49 " + with_length + "G49\nT1 M6\nG43 H1\n" + cut).empty());
  CHECK(remarks_with_lengths("G21 " + with_length + "G49\nG0 Z9\nT1 M6\nG0 X1\n").empty());
  ReadOptions options;
  options.tool_lengths_mm = {{1, 0.0}, {2, 120.0}};
  CHECK(read_program("G21 T1 M6\n" + cut + with_length, "p.ngc", options).remarks.empty());
}

TEST_CASE("a remark about an unknown length names the tip that is used") {
  const auto remark = [](const std::string& length) {
    const auto remarks = remarks_with_lengths("G21 T2 M6\n" + length + "\nG0 X0 Y0 Z9\nG1 Z0 F100\n");
    return remarks.size() == 1 ? remarks[0].what : "";
  };
  CHECK(remark("G43.1 Z118") == "G43.1: the length that it sets is not followed; the tip of T2 is used");
  CHECK(remark("G43.2 H3") == "G43.2: the length that it sets is not followed; the tip of T2 is used");
  CHECK(remark("G43 H0") == "G43: the length under H0 is not known; the tip of T2 is used");
  CHECK(remark("G43 H#1") == "G43: the value of H is not known; the tip of T2 is used");
}

TEST_CASE("H that is not a whole number from 0 on is refused") {
  for (const std::string h : {"H-1", "H2.5"})
    CHECK(diagnostic_of([&] { read("G21 T2 M6\nG43 " + h + "\n"); }) ==
          "p.ngc:2:5: error: " + h + " is not the number of a tool offset; use a whole number from 0 on");
}

TEST_CASE("after G80 fanuc and haas return to G0, linuxcnc and grbl need a motion word") {
  const std::string text = "G21 G1 X1. F100\nG80\nX2.\n";
  CHECK(read(text, "fanuc").moves[1].motion == Motion::rapid);
  CHECK(read(text, "haas").moves[1].motion == Motion::rapid);
  CHECK(diagnostic_of([&] { read(text, "linuxcnc"); }) ==
        "p.ngc:3:1: error: X without a motion: after G80, linuxcnc needs G0 or G1 again");
  CHECK(diagnostic_of([&] { read(text, "grbl"); }) ==
        "p.ngc:3:1: error: X without a motion: after G80, grbl needs G0 or G1 again");
  CHECK(read("G21 G0 G80 X1\n").moves.size() == 1);
}

TEST_CASE("words of a dwell are not axis words") {
  const Program program = read("O1\nG21 G0 X1. Y1. Z1.\nG4 X1.5\nG4 P500\nY2.\n");
  REQUIRE(program.moves.size() == 2);
  CHECK(program.moves[1].start_mm == Vector3(1, 1, 1));
  CHECK(read("G21 G0 X1 Y1 Z1\nG4 P.5\nX2\n").moves.size() == 2);
}

TEST_CASE("the option sets the unit, and a unit in the program overrides it") {
  ReadOptions options;
  options.unit = LengthUnit::inches;
  CHECK(read_program("G0 X1\n", "", options).moves[0].end_mm.x() == doctest::Approx(25.4));
  CHECK(read_program("G21 G0 X1\n", "", options).moves[0].end_mm.x() == 1);
  CHECK(read("F10\nG20 G1 X1\n").moves[0].feed_mm_min == doctest::Approx(254));
  CHECK(read("G1 G21 X1\n").moves[0].feed_mm_min == 0);
}

TEST_CASE("feed per turn is multiplied by the spindle speed") {
  const Program program = read("G21 G95 S1000 M3\nG1 X1 F.2\nG94 X2\nX3 F50\n");
  CHECK(program.moves[0].feed_mm_min == doctest::Approx(200));
  CHECK(program.moves[1].feed_mm_min == 0);
  CHECK(program.moves[2].feed_mm_min == 50);
}

TEST_CASE("linuxcnc resets F at any feed mode, and reads F beside a unit in the unit before") {
  CHECK(read("G21 F100\nG94 G1 X1.\n").moves[0].feed_mm_min == 0);
  CHECK(read("G21 F100\nG94 G1 X1.\n", "grbl").moves[0].feed_mm_min == 100);
  CHECK(read("G21\nG20 F10\nG1 X1.\n").moves[0].feed_mm_min == 10);
  CHECK(read("G21\nG20 F10\nG1 X1.\n", "fanuc").moves[0].feed_mm_min == doctest::Approx(254));
}

TEST_CASE("an O-number means fanuc, other programs are linuxcnc") {
  CHECK(read("%\n(HEAD)\nO1001 (PART)\nG21 G0 X1.\n").dialect == "fanuc");
  CHECK(read("%\n(O1001)\nG21 G0 X1.\nM30\nO1001\n").dialect == "linuxcnc");
  CHECK(read("O0001;\nG21;\nG0 X1.;\n").dialect == "fanuc");
  CHECK(diagnostic_of([] { read("G21\n", "siemens5"); }) ==
        "p.ngc: error: unknown dialect 'siemens5'; use one of auto, linuxcnc, grbl, fanuc, haas, mach3, "
        "siemens, "
        "heidenhain, kuka, abb, ur, apt, fanuc_tp, yaskawa");
}

TEST_CASE("integer words are in units by default, and increments with the option") {
  ReadOptions options;
  const std::string text = "O1\nG21 G0 X5 Y5. Z-20\nG20 X5\n";
  CHECK(read_program(text, "", options).moves[0].end_mm == Vector3(5, 5, -20));
  options.integer_words = IntegerWords::increments;
  CHECK(read_program(text, "", options).moves[0].end_mm.isApprox(Vector3(0.005, 5, -0.02)));
  CHECK(read_program(text, "", options).moves[1].end_mm.x() == doctest::Approx(0.0005 * 25.4));
}

TEST_CASE("only a feed move without an exact stop and without words that act at its end may be split") {
  const auto may_split = [](const std::string& block, const std::string& dialect = "linuxcnc") {
    return read("G21 G0 X0. Y0. Z0.\nG1 F100\n" + block + "\n", dialect).moves.back().may_split;
  };
  CHECK(may_split("X1."));
  CHECK(may_split("X1. M8"));
  CHECK(may_split("X1. S900 M3"));
  CHECK(may_split("G61 X1."));
  CHECK(may_split("G64 P.1 X1."));
  CHECK_FALSE(may_split("G0 X1."));
  for (const char* m : {"M0", "M1", "M2", "M30", "M5", "M9", "M6", "M123"}) {
    CAPTURE(m);
    CHECK_FALSE(may_split(std::string("X1. ") + m));
  }
  CHECK_FALSE(may_split("G43 H1 Z1."));
  CHECK(may_split("G20 X1."));
  CHECK_FALSE(may_split("G61.1 X1."));
  CHECK_FALSE(may_split("G61\nX1.", "fanuc"));
  CHECK_FALSE(may_split("G9 X1.", "haas"));
  CHECK(may_split("G9 X1.\nX2.", "haas"));
  CHECK(may_split("G61\nG64\nX1.", "fanuc"));
}

TEST_CASE("a feed move may be inserted before a block only if start and feed are known") {
  const Program program = read("G21 G0 X1 Y1\nZ1\nX2\nG1 X3 F100\nG0 Z5\nG0 G54 Z6\nG61.1 G0 X1 Y1 Z1\n");
  std::vector<bool> may_jump;
  for (const Move& move : program.moves) may_jump.push_back(move.may_jump);
  CHECK(may_jump == std::vector<bool>{false, false, false, true, true, false, false});
}

TEST_CASE("a feed move before a rapid has the feed that acts before its block") {
  const auto may_jump = [](const std::string& lines) {
    return read("G21 S1000 M3\nG0 X1 Y1 Z1\n" + lines).moves.back().may_jump;
  };
  CHECK(may_jump("G1 X3 F100\nG0 Z5 F200"));
  CHECK(may_jump("G1 X3 F100\nG0 Z5 F#1"));
  CHECK_FALSE(may_jump("G0 Z5 F200"));
  CHECK_FALSE(may_jump("F#1\nG0 Z5 F200"));
  CHECK_FALSE(may_jump("G95 G1 X3 F.1\nG94\nG0 Z5 F200"));
  CHECK_FALSE(may_jump("G95 G1 X3 F.1\nM5\nG0 Z5 M3"));
  CHECK_FALSE(may_jump("G1 X3 F100\n/G0 Z5"));
  CHECK(may_jump("G1 X3 F100\n/G1 Z5"));
}

TEST_CASE("G64 gets a remark with its tolerance in mm, once for each tolerance") {
  const Program program = read("G64\nG20\nG64 P0.004 Q0.002\nG64 P0.004 Q0.002\nG21 G64 P.1\n");
  REQUIRE(program.remarks.size() == 3);
  CHECK(program.remarks[0].what == "G64 without P: the control may leave the path by any distance");
  CHECK(program.remarks[1].line == 3);
  CHECK(program.remarks[1].what ==
        "G64 P0.004: the control may leave the path by 0.004 inch = 0.1016 mm and merges moves within 0.002 "
        "inch = "
        "0.0508 mm of a line: smaller corrections can vanish");
  CHECK(
      program.remarks[2].what ==
      "G64 P0.1: the control may leave the path by 0.1 mm and merges moves within 0.1 mm of a line: smaller "
      "corrections can vanish");
}

TEST_CASE("lines near or over the control's limit get a remark") {
  const std::string start = "G21 G0 X1 ";
  CHECK(read(start + "(" + std::string(200, 'c') + ")\n").remarks.empty());
  CHECK(read(start + "(" + std::string(238, 'c') + ")\n").remarks.at(0).what ==
        "the line has 250 of the 255 characters that linuxcnc reads: little space for corrections");
  CHECK(read(start + "(" + std::string(300, 'c') + ")\n").remarks.at(0).what ==
        "the line has 312 characters; linuxcnc reads 255");
  CHECK(read(start + "(" + std::string(300, 'c') + ")\n", "grbl").remarks.empty());
}

TEST_CASE("M codes of machine builders get a remark, rotary words at zero are ignored") {
  const Program program = read("G21 G0 X1 A0. M88\n");
  CHECK(program.remarks.at(0).what == "M88: defined by the machine builder; assumed not to move an axis");
  CHECK(program.moves.size() == 1);
}

TEST_CASE("the header of an earlier run is recognised, and no other comment") {
  CHECK(is_corrected(read("(COUNTERFLEX 1 METHOD DIRECT)\nG21\n")));
  CHECK(is_corrected(read("%\nO1001\n(PART)\n( COUNTERFLEX 1)\nG21\n")));
  CHECK(is_corrected(read("; COUNTERFLEX 1\n")));
  CHECK_FALSE(is_corrected(read("(COUNTERFLEX 12)\nG21\n")));
  CHECK_FALSE(is_corrected(read("(MADE FOR COUNTERFLEX 1)\nG21\n")));
  CHECK_FALSE(is_corrected(read("G21\n(COUNTERFLEX 1)\n")));
  CHECK_FALSE(is_corrected(read("%\n%\n(COUNTERFLEX 1)\n")));
}
