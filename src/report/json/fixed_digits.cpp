#include "report/json/fixed_digits.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "counterflex/files/text.hpp"

namespace counterflex {

void append_fixed(std::string& text, double value, int decimals) {
  const std::optional<double> whole = whole_steps(value, decimals);
  if (!whole) {
    text += format_fixed(value, decimals);
    return;
  }
  const auto digits = static_cast<std::int64_t>(std::abs(*whole));
  const auto power = static_cast<std::int64_t>(small_powers_of_ten[static_cast<std::size_t>(decimals)]);
  char buffer[48] = "-";
  const bool is_below_one = digits < power;  // its zeros behind the point are kept by a one before them
  char* end = std::to_chars(buffer + 1, buffer + sizeof buffer, digits + (is_below_one ? power : 0)).ptr;
  if (is_below_one) buffer[1] = '0';
  if (decimals > 0) {
    char* const point = end++ - decimals;
    std::copy_backward(point, point + decimals, end);
    *point = '.';
  }
  const char* begin = *whole < 0 ? buffer : buffer + 1;
  text.append(begin, static_cast<std::size_t>(end - begin));
}

}  // namespace counterflex
