#include "report/json/fixed_digits.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "counterflex/files/text.hpp"

using namespace counterflex;

namespace {

std::string appended(double value, int decimals) {
  std::string text = "x=";
  append_fixed(text, value, decimals);
  return text.substr(2);
}

// Each of `values` as `format_fixed` writes it.
std::string expected(const std::vector<double>& values, int decimals) {
  std::string row;
  for (const double value : values) row += ',' + format_fixed(value, decimals);
  return row;
}

}  // namespace

TEST_CASE("cells of tables have the digits that numbers have elsewhere") {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> exponent(-14, 16), part(-1, 1);
  for (int k = 0; k < 20'000; ++k) {
    const double value = part(random) * std::pow(10, exponent(random));
    const int decimals = static_cast<int>(random() % 12);
    CAPTURE(value);
    CHECK(appended(value, decimals) == format_fixed(value, decimals));
  }
}

TEST_CASE("cells of ties, zeros and almost whole numbers are those of format_fixed") {
  for (const double value : {0.0, -0.0, 0.5, -0.5, 1.5, 0.125, 0.375, -2.5, 1e-9, -1e-9, 0.9999999, 999.99995,
                             1e12, 123456789.0, -0.00000005})
    for (int decimals = 0; decimals <= 9; ++decimals) {
      CAPTURE(value);
      CAPTURE(decimals);
      CHECK(appended(value, decimals) == format_fixed(value, decimals));
    }
}

TEST_CASE("a row has all of its cells, those without a fast way among them") {
  const std::vector<double> values{1, 0.5, -1e300, 2,  3,      1e13, 4,  5,  6,
                                   7, 8,   9,      10, -11.25, 12,   13, 14, 1e18};
  for (int decimals = 0; decimals <= 12; ++decimals)
    for (std::size_t count = 0; count <= values.size(); ++count) {
      CAPTURE(decimals);
      CAPTURE(count);
      const std::vector<double> some(values.begin(), values.begin() + static_cast<long>(count));
      std::string row = "x";
      append_cells(row, some, decimals);
      CHECK(row == "x" + expected(some, decimals));
    }
}
