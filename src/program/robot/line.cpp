#include "program/robot/line.hpp"

#include <algorithm>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Position of the comment mark in [begin, end), else `end`.
std::size_t comment_in(std::string_view text, std::string_view mark, std::size_t begin, std::size_t end) {
  bool quoted = false;
  for (std::size_t at = begin; at < end; ++at) {
    if (text[at] == '"') quoted = !quoted;
    if (!quoted && text.substr(at, end - at).starts_with(mark)) return at;
  }
  return end;
}

Span without_blanks(std::string_view text, Span span) {
  const auto blank = [&](std::size_t at) { return is_blank(text[at]) || is_ignored(text[at]); };
  while (span.begin < span.end && blank(span.begin)) ++span.begin;
  while (span.end > span.begin && blank(span.end - 1)) --span.end;
  return span;
}

std::size_t digits_behind(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

/// Position behind an exponent at `at`, else `at`.
std::size_t behind_exponent(std::string_view text, std::size_t at) {
  if (at >= text.size() || upper(text[at]) != 'E') return at;
  std::size_t digits = at + 1;
  if (digits < text.size() && (text[digits] == '+' || text[digits] == '-')) ++digits;
  const std::size_t end = digits_behind(text, digits);
  return end > digits ? end : at;
}

}  // namespace

bool next_robot_line(std::string_view text, std::string_view comment_mark, RobotLine& line) {
  const std::size_t begin = line.line_end.end;
  if (begin >= text.size()) return false;
  line.line += 1 + line.more_lines;
  line.more_lines = 0;
  const std::size_t newline = std::min(text.find('\n', begin), text.size());
  const std::size_t end = newline > begin && text[newline - 1] == '\r' ? newline - 1 : newline;
  line.span = {begin, end};
  line.line_end = {end, std::min(newline + 1, text.size())};
  if (is_guard_line(part(text, line.span))) {  // checks that counterflex wrote move nothing
    line.code = line.comment = {end, end};
    return true;
  }
  const std::size_t first = begin == 0 ? std::min(byte_order_mark(text), end) : begin;
  const std::size_t mark = comment_in(text, comment_mark, first, end);
  line.code = without_blanks(text, {first, mark});
  line.comment = {std::min(mark + comment_mark.size(), end), end};
  return true;
}

std::optional<RobotNumber> number_at(std::string_view text, std::size_t at) {
  const bool is_signed = at < text.size() && (text[at] == '+' || text[at] == '-');
  const std::size_t whole = at + (is_signed ? 1 : 0);
  std::size_t end = digits_behind(text, whole);
  std::size_t digits = end - whole;
  RobotNumber number;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = end + 1;
    end = digits_behind(text, fraction);
    number.decimals = static_cast<int>(end - fraction);
    digits += end - fraction;
  }
  if (digits == 0 || number.decimals > most_decimals) return std::nullopt;
  end = behind_exponent(text, end);
  if (end < text.size() && (is_identifier_character(text[end]) || text[end] == '.')) return std::nullopt;
  const auto value = read_number(text.substr(at, end - at));
  if (!value) return std::nullopt;
  number.span = {at, end};
  number.value = *value;
  return number;
}

std::size_t behind_blanks(std::string_view text, std::size_t at, std::size_t end) {
  while (at < end && is_blank(text[at])) ++at;
  return at;
}

bool is_among(std::string_view word, std::span<const std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void refuse(const std::string& file, const RobotLine& line, std::size_t at, const std::string& message) {
  throw InputError(ErrorKind::program_text, {file, line.line, static_cast<int>(at - line.span.begin) + 1},
                   message);
}

}  // namespace counterflex
