#pragma once
/// Numbers in text: read with from_chars, written with to_chars; never locale, never exponent, never "-0".
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace counterflex {

/// The whole of `text` as a finite number; a leading "+" is allowed. Nothing where it is anything else
/// (empty, "nan", trailing characters).
std::optional<double> read_number(std::string_view text);

/// A tool's number, "3", "T3" or "t3": digits alone, at most 2147483647. Nothing where it is anything else.
std::optional<long> read_tool_number(std::string_view text);

/// `value` with exactly `decimals` digits after the point, rounded to nearest; no exponent, no "-0".
std::string format_fixed(double value, int decimals);

/// The same with more digits where these do not tell it from `limit`, nine at most.
std::string format_beside(double value, double limit, int decimals);

/// Powers of ten that are taken from a table.
inline constexpr std::array<double, 10> small_powers_of_ten{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

/// `value` in whole steps of ten to the power of minus `decimals`, far below 2^53; nothing where it is so
/// near a tie that the last bit of the product counts, so large, or without a power in the table.
inline std::optional<double> whole_steps(double value, int decimals) {
  if (decimals < 0 || static_cast<std::size_t>(decimals) >= small_powers_of_ten.size()) return std::nullopt;
  const double scaled = value * small_powers_of_ten[static_cast<std::size_t>(decimals)];
  // Beyond this size a double has no digits after the point, so that the sum is rounded.
  constexpr double size = 3.0 * (std::int64_t{1} << 51);
  const double whole = (scaled + size) - size;
  if (!(std::abs(scaled) < 1e12 && std::abs(scaled - whole) < 0.499)) return std::nullopt;
  return whole;
}

/// The value of `whole` steps: the very number that its text is read as.
inline double value_of_steps(double whole, int decimals) {
  return whole == 0 ? 0.0 : whole / small_powers_of_ten[static_cast<std::size_t>(decimals)];
}

/// `value` rounded to `decimals` digits, as the text of `format_fixed` would be read.
double rounded(double value, int decimals);

}  // namespace counterflex
