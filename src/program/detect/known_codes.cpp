#include "program/detect/known_codes.hpp"

#include <algorithm>

#include "program/gcode/words/codes.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// End of the line that begins at `at`.
std::size_t end_of_line(std::string_view text, std::size_t at) {
  return std::min(text.find('\n', at), text.size());
}

/// Position behind the comment or name that begins at `at`; `at` if there is neither.
std::size_t behind_comment_or_name(std::string_view text, std::size_t at) {
  const std::size_t end = end_of_line(text, at);
  const char close = text[at] == comment_open ? comment_close : '>';
  if (text[at] == ';' || text[at] == '%') return end;
  if (text[at] != comment_open && text[at] != '<') return at;
  return std::min(text.find(close, at), end);
}

/// Tenths of the number at `at`. Empty if there is no number, or if it has more digits.
std::optional<int> tenths_at(std::string_view text, std::size_t at) {
  while (at < text.size() && is_blank(text[at])) ++at;
  int value = 0, digits = 0;
  for (; at < text.size() && is_digit(text[at]) && digits < 4; ++at, ++digits)
    value = 10 * value + (text[at] - '0');
  value *= 10;
  if (digits == 0) return std::nullopt;
  if (at + 1 < text.size() && text[at] == '.' && is_digit(text[at + 1])) value += text[at + 1] - '0';
  return value;
}

/// Whether a code, a comment or a name may begin with the character.
bool begins_something(char c) {
  return c == 'G' || c == 'g' || c == ';' || c == '%' || c == comment_open || c == '<';
}

bool begins_word(std::string_view text, std::size_t at) {
  return at == 0 || !is_letter(text[at - 1]);
}

}  // namespace

bool knows_codes(std::string_view text, const Dialect& dialect) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!begins_something(text[at])) continue;
    at = behind_comment_or_name(text, at);
    if (at == text.size()) break;
    if (upper(text[at]) != 'G' || !begins_word(text, at)) continue;
    const std::optional<int> tenths = tenths_at(text, at + 1);
    if (tenths && find_g_code(*tenths, dialect) == nullptr) return false;
  }
  return true;
}

bool has_loose_comments(std::string_view text) {
  for (std::size_t at = 0; (at = find_either(text, '(', ';', at)) != std::string_view::npos;) {
    const std::size_t end = end_of_line(text, at);
    if (text[at] == ';') {
      at = end;
      continue;
    }
    const std::size_t stop = std::min(text.find_first_of("()", at + 1), end);
    if (stop == end || text[stop] == comment_open) return true;
    at = stop;
  }
  return false;
}

/// The header of a corrected program names the machine, which does not indicate the dialect.
bool is_in_header(std::string_view text, std::size_t at) {
  const std::size_t begin = text.find_last_of('\n', at) + 1;  // 0 in the first line
  return text.substr(begin, at - begin).find("COUNTERFLEX 1 ") != std::string_view::npos;
}

bool names_grbl(std::string_view text) {
  constexpr std::string_view name = "GRBL";
  constexpr std::size_t scanned = 4096;
  text = text.substr(0, scanned);
  for (std::size_t at = 0; (at = find_either(text, 'G', 'g', at)) != std::string_view::npos; ++at)
    if (is_word(text.substr(at, name.size()), name) && !is_in_header(text, at)) return true;
  return false;
}

bool has_semicolon_comments(std::string_view text) {
  for (std::size_t at = 0; (at = find_either(text, '(', ';', at)) != std::string_view::npos; ++at) {
    const std::size_t end = end_of_line(text, at);
    if (text[at] == comment_open) {
      at = std::min(text.find(comment_close, at), end);
      if (at >= text.size()) return false;
      continue;
    }
    int letters = 0, depth = 0;
    for (; at < end && letters < 3; ++at) {
      depth += text[at] == comment_open ? 1 : text[at] == comment_close ? -1 : 0;
      letters = depth == 0 && is_letter(text[at]) ? letters + 1 : 0;
    }
    if (letters == 3) return true;
  }
  return false;
}

bool has_colon_numbers(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); at = end_of_line(text, at) + 1)
    if (text[at] == ':' && at + 1 < text.size() && is_digit(text[at + 1])) return true;
  return false;
}

}  // namespace counterflex
