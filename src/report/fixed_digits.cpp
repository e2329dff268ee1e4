#include "fixed_digits.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "counterflex/files/numbers.hpp"

namespace counterflex {
namespace {

constexpr std::array<double, 10> powers_of_ten{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
constexpr double most_steps = 1e12;   // of whole steps: the product's last bit is far from one of them
constexpr double tie_margin = 0.499;  // where it counts all the same

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
  const bool in_table = decimals >= 0 && static_cast<std::size_t>(decimals) < powers_of_ten.size();
  const double scaled = in_table ? value * powers_of_ten[static_cast<std::size_t>(decimals)] : HUGE_VAL;
  const double whole = std::nearbyint(scaled);
  if (!(std::abs(scaled) < most_steps && std::abs(scaled - whole) < tie_margin)) {
    text += format_fixed(value, decimals);
    return;
  }
  if (whole < 0) text += '-';
  const auto digits = static_cast<std::int64_t>(std::abs(whole));
  char buffer[24];
  // A leading one keeps the zeros behind the point.
  const auto power = static_cast<std::int64_t>(powers_of_ten[static_cast<std::size_t>(decimals)]);
  const char* end = std::to_chars(buffer, buffer + sizeof buffer, digits / power).ptr;
  text.append(buffer, static_cast<std::size_t>(end - buffer));
  if (decimals == 0) return;
  end = std::to_chars(buffer, buffer + sizeof buffer, power + digits % power).ptr;
  buffer[0] = '.';
  text.append(buffer, static_cast<std::size_t>(end - buffer));
}

}  // namespace counterflex
