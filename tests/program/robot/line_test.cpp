// Lines and numbers of robot programs.
#include "program/robot/line.hpp"

#include <doctest/doctest.h>

#include "program/text/lex.hpp"

using namespace counterflex;

TEST_CASE("a line of a robot program is its code without blanks, comment and line end") {
  const std::string text = "\xEF\xBB\xBF  LIN P1 ; to \"P1\"\r\n\n msg(\"a;b\")\t;c\n;only\nEND";
  struct Row {
    std::string code, comment, whole;
  };
  const Row rows[] = {{"LIN P1", " to \"P1\"", "\xEF\xBB\xBF  LIN P1 ; to \"P1\""},
                      {"", "", ""},
                      {"msg(\"a;b\")", "c", " msg(\"a;b\")\t;c"},
                      {"", "only", ";only"},
                      {"END", "", "END"}};
  RobotLine line;
  for (const Row& row : rows) {
    REQUIRE(next_robot_line(text, ";", line));
    CAPTURE(line.line);
    CHECK(part(text, line.code) == row.code);
    CHECK(part(text, line.comment) == row.comment);
    CHECK(part(text, line.span) == row.whole);
  }
  CHECK(line.line == 5);
  CHECK(!next_robot_line(text, ";", line));
}

TEST_CASE("a plain number has a value, its digits, and nothing that continues it") {
  const auto number = [](const std::string& text) { return number_at(text, 0); };
  CHECK(number("-0.250,")->value == -0.25);
  CHECK(number("-0.250,")->decimals == 3);
  CHECK(number("+5}")->value == 5);
  CHECK(number("+5}")->decimals == 0);
  CHECK(number(".5")->value == 0.5);
  CHECK(number("7.")->span.end == 2);
  CHECK(number("2.2E-14")->value == 2.2e-14);
  CHECK(number("2.2E-14")->decimals == 1);
  CHECK(number("9E9]")->value == 9e9);
  for (const char* text : {"", "-", ".", "x", "5x", "5.5.5", "1E", "- 5", "1E999", "5_"}) {
    CAPTURE(text);
    CHECK(!number(text));
  }
  CHECK(number("0." + std::string(60, '1'))->decimals == 60);
  CHECK(!number("0." + std::string(61, '1')));
}
