#include "counterflex/report/motion_plan.hpp"

#include <doctest/doctest.h>

#include "counterflex/program/read_program.hpp"
#include "support/programs.hpp"

using namespace counterflex;
using test::ProgramBuilder;

namespace {

/// Three feed moves in lines 1 to 3.
Program three_moves() {
  return ProgramBuilder({0, 0, 0}).feed({1, 0, 0}, 100).feed({2, 0, 0}, 100).feed({3, 0, 0}, 100).program;
}

}  // namespace

TEST_CASE(
    "moves that end at a known place are corrected, machine positions count among the moves and are not") {
  Program program = three_moves();
  program.moves[2].line = 5;
  program.left_alone = {{4, "G53 moves to a position of the machine", true},
                        {7, "G10 sets offsets"},
                        {9, "G28 moves to a position of the machine", true}};
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.moves == 5);
  CHECK(plan.corrected == 3);
  CHECK(plan.not_corrected == 2);
  REQUIRE(plan.left_rows.size() == 2);
  CHECK(plan.left_rows[0].why == "G53 moves to a position of the machine");
  CHECK(plan.left_rows[0].lines == std::vector<int>{4});
  CHECK_FALSE(plan.left_rows[0].must_be_zero);
  REQUIRE(plan.other_rows.size() == 1);  // no motion
  CHECK(plan.other_rows[0].lines == std::vector<int>{7});
}

TEST_CASE(
    "holes at unknown places count as feed moves of unknown length, each hole of a block with repeats") {
  Program program = three_moves();
  Move& block = program.moves[2];
  block.motion = Motion::rapid;
  block.relative = true;
  block.cycle = CycleMove{.repeats = 4};
  CHECK(motion_plan(program).corrected_cut.unknown == 0);
  block.known_start[0] = block.known_end[0] = false;
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.corrected_cut.unknown + plan.held_cut.unknown + plan.left_cut.unknown == 4);
}

TEST_CASE("holes with a known place are corrected, also where the height behind them is not known") {
  Program program = three_moves();
  program.moves[1].known_end = program.moves[2].known_start = {false, false, false};
  program.moves[2].motion = Motion::rapid;
  program.moves[2].cycle = CycleMove{};
  program.moves[2].known_end[2] = false;
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.corrected == 3);  // the move before the hole by its shift
  CHECK(plan.left_rows.empty());
}

TEST_CASE(
    "a block that no edit can shift is not corrected, for the reason that its run of moves begins with") {
  Program program = three_moves();
  program.moves[1].fixed[0] = program.moves[2].fixed[0] = true;
  program.left_alone = {{2, "X is an expression"}};
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.corrected == 1);
  CHECK(plan.not_corrected == 2);
  CHECK(plan.moves == 3);
  REQUIRE(plan.left_rows.size() == 1);
  CHECK(plan.left_rows[0].count == 2);
  CHECK(plan.left_rows[0].why == "X is an expression");
  CHECK(plan.left_rows[0].lines == std::vector<int>{2, 3});
  CHECK(plan.left_rows[0].must_be_zero);
}

TEST_CASE("a word before all axes are known is corrected where a known position follows within 64 blocks") {
  Program program = three_moves();
  program.moves[0].known_end[2] = false;
  for (std::size_t m = 0; m < 3; ++m) program.moves[m].block_index = m;
  CHECK(motion_plan(program).corrected == 3);
  program.moves[1].block_index = 65;
  program.moves[2].block_index = 66;
  const MotionPlan far = motion_plan(program);
  CHECK(far.corrected == 2);
  REQUIRE(far.left_rows.size() == 1);
  CHECK(far.left_rows[0].why == "the position in Z is unknown here and in the next 64 blocks");
}

TEST_CASE("held moves and contour groups are counted apart") {
  Program program = three_moves();
  program.moves[0].handling = Handling::held;
  program.left_alone = {{1, "G33: held"}};
  for (std::size_t m = 1; m < 3; ++m) {
    program.moves[m].handling = Handling::group;
    program.moves[m].group = 1;
  }
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.held == 1);
  CHECK(plan.held_rows[0].why == "G33: held");
  CHECK(plan.grouped == 2);
  REQUIRE(plan.groups.size() == 1);
  CHECK(plan.groups[0].first_line == 2);
  CHECK(plan.groups[0].last_line == 3);
  CHECK(plan.groups[0].moves == 2);
  CHECK(plan.moves == 3);
}

TEST_CASE("arcs are counted by plane, cycles, relative and G93 moves and tools by themselves") {
  Program program = ProgramBuilder({10, 0, 0})
                        .arc({0, 10, 0}, {0, 0, 0}, 100)
                        .feed({0, 10, 0}, 100)
                        .about({0, 0, 0}, 1)
                        .feed({0, 0, 0}, 100)
                        .program;
  program.moves[0].relative = true;
  program.moves[1].feed_mode = FeedMode::inverse_time;
  program.moves[2].cycle.emplace();
  program.moves[1].tool = program.moves[2].tool = 3;
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.arcs == std::array<std::size_t, 3>{1, 1, 0});
  CHECK(plan.cycles == 1);
  CHECK(plan.relative == 1);
  CHECK(plan.inverse_time == 1);
  CHECK(plan.tools == std::map<long, std::size_t>{{0, 1}, {3, 2}});
}

TEST_CASE("blocks of copied bodies are listed with the lines of the bodies") {
  Program program = three_moves();
  const int lines[] = {9, 9, 2};
  for (std::size_t m = 0; m < 3; ++m) {
    program.moves[m].line = lines[m];
    program.moves[m].text_line = 2 * static_cast<int>(m) + 1;
  }
  program.moves[1].fixed[0] = true;
  program.left_alone = {{8, "G53 moves to a position of the machine", true, 2}, {9, "a variable", false, 3}};
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.corrected == 2);
  CHECK(plan.not_corrected == 2);
  REQUIRE(plan.left_rows.size() == 2);
  CHECK(plan.left_rows[1].lines == std::vector<int>{8});
  CHECK(plan.left_rows[0].why == "a variable");
  CHECK(plan.left_rows[0].lines == std::vector<int>{9});
}

TEST_CASE("of a long run only the first lines are listed") {
  ProgramBuilder builder({0, 0, 0});
  for (int i = 1; i <= 9; ++i) builder.feed({1.0 * i, 0, 0}, 100);
  for (Move& move : builder.program.moves) move.fixed[1] = true;
  const MotionPlan plan = motion_plan(builder.program);
  CHECK(plan.left_rows[0].count == 9);
  CHECK(plan.left_rows[0].lines.size() == lines_of_row);
}

TEST_CASE("a call that is not followed is a feed move of unknown length, as in the verdict") {
  Program program = three_moves();
  Move& call = program.moves[1];
  call.motion = Motion::rapid;
  CHECK(motion_plan(program).left_cut.unknown == 0);
  call.fixed.fill(true);
  call.known_end.fill(false);
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.left_cut.unknown == 1);
  REQUIRE(plan.left_rows.size() == 1);
  CHECK(plan.left_rows[0].cut.unknown == 1);
}

TEST_CASE("a plan has shares of the cutting length, and its rows the most costly first") {
  Program program =
      ProgramBuilder({0, 0, 0}).feed({10, 0, 0}, 100).feed({10, 1, 0}, 100).feed({10, 1, 5}, 100).program;
  program.moves[1].handling = program.moves[2].handling = Handling::held;
  program.moves[1].line = 4;
  program.moves[2].line = 6;
  program.left_alone = {{4, "a short one"}, {6, "a long one"}};
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.corrected_cut.known_mm == 10);
  CHECK(plan.held_cut.known_mm == 6);
  CHECK(plan.left_cut.unknown == 0);
  REQUIRE(plan.held_rows.size() == 2);
  CHECK(plan.held_rows[0].why == "a long one");
  CHECK(plan.held_rows[0].cut.known_mm == 5);
  CHECK(plan.held_rows[1].why == "a short one");
  program.moves[2].known_end = {};
  CHECK(motion_plan(program).held_cut.unknown == 1);
}
TEST_CASE("behind a block that '/' may skip moves are held until their start is known") {
  const Program program = read_program(
      "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F200\nX10\n/X20\nY10\nX0\nX5 Y5\nG0 Z5\nM30\n", "part.ngc", {});
  const MotionPlan plan = motion_plan(program);
  CHECK(plan.corrected == 6);
  CHECK(plan.held == 2);
  REQUIRE(plan.held_rows.size() == 1);
  CHECK(plan.held_rows[0].lines == std::vector<int>{6, 7});
  CHECK(plan.held_rows[0].why ==
        "a block before it may be skipped ('/') or is not followed, so its start is not known");
}
TEST_CASE("nothing is held behind a skipped block where the text holds no correction yet") {
  const Program program = read_program("G21 G90\n/G0 X0 Y0\nG0 X5 Y5 Z5\nG1 Z-1 F200\nM30\n", "part.ngc", {});
  CHECK(motion_plan(program).corrected == 3);
}
