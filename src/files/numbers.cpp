#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "counterflex/files/text.hpp"

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

double rounded(double value, int decimals) {
  if (const std::optional<double> whole = whole_steps(value, decimals))
    return value_of_steps(*whole, decimals);
  return *read_number(format_fixed(value, decimals));
}

}  // namespace counterflex
