#pragma once
/// Numbers in text: read with from_chars, written with to_chars; never locale, never exponent, never "-0".
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

/// `value` rounded to `decimals` digits, as the text of `format_fixed` would be read.
double rounded(double value, int decimals);

}  // namespace counterflex
