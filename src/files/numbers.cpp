#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::uint64_t, 20> whole_powers_of_ten = [] {
  std::array<std::uint64_t, 20> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] * 10;
  return powers;
}();

/// Writes the last `count` digits of `number` before `end`.
void put_digits(std::uint64_t number, int count, char* end) {
  static constexpr auto pairs = [] {
    std::array<char, 200> digits{};
    for (std::size_t i = 0; i < digits.size(); ++i)
      digits[i] = static_cast<char>('0' + (i % 2 == 0 ? i / 20 : i / 2 % 10));
    return digits;
  }();
  for (; count >= 2; count -= 2, number /= 100) std::memcpy(end -= 2, &pairs[number % 100 * 2], 2);
  if (count == 1) *--end = static_cast<char>('0' + number % 10);
}

}  // namespace

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
  const auto [end, error] =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  if (error != std::errc{}) throw std::length_error("format_fixed: too many decimals");
  std::string text(buffer, end);
  const bool zero = std::none_of(text.begin(), text.end(), [](char c) { return c >= '1' && c <= '9'; });
  if (zero && text.front() == '-') text.erase(0, 1);
  return text;
}

std::string format_beside(double value, double limit, int decimals) {
  constexpr int most = 9;
  std::string text = format_fixed(value, decimals);
  while (decimals < most && value != limit && text == format_fixed(limit, decimals))
    text = format_fixed(value, ++decimals);
  return text;
}

char* put_steps(std::int64_t whole, int decimals, char* to) {
  if (whole < 0) *to++ = '-';
  const auto steps = static_cast<std::uint64_t>(whole < 0 ? -whole : whole);
  const std::uint64_t power = whole_powers_of_ten[static_cast<std::size_t>(decimals)];
  const std::uint64_t before_point = steps / power;
  int digits = 1;
  while (before_point >= whole_powers_of_ten[static_cast<std::size_t>(digits)]) ++digits;
  char* const point = to + digits;
  put_digits(before_point, digits, point);
  *point = '.';
  put_digits(steps - before_point * power, decimals, point + 1 + decimals);
  return point + 1 + decimals;
}

double rounded(double value, int decimals) {
  if (const std::optional<double> whole = whole_steps(value, decimals))
    return value_of_steps(*whole, decimals);
  return *read_number(format_fixed(value, decimals));
}

}  // namespace counterflex
