#include <doctest/doctest.h>

#include "forces/sample_path.hpp"

using namespace counterflex;
using test::forces_on;
using test::from_csv;
using test::linear;
using test::near;
using test::on_tool;
using test::ProgramBuilder;
using test::sample_program;
using test::straight;
using test::wrench;

TEST_CASE("keys rounded by a micrometre or a millisecond past the ends of the program still fit it") {
  for (const char* rows :
       {"s_mm,fx_N,fy_N,fz_N\n0.0005,1,0,0\n9.9995,2,0,0\n", "s_mm,fx_N,fy_N,fz_N\n0,1,0,0\n10.0005,2,0,0\n",
        "t_s,fx_N,fy_N,fz_N\n0.0005,1,0,0\n0.9995,2,0,0\n", "t_s,fx_N,fy_N,fz_N\n0,1,0,0\n1.0005,2,0,0\n"}) {
    CAPTURE(rows);
    const auto forces = forces_on(straight(10, 10), from_csv(linear + rows));
    CHECK(near(forces.at(0, 0), wrench(1, 0, 0), 1e-3));
    CHECK(near(forces.at(0, 1), wrench(2, 0, 0), 1e-3));
  }
}

TEST_CASE("a step at the end of the last cut never acts") {
  const auto forces =
      forces_on(straight(10, 10), from_csv(on_tool + "s_mm,fx_N,fy_N,fz_N\n0,1,0,0\n10,2,0,0\n"));
  CHECK(forces.at(0, 1) == wrench(1, 0, 0));
  CHECK(forces.breaks(0).empty());
  CHECK(forces.jumps() == 1);
}

TEST_CASE("keys that the program cannot have are errors at the first row") {
  Program unnumbered = sample_program(), decreasing = sample_program(), no_feed = sample_program();
  unnumbered.moves[0].block_number = unnumbered.moves[1].block_number = std::nullopt;
  decreasing.moves[4].block_number = 5;
  no_feed.moves[2].feed_mm_min = 0;
  const auto by_n = from_csv(on_tool + "n,fx_N,fy_N,fz_N\n1,1,0,0\n");
  CHECK_THROWS_WITH_AS(
      forces_on(unnumbered, by_n),
      "forces.csv:4:1: error: row 1: key n needs block numbers, the move in line 2 has none at or before it",
      InputError);
  CHECK_THROWS_WITH_AS(
      forces_on(decreasing, by_n),
      "forces.csv:4:1: error: row 1: key n needs block numbers that never decrease, line 5 has N5 after N30",
      InputError);
  CHECK_THROWS_WITH_AS(forces_on(no_feed, from_csv(on_tool + "t_s,fx_N,fy_N,fz_N\n0,1,0,0\n")),
                       "forces.csv:4:1: error: row 1: key t_s needs a feed, the move in line 3 has none",
                       InputError);
}

TEST_CASE("a program without cuts has no forces and takes any profile that it covers") {
  const Program program = ProgramBuilder({0, 0, 0}).rapid({1, 0, 0}).rapid({2, 0, 0}).program;
  const auto forces = forces_on(program, from_csv(on_tool + "line,fx_N,fy_N,fz_N\n2,1,0,0\n", 2 * mm));
  CHECK(forces.at(1, 0.5) == Vector6::Zero());
  CHECK(forces.ramps() == 0);
}

TEST_CASE(
    "rows of a line act in every copy of the line, and the first row must be there for the first of them") {
  Program program = straight(60, 10);
  for (std::size_t m = 0; m < 6; ++m) {
    program.moves[m].text_line = static_cast<int>(m) + 1;
    program.moves[m].line =
        m < 3 ? 8 + static_cast<int>(m) : 5 + static_cast<int>(m);  // 8 9 10, again 8 9 10
  }
  program.expansion.file_lines = 10;
  const auto rows = [](const std::string& text) {
    return from_csv(on_tool + "line,fx_N,fy_N,fz_N\n" + text);
  };
  const auto forces = forces_on(program, rows("8,1,0,0\n9,2,0,0\n10,3,0,0\n"));
  for (const std::size_t copy : {0, 3})
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(forces.at(copy + i, 0.5) == wrench(1 + static_cast<double>(i), 0, 0));
  CHECK_THROWS_WITH_AS(forces_on(program, rows("8,1,0,0\n11,2,0,0\n")),
                       "forces.csv:5:1: error: row 2: line 11 is beyond the end of the program at line 10",
                       InputError);
  program.moves[4].line = 3;  // a body above the call
  CHECK_THROWS_WITH_AS(
      forces_on(program, rows("8,1,0,0\n")),
      "forces.csv:4:1: error: row 1: line 8 is the first row, but the program cuts from line 3 on "
      "(line 3): a row there is required, with zeros where nothing is cut",
      InputError);
}
