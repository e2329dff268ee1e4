#include <doctest/doctest.h>

#include "counterflex/files/input_error.hpp"
#include "counterflex/machine/read_machine.hpp"

using namespace counterflex;

TEST_CASE("a tool table gives lengths by tool number, with any other words in its lines") {
  const auto lengths = read_tool_table(
      "; tools of the small mill\n"
      "T1 P1 D6.000000 Z+50.5 ;1/4 end mill T9\r\n"
      "\n"
      "t22 p3 z-12.25 x0 q1\n"
      "   T3  P4 D3",
      "tool.tbl");
  REQUIRE(lengths.size() == 3);
  CHECK(lengths.at(1) == doctest::Approx(0.0505));
  CHECK(lengths.at(22) == doctest::Approx(-0.01225));
  CHECK(lengths.at(3) == 0);
  CHECK(read_tool_table("", "tool.tbl").empty());
  CHECK(read_tool_table("\xEF\xBB\xBFT2 P2 Z120\n", "tool.tbl").at(2) == doctest::Approx(0.12));
}

TEST_CASE("a mistake in a tool table is an error at its place") {
  const auto diagnostic = [](const char* text) {
    try {
      read_tool_table(text, "tool.tbl");
    } catch (const InputError& error) {
      CHECK(error.kind() == ErrorKind::machine_or_force);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK(diagnostic("T1 Z1\nT1 Z2\n") == "tool.tbl:2:1: error: tool 1 is defined twice");
  CHECK(diagnostic("P1 Z1\n") ==
        "tool.tbl:1:1: error: the line has no tool; each line begins with T and its number");
  CHECK(diagnostic("T1.5 Z1\n") ==
        "tool.tbl:1:1: error: the tool is 'T1.5', must be a whole number of at least 0");
  const std::string allowed =
      "is not a word of a tool table; allowed are T, P, D, X, Y, Z, A, B, C, U, V, W, I, J and Q with a "
      "number, "
      "and "
      "comments after ';'";
  CHECK(diagnostic("T1 H2\n") == "tool.tbl:1:4: error: 'H2' " + allowed);
  CHECK(diagnostic("T1\nT2 P2 Z5,0\n") == "tool.tbl:2:7: error: 'Z5,0' " + allowed);
  CHECK(diagnostic("T1 Znan\n") == "tool.tbl:1:4: error: 'Znan' " + allowed);
  CHECK(diagnostic("T2 P2 Z120 z90\n") ==
        "tool.tbl:1:12: error: 'z90' gives Z a second time; give each word once in a line");
}
