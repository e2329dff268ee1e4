#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "counterflex/files/text.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a rounded value is to the last bit the one read from its text, ties and -0 included") {
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

TEST_CASE("a written number is the text of its rounded value, for any magnitude") {
  std::mt19937_64 bits(32);
  for (int i = 0; i < 20000; ++i) {
    const double size = std::pow(10.0, static_cast<double>(bits() % 9) - 3);
    const double value = (static_cast<double>(bits() % 2000001) / 1e6 - 1) * size + 1e-3;
    const std::string text = with_last_move("G21 G0 X0.0000\n", {.end_mm = {value, 0, 0}});
    const std::string expected = "G21 G0 X" + format_fixed(value, 4) + "\n";
    if (std::abs(value) > 1e-4) CHECK(text == expected);
  }
}

TEST_CASE(
    "a changed number keeps the sign style and the leading zero of the original, with as many digits as it "
    "needs") {
  struct Row {
    std::string original;
    double wanted;
    std::string written;
  };
  for (const Row& row : {Row{"1.", 2, "2."}, Row{"1.", 2.5, "2.5"}, Row{"1.000", 2.5, "2.500"},
                         Row{"1.00000", 2.123456, "2.12346"}, Row{".5", 0.25, ".25"},
                         Row{"-.5", -0.25, "-.25"}, Row{"-.5", 0.25, ".25"}, Row{".5", 10.25, "10.25"},
                         Row{"0.5", 0.25, "0.25"}, Row{"+1.5", 2.5, "+2.5"}, Row{"+1.5", -2.5, "-2.5"},
                         Row{"+.5", 0.25, "+.25"}, Row{".5", 0, ".0"}, Row{"1.50", -0.0001, "0.00"},
                         Row{"- 1 . 5", -2.25, "-2.25"}, Row{"7.0", 123456789012.5, "123456789012.5"}}) {
    CAPTURE(row.original);
    CHECK(with_last_move("G21 G0 X" + row.original + "\n", {.end_mm = {row.wanted, 0, 0}}) ==
          "G21 G0 X" + row.written + "\n");
  }
}

TEST_CASE("a number with the most decimals that are read is written with as many") {
  const std::string zeros(57, '0');
  CHECK(with_last_move("G21 G0 X-999999.000" + zeros + "\n", {.end_mm = {-999999.125, 0, 0}}) ==
        "G21 G0 X-999999.125" + zeros + "\n");
}

TEST_CASE("a number with blanks in it has the same value, wherever the line ends") {
  for (const std::string number : {"12.75", "-12.75", "+0.125", ".5", "-.5", "7.", "1234567890.125"}) {
    std::string spaced;
    for (const char c : number) spaced.append(1, c).append(" \t");
    CAPTURE(number);
    for (const std::string after : {"", "\n", " Y1\n", "Y1\n", "(c)\n", " ;\n"}) {
      const Program plain = read("G21 G0 X" + number + after), wide = read("G21 G0 X" + spaced + after);
      CHECK(plain.moves[0].end_mm.x() == *read_number(number));
      CHECK(wide.moves[0].end_mm.x() == plain.moves[0].end_mm.x());
      CHECK(wide.moves[0].words[0]->decimals == plain.moves[0].words[0]->decimals);
    }
  }
}
