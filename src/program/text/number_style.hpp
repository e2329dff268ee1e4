#pragma once
/// Writes coordinates.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "counterflex/files/text.hpp"

namespace counterflex {

/// Most digits behind the decimal point of a number of a program, far more than a double has. `format_fixed`
/// can write this many.
inline constexpr int most_decimals = 60;

/// The message about a word with more than `most_decimals`.
std::string too_many_decimals(std::string_view word, int decimals);

/// Appends `value` in the style of the number `original`: its sign style ("+1"), its leading zero or none
/// (".5"), its decimals or more, up to `decimals`, if the value needs them. Always with a decimal point.
void append_changed_number(std::string_view original, double value, int decimals, std::string& text);

/// The same as a string.
std::string changed_number(std::string_view original, double value, int decimals);

/// `value` with `decimals` digits after the decimal point, which is always written.
std::string inserted_number(double value, int decimals);

/// 10^`digits`, at least for 0 to 9.
inline double power_of_ten(int digits) {
  const auto i = static_cast<std::size_t>(digits);
  return digits >= 0 && i < small_powers_of_ten.size() ? small_powers_of_ten[i] : std::pow(10.0, digits);
}

/// Half a unit of the last of `decimals` digits.
inline double half_of_last(int decimals) {
  static constexpr auto halves = [] {
    std::array<double, small_powers_of_ten.size()> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = 0.5 / small_powers_of_ten[i];
    return table;
  }();
  const auto i = static_cast<std::size_t>(decimals);
  return decimals >= 0 && i < halves.size() ? halves[i] : 0.5 / power_of_ten(decimals);
}

/// Whether `wanted` is within half a unit of the last of `decimals` digits of `original`, so that the word
/// stays. Also true if they differ by rounding errors only (1e-10).
inline bool rounds_to(double original, double wanted, int decimals) {
  constexpr double least = 1e-10;  // below the resolution of a double of some metres
  return std::abs(wanted - original) <= std::max(half_of_last(decimals), least);
}

}  // namespace counterflex
