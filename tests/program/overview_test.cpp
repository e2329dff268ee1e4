#include "counterflex/program/overview.hpp"

#include <doctest/doctest.h>

#include "program/reading.hpp"
#include "program/synthetic_program.hpp"
#include "support/windows.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const varied_program =
    "(varied)\n"
    "G21 G90 G94 G40 G80 F100\n"
    "G64 P0.02\n"
    "N10 G54 G0 X0 Y0 Z10\n"
    "N20 G1 Z-1 (FORCE OFF)\n"
    "N50 X10 (FORCE FX=1)\n"
    "N30 G28\n"
    "N40 G56 G0 X1 Y1 Z10\n"
    "G64 P0.01\n"
    "G1 Z5\n"
    "G81 X5 Y5 Z-3 R2\n"
    "X6\n"
    "G80\n"
    "M30\n"
    "; no line end";

std::vector<std::pair<int, std::string>> rows_of(const Capped<LeftAlone>& list) {
  std::vector<std::pair<int, std::string>> rows;
  for (const LeftAlone& row : list.rows) rows.emplace_back(row.line, row.why);
  return rows;
}

void check_same(const Overview& a, const Overview& b) {
  CHECK(a.file == b.file);
  CHECK(a.dialect == b.dialect);
  CHECK(a.blocks == b.blocks);
  CHECK(a.moves == b.moves);
  CHECK(a.bytes == b.bytes);
  CHECK(a.plunges == b.plunges);
  CHECK(a.rapids == b.rapids);
  CHECK(a.lines == b.lines);
  CHECK(a.last_block_number == b.last_block_number);
  CHECK(a.frames == b.frames);
  CHECK(a.frame_lines == b.frame_lines);
  CHECK(a.remarks.size() == b.remarks.size());
  CHECK(a.path_tolerances.size() == b.path_tolerances.size());
  CHECK(a.left_alone.count == b.left_alone.count);
  CHECK(rows_of(a.left_alone) == rows_of(b.left_alone));
  CHECK(a.first_force_line == b.first_force_line);
  CHECK(a.first_cycle_line == b.first_cycle_line);
  CHECK(a.first_cut_without_tool == b.first_cut_without_tool);
  CHECK(a.commented_force == b.commented_force);
}

Overview in_windows(const Program& program, int lines_each) {
  Overview overview;
  for (const Program& window : windows_of(program, lines_each)) add_window(overview, window);
  return overview;
}

}  // namespace

TEST_CASE("an overview summarises the whole program") {
  const Program program = read(varied_program);
  const Overview overview = overview_of(program);
  CHECK(overview.file == "p.ngc");
  CHECK(overview.dialect == "linuxcnc");
  CHECK(overview.blocks == 13);
  CHECK(overview.moves == program.moves.size());
  CHECK(overview.bytes == program.text.size());
  CHECK(overview.lines == 15);
  CHECK(overview.plunges == 2);
  CHECK(overview.rapids == 4);  // the path to a hole is a rapid
  CHECK(overview.last_block_number == 50);
  CHECK(overview.frames == std::vector<ProgramFrame>{{}, {.work_offset = "G54"}, {.work_offset = "G56"}});
  CHECK(overview.frame_lines == std::vector<int>{0, 4, 8});
  CHECK(overview.remarks.size() == program.remarks.size());
  REQUIRE(overview.path_tolerances.size() == 2);
  CHECK(overview.path_tolerances[1].line == 9);
  CHECK(overview.left_alone.count == 0);
  REQUIRE(overview.machine_positions.count == 1);
  CHECK(overview.machine_positions.rows[0].line == 7);
  CHECK(overview.first_force_line == 6);
  CHECK(overview.commented_force);
  CHECK(overview.first_cycle_line == 11);
}

TEST_CASE("a selected frame is used by each move in it, that before any selection by a known coordinate") {
  const auto lines = [](const std::string& text, const char* file) {
    return overview_of(read_program(text, file, {})).frame_lines;
  };
  const std::string move = "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\n";
  CHECK(lines("DEF job()\nINI\n$BASE=BASE_DATA[1]\n" + move + "END\n", "job.src") == std::vector<int>{0, 4});
  CHECK(lines("DEF job()\nINI\n" + move + "INI\nEND\n", "job.src") == std::vector<int>{3});
  CHECK(lines("DEF job()\nINI\nEND\n", "job.src") == std::vector<int>{0});
  CHECK(lines("G21 G90 G54\nG0 X0 Y0 Z5\nG55 G1 X#1 F100\nM2\n", "part.ngc") == std::vector<int>{0, 2, 3});
}

TEST_CASE("an overview has the first feed move without a tool number; rapids need no tool") {
  CHECK(overview_of(read("G21 G90 G0 X0 Y0 Z0\nG1 X1 F100\nT1 M6\nG1 X2\n")).first_cut_without_tool == 2);
  CHECK(overview_of(read("G21 G90 G0 X0 Y0 Z5\nG99 G81 X1 Z-1 R1 F100\n")).first_cut_without_tool == 2);
  CHECK_FALSE(overview_of(read("G21 G90 G0 X0 Y0 Z0\nT1 M6\nG1 X2 F100\n")).first_cut_without_tool);
}

TEST_CASE("the overview of a program without forces, cycles or text has none of them") {
  const Overview overview = overview_of(read("G21 G90 (FORCE OFF)\nG0 X0\n"));
  CHECK_FALSE(overview.first_force_line);
  CHECK_FALSE(overview.commented_force);
  CHECK_FALSE(overview.first_cycle_line);
  CHECK(overview.frame_lines == std::vector<int>{2});
  CHECK(overview_of(read("")).lines == 0);
}

TEST_CASE("an overview gathered in windows equals that of the whole program") {
  for (const char* const text : {varied_program, "\n\nG21\n", "G21 G90\r\nG0 X1\r\n"})
    for (int lines_each = 1; lines_each <= 5; ++lines_each) {
      CAPTURE(text);
      CAPTURE(lines_each);
      const Program program = read(text);
      check_same(in_windows(program, lines_each), overview_of(program));
    }
}

TEST_CASE("overviews of synthetic programs do not depend on the windows") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const Program program = read(SyntheticProgram(seed).text(60));
    for (const int lines_each : {1, 7, 1000})
      check_same(in_windows(program, lines_each), overview_of(program));
  }
}

TEST_CASE("a capped list keeps its first rows by line, and rows of one line in their order") {
  std::vector<Remark> all;
  for (int i = 0; i < 350; ++i) all.push_back({i * 37 % 90, std::to_string(i)});
  Capped<Remark> capped, first, second;
  for (const Remark& row : all) list(capped, row);
  for (std::size_t i = 0; i < all.size(); ++i) list(i < 120 ? first : second, all[i]);
  list(first, second);
  std::stable_sort(all.begin(), all.end(), [](const Remark& a, const Remark& b) { return a.line < b.line; });
  CHECK(capped.count == 350);
  CHECK(first.count == 350);
  REQUIRE(capped.rows.size() == listed_at_most);
  REQUIRE(first.rows.size() == listed_at_most);
  for (std::size_t i = 0; i < listed_at_most; ++i) {
    CHECK(capped.rows[i].what == all[i].what);
    CHECK(first.rows[i].what == all[i].what);
  }
}

TEST_CASE("an overview lists the tools in the spindle during moves, each once and in order") {
  const Program program =
      read_program("G21 G90\nG0 X1 Y1 Z1\nT7 M6\nX2\nT3 M6\nX3\nT7 M6\nX4\nT9\nX5\nM30\n", "t.ngc", {});
  const std::vector<long> expected{0, 3, 7};
  CHECK(overview_of(program).tools == expected);
  Overview parts;
  for (const Program& window : windows_of(program, 3)) add_window(parts, window);
  CHECK(parts.tools == expected);
}
