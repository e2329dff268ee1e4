#include "program/number_style.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "counterflex/files/numbers.hpp"

namespace counterflex {
namespace {

int decimals_in(std::string_view number) {
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) return 0;
  return static_cast<int>(std::count_if(number.begin() + static_cast<std::ptrdiff_t>(point), number.end(),
                                        [](char c) { return c >= '0' && c <= '9'; }));
}

bool has_leading_zero(std::string_view number) {
  const std::size_t first = number.find_first_of("0123456789.");
  return first == std::string_view::npos || number[first] != '.';
}

/// Drops zeros from the end until `least` digits after the point are left.
void drop_zeros(std::string& text, int least) {
  const std::size_t point = text.find('.');
  while (text.back() == '0' && text.size() - point - 1 > static_cast<std::size_t>(least)) text.pop_back();
}

void drop_leading_zero(std::string& text) {
  const std::size_t zero = text.front() == '-' ? 1 : 0;
  if (text[zero] == '0' && text.size() > zero + 2 && text[zero + 1] == '.') text.erase(zero, 1);
}

/// `whole` over ten to the power of `decimals`: much faster than for any number.
std::string with_point(std::int64_t whole, int decimals) {
  std::array<char, 32> buffer;
  char* at = buffer.data() + buffer.size();
  auto rest = static_cast<std::uint64_t>(whole < 0 ? -whole : whole);
  for (int i = 0; i < decimals; ++i, rest /= 10) *--at = static_cast<char>('0' + rest % 10);
  *--at = '.';
  do *--at = static_cast<char>('0' + rest % 10);
  while ((rest /= 10) > 0);
  if (whole < 0) *--at = '-';
  return {at, buffer.data() + buffer.size()};
}

}  // namespace

std::string inserted_number(double value, int decimals) {
  constexpr double whole_numbers_of_64_bits = 1e15;
  const double scaled = decimals >= 0 && decimals < 10 ? std::round(value * power_of_ten(decimals)) : 2e15;
  if (std::abs(scaled) < whole_numbers_of_64_bits)
    return with_point(static_cast<std::int64_t>(scaled), decimals);
  std::string text = format_fixed(value, decimals);
  if (decimals == 0) text += '.';
  return text;
}

std::string changed_number(std::string_view original, double value, int decimals) {
  std::string text = inserted_number(value, decimals);
  drop_zeros(text, std::min(decimals_in(original), decimals));
  if (!has_leading_zero(original)) drop_leading_zero(text);
  if (original.starts_with('+') && text.front() != '-') text.insert(text.begin(), '+');
  return text;
}

bool rounds_to(double original, double wanted, int decimals) {
  constexpr double least = 1e-10;  // digits beyond what a double of some metres holds are no correction
  return std::abs(wanted - original) <= std::max(0.5 / power_of_ten(decimals), least);
}

double power_of_ten(int digits) {
  constexpr std::array<double, 10> powers{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
  const auto i = static_cast<std::size_t>(digits);
  return digits >= 0 && i < powers.size() ? powers[i] : std::pow(10.0, digits);
}

}  // namespace counterflex
