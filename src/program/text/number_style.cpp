#include "program/text/number_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace counterflex {
namespace {

/// Style of a number.
struct NumberStyle {
  int decimals = 0;
  bool leading_zero = true;
  bool plus = false;
};

NumberStyle read_style(std::string_view number) {
  NumberStyle style;
  style.plus = number.starts_with('+');
  bool digit = false, point = false;
  for (const char c : number) {
    if (c == '.') {
      if (!digit && !point) style.leading_zero = false;
      point = true;
    } else if (c >= '0' && c <= '9') {
      digit = true;
      style.decimals += point ? 1 : 0;
    }
  }
  return style;
}

/// The characters of a number, with space for a sign before them.
struct NumberText {
  std::array<char, 400> buffer;
  char* begin = buffer.data() + 1;
  char* end = begin;

  std::string_view view() const { return {begin, static_cast<std::size_t>(end - begin)}; }
};

/// The nearest integer, as `std::round`, of a value that fits in 64 bits.
std::int64_t nearest(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  const double rest = value - static_cast<double>(whole);
  return rest >= 0.5 ? whole + 1 : rest <= -0.5 ? whole - 1 : whole;
}

/// `value` with `decimals` digits after the decimal point, which is always written.
void put_number(double value, int decimals, NumberText& text) {
  constexpr double whole_numbers_of_64_bits = 1e15;
  const double scaled = decimals >= 0 && decimals < 10 ? value * power_of_ten(decimals) : 2e15;
  if (std::abs(scaled) < whole_numbers_of_64_bits) {
    text.end = put_steps(nearest(scaled), decimals, text.begin);
    return;
  }
  const std::string fixed = format_fixed(value, decimals);
  text.end = std::copy(fixed.begin(), fixed.end(), text.begin);
  if (decimals == 0) *text.end++ = '.';
}

/// Removes zeros at the end, but keeps `least` digits after the decimal point.
void drop_zeros(NumberText& text, int least) {
  const char* point = std::find(text.begin, text.end, '.');
  while (text.end[-1] == '0' && text.end - point - 1 > least) --text.end;
}

void drop_leading_zero(NumberText& text) {
  const bool negative = *text.begin == '-';
  const char* zero = text.begin + (negative ? 1 : 0);
  if (*zero != '0' || text.end - zero <= 2 || zero[1] != '.') return;
  ++text.begin;
  if (negative) *text.begin = '-';
}

void put_changed_number(std::string_view original, double value, int decimals, NumberText& text) {
  const NumberStyle style = read_style(original);
  put_number(value, decimals, text);
  drop_zeros(text, std::min(style.decimals, decimals));
  if (!style.leading_zero) drop_leading_zero(text);
  if (style.plus && *text.begin != '-') *--text.begin = '+';
}

}  // namespace

std::string too_many_decimals(std::string_view word, int decimals) {
  return fmt::format("{}: a number with {} decimals; at most {} are allowed: shorten it", word, decimals,
                     most_decimals);
}

std::string inserted_number(double value, int decimals) {
  NumberText text;
  put_number(value, decimals, text);
  return std::string(text.view());
}

std::string changed_number(std::string_view original, double value, int decimals) {
  NumberText text;
  put_changed_number(original, value, decimals, text);
  return std::string(text.view());
}

void append_changed_number(std::string_view original, double value, int decimals, std::string& text) {
  NumberText number;
  put_changed_number(original, value, decimals, number);
  text.append(number.view());
}

}  // namespace counterflex
