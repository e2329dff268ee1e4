#include "report/json/fixed_digits.hpp"

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
  char* point = std::to_chars(buffer + 1, buffer + sizeof buffer, digits / power).ptr;
  char* end = point;
  if (decimals > 0) {
    // A leading one keeps the zeros after the point.
    end = std::to_chars(point, buffer + sizeof buffer, power + digits % power).ptr;
    *point = '.';
  }
  const char* begin = *whole < 0 ? buffer : buffer + 1;
  text.append(begin, static_cast<std::size_t>(end - begin));
}

}  // namespace counterflex
