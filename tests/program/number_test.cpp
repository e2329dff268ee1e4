#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "counterflex/files/numbers.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a rounded value is to the last bit the one that its text is read as, ties and -0 included") {
  std::mt19937_64 bits(31);
  for (int i = 0; i < 200000; ++i) {
    const int decimals = static_cast<int>(bits() % 11);
    const double size = std::pow(10.0, static_cast<double>(bits() % 12) - 4);
    double value = (static_cast<double>(bits() % 2000001) / 1e6 - 1) * size;
    if (i % 3 == 0) value = (std::round(value * 1e3) + 0.5) / 1e3;
    CAPTURE(value);
    CAPTURE(decimals);
    const double expected = *read_number(format_fixed(value, decimals));
    CHECK(rounded(value, decimals) == expected);
    CHECK(std::signbit(rounded(value, decimals)) == std::signbit(expected));
  }
}

TEST_CASE("a written number is the text of its rounded value, whatever its size") {
  std::mt19937_64 bits(32);
  for (int i = 0; i < 20000; ++i) {
    const double size = std::pow(10.0, static_cast<double>(bits() % 9) - 3);
    const double value = (static_cast<double>(bits() % 2000001) / 1e6 - 1) * size + 1e-3;
    const std::string text = with_last_move("G21 G0 X0.0000\n", {.end_mm = {value, 0, 0}});
    const std::string expected = "G21 G0 X" + format_fixed(value, 4) + "\n";
    if (std::abs(value) > 1e-4) CHECK(text == expected);
  }
}
