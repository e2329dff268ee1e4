#include "counterflex/files/numbers.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace counterflex {

std::optional<double> read_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<long> read_tool_number(std::string_view text) {
  if (text.starts_with('T') || text.starts_with('t')) text.remove_prefix(1);
  std::int32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || text.front() == '-') return std::nullopt;
  return number;
}

std::string format_fixed(double value, int decimals) {
  char buffer[std::numeric_limits<double>::max_exponent10 + 64];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  std::string text(buffer, end);
  const bool zero = std::none_of(text.begin(), text.end(), [](char c) { return c >= '1' && c <= '9'; });
  if (zero && text.front() == '-') text.erase(0, 1);
  return text;
}

namespace {

/// The nearest whole number, the even one of two, of a `value` far below 2^51: beyond that size a double has
/// no digits after the point, so that the sum is rounded.
double nearest_whole(double value) {
  constexpr double size = 3.0 * (std::int64_t{1} << 51);
  return (value + size) - size;
}

}  // namespace

double rounded(double value, int decimals) {
  // A whole number over a power of ten is the very number that its text is read as; only near a tie does the
  // product's last bit count.
  constexpr std::array<double, 10> powers{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
  if (decimals >= 0 && static_cast<std::size_t>(decimals) < powers.size()) {
    const double power = powers[static_cast<std::size_t>(decimals)];
    const double scaled = value * power, whole = nearest_whole(scaled);
    if (std::abs(scaled) < 1e12 && std::abs(scaled - whole) < 0.499) return whole == 0 ? 0.0 : whole / power;
  }
  return *read_number(format_fixed(value, decimals));
}

}  // namespace counterflex
