#pragma once
/// Numbers in text, and text that is fit to be shown.
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

// Numbers in text: read with from_chars, written with to_chars; never locale, never exponent, never "-0".

/// The whole of `text` as a finite number; a leading "+" is allowed. Nothing for other text (empty,
/// "nan", trailing characters).
std::optional<double> read_number(std::string_view text);

/// A tool's number, "3", "T3" or "t3": digits alone, at most 2147483647. Nothing for other text.
std::optional<long> read_tool_number(std::string_view text);

/// `value` with exactly `decimals` digits after the point, rounded to nearest; no exponent, no "-0".
std::string format_fixed(double value, int decimals);

/// The same with more digits, nine at most, where `decimals` digits do not distinguish it from `limit`.
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

/// Writes `whole` / 10^`decimals` at `to`, with a decimal point, and returns the end. It has at most 24
/// characters for up to 9 decimals.
char* put_steps(std::int64_t whole, int decimals, char* to);

/// `value` rounded to `decimals` digits, as the text of `format_fixed` would be read.
double rounded(double value, int decimals);

// Text of inputs (names of files, comments, values) as it is shown.

/// `text` with every control character replaced by its code: those of ASCII and of U+0080 to U+009F, line
/// ends among them, and those that turn the direction of text or break lines (U+202E ...). A terminal or a
/// page cannot be changed by the result, and it is one line. Other bytes stay, tabs become blanks.
std::string without_controls(std::string_view text);

/// The same for each line of `text`: its line ends stay.
std::string lines_without_controls(std::string_view text);

/// The entry of `known` that a misspelt `name` probably means, or empty. Few letters differ, or only the part
/// after the first underscore (the unit); then the entry with the longest common beginning.
std::string_view nearest(std::string_view name, const std::vector<std::string_view>& known);

// Characters of text that need not be UTF-8, as the names of files and the comments of programs.

/// The character of UTF-8 at the beginning of `text`, which is not empty; its first byte, 0x80 or above,
/// where none begins there.
std::string_view first_character(std::string_view text);

/// Any bytes as UTF-8: a byte that is not part of a UTF-8 character is written as % and two hexadecimal
/// digits, % itself as %25.
std::string utf8_of_bytes(std::string_view bytes);

/// The bytes that `utf8_of_bytes` was given, for what it writes.
std::string bytes_of_utf8(std::string_view text);

}  // namespace counterflex
