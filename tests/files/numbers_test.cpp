#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "counterflex/files/text.hpp"

using namespace counterflex;

TEST_CASE("numbers are read whole, with an optional sign") {
  CHECK(read_number("12.5") == 12.5);
  CHECK(read_number("+12.5") == 12.5);
  CHECK(read_number("-.5") == -0.5);
  CHECK(read_number("5.") == 5.0);
  CHECK(read_number("2.2E-14") == 2.2e-14);
}

TEST_CASE("a text other than one finite number is refused") {
  for (const char* text : {"", "+", "-", ".", " 1", "1 ", "1,5", "nan", "inf", "-inf", "1e999", "0x10", "++1",
                           "+-1", "--1", "1.2.3", "1mm"}) {
    CAPTURE(text);
    CHECK_FALSE(read_number(text).has_value());
  }
}

TEST_CASE("a tool's number is digits after a T, or only digits") {
  CHECK(read_tool_number("T3") == 3);
  CHECK(read_tool_number("t03") == 3);
  CHECK(read_tool_number("12") == 12);
  CHECK(read_tool_number("T0") == 0);
  CHECK(read_tool_number("2147483647") == 2147483647);
  for (const char* text : {"", "T", "TT3", "+3", "T+3", "-3", "-0", "3.0", "T3e0", "T 3", " 3", "3 ", "0x3",
                           "2147483648", "X3"}) {
    CAPTURE(text);
    CHECK_FALSE(read_tool_number(text).has_value());
  }
}

TEST_CASE("fixed numbers have exactly the requested digits, rounded to nearest") {
  CHECK(format_fixed(1.23456, 3) == "1.235");
  CHECK(format_fixed(-1.23456, 3) == "-1.235");
  CHECK(format_fixed(0.0005000001, 3) == "0.001");
  CHECK(format_fixed(0.0004999999, 3) == "0.000");
  CHECK(format_fixed(9.9996, 3) == "10.000");
  CHECK(format_fixed(7.0, 0) == "7");
  CHECK(format_fixed(0.125, 2) == "0.12");  // a tie, exact in binary: to even
}

TEST_CASE("zero is never written with a sign") {
  CHECK(format_fixed(-0.0, 3) == "0.000");
  CHECK(format_fixed(-0.0004, 3) == "0.000");
  CHECK(format_fixed(-0.4, 0) == "0");
  CHECK(format_fixed(-0.0006, 3) == "-0.001");
  CHECK_FALSE(std::signbit(rounded(-0.0001, 3)));
}

TEST_CASE("huge and tiny numbers are written without exponent") {
  CHECK(format_fixed(1e22, 1) == "10000000000000000000000.0");
  CHECK(format_fixed(1e-300, 3) == "0.000");
  CHECK(format_fixed(std::numeric_limits<double>::denorm_min(), 6) == "0.000000");
  const auto largest = format_fixed(-std::numeric_limits<double>::max(), 3);
  CHECK(largest.size() == 1 + 309 + 4);
  CHECK(read_number(largest) == -std::numeric_limits<double>::max());
}

TEST_CASE("a rounded number equals its text read back, and rounding twice has no further effect") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> values(-1000, 1000);
  for (int i = 0; i < 1000; ++i) {
    const double value = values(random);
    const int decimals = i % 7;
    CAPTURE(value);
    CAPTURE(decimals);
    const double once = rounded(value, decimals);
    CHECK(read_number(format_fixed(value, decimals)) == once);
    CHECK(rounded(once, decimals) == once);
    CHECK(std::abs(once - value) <= 0.5 * std::pow(10, -decimals) * (1 + 1e-9) + 1e-12);
  }
}
