#include "counterflex/program/program_reader.hpp"

#include <doctest/doctest.h>

#include "program/reading.hpp"
#include "program/synthetic_arcs.hpp"
#include "program/synthetic_klartext.hpp"
#include "program/synthetic_program.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const Vector3 window_shift{0.125, -0.0625, 0.5};

/// All moves shifted, with their centres and the heights of their cycles.
std::vector<MoveEdit> rigidly_shifted(const Program& program) {
  std::vector<MoveEdit> edits = shifted(program, window_shift);
  for (MoveEdit& edit : edits) {
    if (edit.centre_mm) *edit.centre_mm += window_shift;
    if (edit.bottom_mm) *edit.bottom_mm += window_shift.z();
    if (edit.retract_mm) *edit.retract_mm += window_shift.z();
  }
  return edits;
}

std::string number_text(const Program& program, const PackedAxisWord& word) {
  return word ? program.text.substr(word->number.begin, word->number.end - word->number.begin) : "-";
}

/// The members of a move as text.
std::string description(const Program& program, const Move& move) {
  std::string text =
      fmt::format("line {} block {} '{}' handling {} group {} from {} {} {} to {} {} {}", move.line,
                  move.block_index, program.text.substr(move.block.begin, move.block.end - move.block.begin),
                  static_cast<int>(move.handling), move.group, move.start_mm.x(), move.start_mm.y(),
                  move.start_mm.z(), move.end_mm.x(), move.end_mm.y(), move.end_mm.z());
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format(" {} {}{}{}", number_text(program, move.words[axis]), int{move.known_start[axis]},
                        int{move.known_end[axis]}, int{move.fixed[axis]});
  if (move.arc)
    for (const auto& word : move.arc->centre_words) text += " " + number_text(program, word);
  if (move.zone)
    text +=
        " zone " + program.text.substr(move.zone->words.begin, move.zone->words.end - move.zone->words.begin);
  return text + fmt::format(" feed {} offset {} tool {} in '{}'", move.feed_mm_min, move.frame, move.tool,
                            program.operations[move.operation]);
}

std::vector<std::string> description(const Program& program) {
  std::vector<std::string> all;
  for (const Move& move : program.moves) all.push_back(description(program, move));
  return all;
}

/// The first line that differs between `a` and `b`, of both; empty if they are equal.
std::string difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const std::string of_a = i < a.size() ? a[i] : "none", of_b = i < b.size() ? b[i] : "none";
    if (of_a != of_b) return of_a + "\n" + of_b;
  }
  return {};
}

/// Result of reading and shifting a program in windows.
struct InWindows {
  std::string text, shifted;
  std::vector<std::string> moves, corrected_moves;
  std::size_t count = 0;
  std::size_t left_alone = 0;
  Program last;
};

InWindows in_windows(const std::string& text, std::size_t least_moves, int extended = 0, bool taken = false) {
  InWindows all;
  Program window_taken, taken_correction;
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "p.ngc", {}, least_moves);
  TextReader again(reader);
  Rewriter rewriter({});
  while (reader.next()) {
    for (int i = 0; i < extended; ++i) reader.extend();
    if (taken) reader.take_window(window_taken);
    const Program& window = taken ? window_taken : reader.window();
    ++all.count;
    all.text += window.text;
    for (const std::string& move : description(window)) all.moves.push_back(move);
    all.left_alone += window.left_alone.size();
    const std::string written = rewriter.write(window, rigidly_shifted(window)).text;
    all.shifted += written;
    const Program& read = again.read(written);
    if (taken) again.take_window(taken_correction);
    for (const std::string& move : description(taken ? taken_correction : read))
      all.corrected_moves.push_back(move);
    all.last = window;
  }
  return all;
}

void check_windows(const std::string& text, std::size_t least_moves, int extended = 0) {
  CAPTURE(text);
  CAPTURE(least_moves);
  const Program whole = read(text);
  std::string corrected;
  const std::string refused =
      diagnostic_of([&] { corrected = rewrite(whole, rigidly_shifted(whole), {}).text; });
  if (refused != "none") {
    CHECK(diagnostic_of([&] { in_windows(text, least_moves, extended); }) == refused);
    return;
  }
  for (const bool taken : {false, true}) {
    CAPTURE(taken);
    const InWindows all = in_windows(text, least_moves, extended, taken);
    CHECK(all.text == text);
    CHECK(difference(all.moves, description(whole)) == "");
    CHECK(all.left_alone == whole.left_alone.size());
    CHECK(all.last.block_count == whole.block_count);
    CHECK(all.last.frames == whole.frames);
    CHECK(all.last.remarks.size() == (taken ? 0 : whole.remarks.size()));
    CHECK(all.shifted == corrected);
    CHECK(difference(all.corrected_moves, description(read(corrected))) == "");
  }
}

/// Lines of a pocket of `count` moves with known positions.
std::string pocket(int count) {
  std::string text = "%\nO1001 (POCKET)\nG21 G90 G17\nG0 X0 Y0\nZ5.\nG1 Z-1. F200\n";
  for (int i = 0; i < count; ++i) text += fmt::format("X{}.5 Y{}.\n", i % 40, i / 40);
  return text;
}

}  // namespace

TEST_CASE("zones of a robot program that is read in windows are those of the whole program") {
  std::string text = "MODULE Job\nPROC main()\n";
  for (int i = 0; i < 40; ++i)
    text += fmt::format("{} [[{},0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,z{},tool0;\n",
                        i % 5 == 4 ? "MoveJ" : "MoveL", 10 * i, i % 2 == 0 ? 5 : 10);
  text += "ENDPROC\nENDMODULE\n";
  for (std::size_t least_moves = 1; least_moves < 8; ++least_moves) check_windows(text, least_moves);
}

TEST_CASE("a program read in windows equals the whole program") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    check_windows(SyntheticProgram(seed).text(60), 1 + seed % 7);
    check_windows(SyntheticArcs(seed).text(60), 1 + seed % 7);
  }
}

TEST_CASE("windows reach the minimum size, and end at the next possible move") {
  const std::string text = pocket(1000) + "G0 Z5.\nM30\n%\n";
  check_windows(text, 100);
  CHECK(in_windows(text, 100).count == 12);  // each of the 25 ways back to the first column counts as 8 moves
  CHECK(in_windows(text, whole_program).count == 1);
}

TEST_CASE("windows of long moves, of turns and of moves along Z have few moves") {
  const std::string begin = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 X1 F100\n";
  const auto windows_of = [&](const std::string& block, int count) {
    std::string text = begin;
    for (int i = 0; i < count; ++i) text += fmt::format(fmt::runtime(block), i % 2 == 0 ? 0 : 99);
    return in_windows(text + "M30\n", 100).count;
  };
  CHECK(windows_of("X{}\n", 100) >= 19);
  CHECK(windows_of("G2 X1 I9 (of {})\n", 100) >= 14);
  CHECK(windows_of("G2 I9 P4 (of {})\n", 100) >= 45);
  CHECK(windows_of("Z{}\n", 100) >= 9);
}

TEST_CASE("an extended window ends at the next possible place") {
  const std::string text = pocket(100) + "G0 Z5.\nM30\n%\n";
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "p.ngc", {}, 10);
  REQUIRE(reader.next());
  const std::size_t moves = reader.window().moves.size();
  REQUIRE(reader.window().after);
  const Vector3 next = reader.window().after->end_mm;
  REQUIRE(reader.extend());
  CHECK(reader.window().moves.size() == moves + 1);
  CHECK(reader.window().moves.back().end_mm == next);
  while (reader.extend()) {
  }
  CHECK(reader.window().text == text);
  CHECK_FALSE(reader.window().after);
  CHECK_FALSE(reader.next());
  check_windows(text, 10, 3);
}

TEST_CASE("take_window reuses the memory of the window that it replaces") {
  FileReader bytes = FileReader::of_bytes(pocket(1000));
  ProgramReader reader(bytes, "p.ngc", {}, 100);
  Program window;
  std::vector<const Move*> rooms;
  for (; reader.next(); rooms.push_back(window.moves.data())) {
    reader.take_window(window);
    CHECK(window.moves.size() >= 1);
    CHECK(reader.window().moves.empty());
  }
  REQUIRE(rooms.size() > 4);
  for (std::size_t i = 4; i < rooms.size(); ++i) CHECK(rooms[i] == rooms[i - 2]);
}

TEST_CASE("windows do not end in contours, in cycles, in bodies, or at an axis with an unknown position") {
  const std::string approach = "G21 G90 G17\nT1 M6\nG0 X0 Y0\nG43 H1 Z5\n";
  for (const std::string inside :
       {"G41 D1 G1 X1 Y1 F100\nX9\nY9\nG40 X0 Y0\n", "G98 G81 X1 Y1 Z-5 R2 F50\nX2\nX3\nG80\n",
        "o1 if [#1 GT 2]\nX1\nX2\no1 endif\n", "G53 G0 X0\nY1\nY2\nY3\n", "G52 X#1\nX1 Y1\nX2\nG52 X0\n"}) {
    CAPTURE(inside);
    FileReader bytes = FileReader::of_bytes(approach + inside + "G0 X0 Y0 Z5\nX1\nX2\nX3\nM2\n");
    ProgramReader reader(bytes, "p.ngc", {}, 3);
    REQUIRE(reader.next());
    const std::string_view window = reader.window().text;
    CHECK((window.size() == approach.size() || window.size() >= approach.size() + inside.size()));
  }
}

TEST_CASE("a full circle is not a move along Z: a contour behind it includes the same moves in windows") {
  const std::string text =
      "G21 G90 G17\nG0 X0 Y0 Z5\nG1 X1 F100\nX2\nG2 I5\nG1 Z1\nZ2\nG41 D1 X9 Y9\nX12\nG40 X0\nG0 X5\nM30\n";
  for (const std::size_t least : {1U, 8U, 17U}) check_windows(text, least);
}

TEST_CASE("subprograms and their calls are known in every window") {
  std::string text = pocket(50) + "M98 P2000\nG0 X0 Y0 Z5.\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("X{}.\n", i);
  text += "M30\nO2000\nG1 X3.\nX4.\nM99\n%\n";
  check_windows(text, 5);
}

TEST_CASE("text behind the end is read in windows, too") {
  const std::string text =
      pocket(20) + "G0 Z5.\nX3. M30\n%\n" + std::string(600000, 'x') + "\nO7 (NEXT)\nX1\n";
  check_windows(text, 5);
  CHECK(in_windows(text, 5).last.remarks.size() == 1);
  CHECK(in_windows(text, whole_program).count == 1);
  CHECK(in_windows("G21 G90 G0 X1 Y1 Z1\nM30\n%", whole_program).count == 1);
}

TEST_CASE("a program without a line end, an empty one, and one without moves are windows") {
  check_windows("G21 G90 G0 X1 Y1 Z1\nX2\nX3", 1);
  check_windows("", 1);
  check_windows("(NOTHING)\n\n", 1);
  check_windows("G21\nG0 X1", 1);
}

TEST_CASE("errors far behind are refused with their position") {
  const std::string text = pocket(20000) + "X1. Y*\n";
  CHECK(diagnostic_of([&] { in_windows(text, 100); }) == diagnostic_of([&] { read(text); }));
  CHECK(diagnostic_of([&] { in_windows(text, 100); }).starts_with("p.ngc:20007:5: error: "));
}

TEST_CASE("Klartext read in windows equals the whole program") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    check_windows(SyntheticKlartext(seed).text(60), 1 + seed % 7, seed % 3 == 0 ? 1 : 0);
  }
}

TEST_CASE("windows of Klartext end outside of contours and bodies, and include a CC with its arc") {
  const auto count = [](const std::string& statements) {
    return in_windows("BEGIN PGM A MM\nL X+0 Y+0 Z+5 R0 FMAX\n" + statements + "END PGM A MM\n", 1).count;
  };
  CHECK(count("L X+1\nL X+2\nL X+3\nL X+4\n") == 5);
  CHECK(count("L X+1 RL F9\nL X+2\nL X+3\nL X+4 R0\n") == 1);
  CHECK(count("CC X+1 Y+0\nL X+1\nL X+2\nL X+2 Y+1\nC X+0 Y+1 DR+\nL X+4\n") == 2);
  CHECK(count("LBL 1\nL X+1\nL X+2\nLBL 0\nCALL LBL 1\n") == 1);
  CHECK(count("CC X+1 Y+0\nCTP PA+30\nL X+1 Y+0\nL X+2\nL X+3\n") ==
        1);  // the block that uses the CC may be far behind
}

TEST_CASE("windows of Klartext do not end between the holes of a series, and end again behind it") {
  const std::string cycle =
      "CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-5 ~\n Q206=150 ~\n Q203=+0 ~\n Q204=+5\n";
  const std::string cuts = "L Z+50 FMAX\nL X+1 Y+1\nL X+2\nL X+3\nL X+4\nL X+5\nL X+6\nL X+7\nL X+8\nL X+9\n";
  for (const std::string hole :
       {"L X+{} Y+0 FMAX\nCYCL CALL\n", "L X+{} Y+0 FMAX\nL IX+1 FMAX M99\n",
        "L X+{} FMAX\nL Y+3 FMAX M3 M99\nL X+1 Y+2 FMAX\n", "L X+{} Y+0 FMAX\nM99\n"}) {
    std::string holes;
    for (int i = 0; i < 9; ++i) holes += fmt::format(fmt::runtime(hole), 10 * i);
    for (const std::string& definition :
         {cycle, cycle + "Q203=+1\n", cycle + "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+1\n"}) {
      const std::string text = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+50 R0 FMAX M3\n" +
                               definition + holes + cuts + cycle + holes + cuts + "END PGM A MM\n";
      for (const std::size_t least : {1U, 4U, 5U, 6U, 7U}) check_windows(text, least);
      CHECK(in_windows(text, 1).count >= 17);
    }
  }
  for (const std::size_t least : {1U, 3U})
    check_windows("BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+50 R0 FMAX M3\n" + cycle +
                      "L X+10 FMAX M89\nL X+20 FMAX\nL X+30 FMAX\nL X+40 Y+1 FMAX M99\n" + cuts +
                      "END PGM A MM\n",
                  least);
}
