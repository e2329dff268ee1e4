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
  if (*whole < 0) text += '-';
  const auto digits = static_cast<std::int64_t>(std::abs(*whole));
  const auto power = static_cast<std::int64_t>(small_powers_of_ten[static_cast<std::size_t>(decimals)]);
  char buffer[24];
  const char* end = std::to_chars(buffer, buffer + sizeof buffer, digits / power).ptr;
  text.append(buffer, static_cast<std::size_t>(end - buffer));
  if (decimals == 0) return;
  // A leading one keeps the zeros after the point.
  end = std::to_chars(buffer, buffer + sizeof buffer, power + digits % power).ptr;
  buffer[0] = '.';
  text.append(buffer, static_cast<std::size_t>(end - buffer));
}

}  // namespace counterflex
