#pragma once
/// Text for terminals: emphasis and wrapped paragraphs.
#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "counterflex/files/text.hpp"

namespace counterflex {

inline constexpr std::size_t text_width = 100;

/// ANSI emphasis, or plain text.
struct Ink {
  bool colour = false;
  bool marks = false;  ///< the terminal shows UTF-8
  std::string bold(std::string_view text) const { return paint(text, "\033[1m"); }
  std::string good(std::string_view text) const { return paint(text, "\033[32m"); }
  std::string warning(std::string_view text) const { return paint(text, "\033[33m"); }
  std::string bad(std::string_view text) const { return paint(text, "\033[1;31m"); }

 private:
  std::string paint(std::string_view text, std::string_view code) const;
};

/// `text` in lines of at most `text_width` bytes. `first` is before the first line, the others are indented
/// by `indent` blanks. Breaks at blanks; a word longer than a line is not broken. Ends with a newline.
/// Control characters of `text` are shown as their numbers; `first` may have ANSI sequences.
std::string wrapped(std::string_view first, std::string_view text, std::size_t indent);

inline std::string line_break() {
  return std::string(1, '\n');
}

/// "37 times"; empty where that is below ten times, or `after` below what is shown of it.
std::string times_smaller(double before_mm, double after_mm);

/// Millimetres in summaries.
inline std::string mm4(double value) {
  return format_fixed(value, 4);
}

/// A stiffness (N/um) as `fixed`, or with three significant digits where `fixed` has fewer than two.
inline std::string stiffness_text(double shown, std::string fixed) {
  constexpr double small = 0.01;
  return std::abs(shown) < small ? fmt::format("{:.3g}", shown) : std::move(fixed);
}

/// Blank if unknown.
inline std::string mm4(const std::optional<double>& value) {
  return value ? mm4(*value) : "";
}

/// A row of a table: a label, and the values before and after; blank if unknown.
std::string before_after_row(const std::string& label, const std::string& before, const std::string& after);

/// "1 move", "2 moves".
inline std::string counted(std::size_t count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace counterflex
