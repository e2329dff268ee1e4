#include "report/text/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/text.hpp"

namespace counterflex {

std::string Ink::paint(std::string_view text, std::string_view code) const {
  if (!colour) return std::string(text);
  return std::string(code).append(text).append("\033[0m");
}

std::string wrapped(std::string_view first, std::string_view text, std::size_t indent) {
  std::string result(first);
  std::size_t column = first.size();
  bool line_has_words = false;
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find_first_of(" \t\n"), text.size());
    const std::string_view word = text.substr(0, blank);
    text.remove_prefix(std::min(blank + 1, text.size()));
    if (word.empty()) continue;
    if (line_has_words && column + 1 + word.size() > text_width) {
      result.append("\n").append(indent, ' ');
      column = indent;
      line_has_words = false;
    }
    if (line_has_words) {
      result += ' ';
      ++column;
    }
    const std::string shown = without_controls(word);
    result += shown;
    column += shown.size();
    line_has_words = true;
  }
  return result + "\n";
}

std::string before_after_row(const std::string& label, const std::string& before, const std::string& after) {
  std::string text = fmt::format("  {:<34}{:>12}{:>14}", label, before, after);
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

std::string times_smaller(double before_mm, double after_mm) {
  constexpr double least_shown_mm = 1e-4;  // smaller ones are shown as zero or by one digit
  if (after_mm < least_shown_mm || before_mm < 10 * after_mm) return "";
  return fmt::format("{} times", format_fixed(before_mm / after_mm, 0));
}

}  // namespace counterflex
