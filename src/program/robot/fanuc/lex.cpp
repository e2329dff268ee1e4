#include "program/robot/fanuc/lex.hpp"

#include <algorithm>
#include <charconv>

#include "program/robot/fanuc/guard.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

Span trimmed(std::string_view text, Span span) {
  while (span.begin < span.end && is_tp_space(text[span.begin])) ++span.begin;
  while (span.end > span.begin && is_tp_space(text[span.end - 1])) --span.end;
  return span;
}

/// "!text" and "--eg:text" in any language.
Span comment_of(std::string_view text, Span code) {
  const std::string_view statement = part(text, code);
  if (statement.starts_with(tp_comment)) return {code.begin + tp_comment.size(), code.end};
  if (statement.starts_with("--")) return {code.begin + 2, code.end};
  return {code.begin, code.begin};
}

/// Whether the byte is a colon at the begin of a line: that of a continuation line.
bool begins_line(std::string_view text, std::size_t begin, std::size_t at) {
  while (at > begin && is_blank(text[at - 1])) --at;
  return at > begin && text[at - 1] == '\n';
}

std::size_t behind_bracket(std::string_view text, std::size_t open, std::size_t end) {
  int depth = 0;
  for (std::size_t at = open; at < end; ++at) {
    if (text[at] == '[') ++depth;
    if (text[at] == ']' && --depth == 0) return at + 1;
  }
  return end;
}

}  // namespace

bool is_tp_space(char c) {
  return is_blank(c) || is_ignored(c) || c == '\n';
}

std::optional<TpSection> tp_section(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t\xef\xbb\xbf"), line.size()));
  if (line.size() < 2 || line[0] != '/' || !is_letter(line[1])) return std::nullopt;
  std::size_t size = 1;
  while (size < line.size() && is_letter(line[size])) ++size;
  const std::string name = tp_word(line.substr(1, size - 1));
  if (name == "MN") return TpSection::statements;
  if (name == "POS") return TpSection::positions;
  if (name == "END") return TpSection::end;
  return TpSection::attributes;
}

std::optional<TpLineNumber> tp_line_number(std::string_view text, Span line) {
  TpLineNumber number;
  std::size_t at = behind_blanks(text, line.begin, line.end);
  number.digits.begin = at;
  while (at < line.end && is_digit(text[at])) ++at;
  number.digits.end = at;
  at = behind_blanks(text, at, line.end);
  if (at >= line.end || text[at] != ':') return std::nullopt;
  number.field = {line.begin, behind_blanks(text, at + 1, line.end)};
  return number;
}

bool next_physical_line(std::string_view text, RobotLine& line) {
  return next_robot_line(text, "\n", line);  // no line contains this mark of a comment
}

bool ends_with_semicolon(std::string_view text, Span span) {
  span = trimmed(text, span);
  return span.end > span.begin && text[span.end - 1] == ';';
}

bool next_tp_line(std::string_view text, TpSection section, RobotLine& line) {
  if (!next_physical_line(text, line)) return false;
  if (section != TpSection::statements || tp_section(part(text, line.span))) return true;
  const auto number = tp_line_number(text, line.span);
  if (!number) return true;
  RobotLine last = line;
  while (!ends_with_semicolon(text, last.span) && next_physical_line(text, last)) {
    const auto more = tp_line_number(text, last.span);
    if (!more || !empty(more->digits)) break;
    ++line.more_lines;
    line.span.end = last.span.end;
    line.line_end = last.line_end;
  }
  Span code = trimmed(text, {number->field.end, line.span.end});
  if (ends_with_semicolon(text, code)) code = trimmed(text, {code.begin, code.end - 1});
  line.comment = comment_of(text, code);
  if (empty(line.comment) && is_tp_guard_statement(text, line.span.begin, part(text, code))) {
    line.code = line.comment = {code.end, code.end};  // a check that counterflex wrote moves nothing
    return true;
  }
  line.code =
      empty(line.comment) && !part(text, code).starts_with(tp_comment) ? code : Span{code.end, code.end};
  return true;
}

std::vector<Span> tp_words(std::string_view text, Span code) {
  std::vector<Span> words;
  for (std::size_t at = code.begin; at < code.end;) {
    const bool continues = text[at] == ':' && begins_line(text, code.begin, at);
    if (is_tp_space(text[at]) || continues) {
      ++at;
      continue;
    }
    Span word{at, at};
    while (word.end < code.end && !is_tp_space(text[word.end]))
      word.end = text[word.end] == '[' ? behind_bracket(text, word.end, code.end) : word.end + 1;
    words.push_back(word);
    at = word.end;
  }
  return words;
}

std::string tp_word(std::string_view text) {
  std::string word;
  for (const char c : text)
    if (!is_tp_space(c)) word += upper(c);
  return word;
}

std::optional<TpInteger> tp_integer(std::string_view text, std::size_t at) {
  at = behind_blanks(text, at, text.size());
  TpInteger integer;
  const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), integer.value);
  if (error != std::errc() || integer.value < 0) return std::nullopt;
  integer.end = static_cast<std::size_t>(end - text.data());
  return integer;
}

std::optional<TpOperand> tp_operand(std::string_view text, Span word) {
  const std::size_t open = std::min(text.find('[', word.begin), word.end);
  if (open == word.end) return std::nullopt;
  TpOperand operand{.array = tp_word(part(text, {word.begin, open})),
                    .span = {word.begin, behind_bracket(text, open, word.end)}};
  if (const auto number = tp_integer(text, open + 1)) {
    const std::size_t next = behind_blanks(text, number->end, word.end);
    if (next < word.end && (text[next] == ']' || text[next] == ':' || text[next] == ','))
      operand.number = number->value;
  }
  return operand;
}

std::vector<TpOperand> tp_positions_in(std::string_view text, Span code) {
  std::vector<TpOperand> found;
  for (std::size_t at = code.begin; (at = text.find_first_of("Pp", at)) < code.end; ++at) {
    if (at + 1 >= code.end || text[at + 1] != '[') continue;
    if (at > code.begin && (is_identifier_character(text[at - 1]) || text[at - 1] == '.')) continue;
    if (auto operand = tp_operand(text, {at, code.end})) found.push_back(std::move(*operand));
  }
  return found;
}

}  // namespace counterflex
