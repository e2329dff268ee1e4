#include "program/robot/rapid/lex.hpp"

#include <algorithm>
#include <cmath>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Letters of names may be those of ISO 8859-1.
bool is_name_character(char c) {
  return is_identifier_character(c) || static_cast<unsigned char>(c) >= 0x80;
}

bool is_space(char c) {
  return is_blank(c) || c == '\n' || is_ignored(c);
}

/// Position behind blanks, line ends and comments, and behind the byte order mark of a file.
std::size_t behind_space(std::string_view text, std::size_t at, std::size_t end) {
  if (at == 0) at = std::min(byte_order_mark(text), end);
  while (at < end) {
    if (text[at] == '!')
      at = std::min(text.find('\n', at), end);
    else if (is_space(text[at]))
      ++at;
    else
      break;
  }
  return at;
}

std::size_t behind_names(std::string_view text, std::size_t at, std::size_t end) {
  while (at < end && is_name_character(text[at])) ++at;
  return at;
}

/// Position behind the digits, the point and the exponent that begin at `at`.
std::size_t behind_number(std::string_view text, std::size_t at, std::size_t end) {
  while (at < end && (is_digit(text[at]) || text[at] == '.')) ++at;
  if (at < end && upper(text[at]) == 'E') {
    ++at;
    if (at < end && (text[at] == '+' || text[at] == '-')) ++at;
  }
  return behind_names(text, at, end);
}

/// Position behind the string that begins at `at`; a string ends in its line.
std::size_t behind_string(std::string_view text, std::size_t at, std::size_t end) {
  for (++at; at < end && text[at] != '\n'; ++at)
    if (text[at] == '"') return at + 1;
  return at;
}

bool opens(char c) {
  return c == '[' || c == '(' || c == '{';
}

bool closes(char c) {
  return c == ']' || c == ')' || c == '}';
}

/// The value from `at` up to a comma or a closing bracket.
RapidList value_at(std::string_view text, std::size_t at, std::size_t end) {
  RapidList value{.span = {behind_space(text, at, end), 0}};
  value.span.end = value.span.begin;
  int depth = 0;
  for (RapidToken token; at < end; at = token.span.end) {
    token = rapid_token_at(text, at, end);
    if (token.kind == RapidTokenKind::none) break;
    const char c = text[token.span.begin];
    const bool symbol = token.kind == RapidTokenKind::symbol;
    if (symbol && depth == 0 && (c == ',' || closes(c))) break;
    if (symbol && opens(c)) ++depth;
    if (symbol && closes(c)) --depth;
    value.span.end = token.span.end;
  }
  return value;
}

/// The plain number that is the whole value.
std::optional<RobotNumber> plain(std::string_view text, const RapidList& value) {
  const auto number = number_at(text, value.span.begin);
  return !value.is_list && number && number->span.end == value.span.end ? number : std::nullopt;
}

}  // namespace

RapidToken rapid_token_at(std::string_view text, std::size_t at, std::size_t end) {
  at = behind_space(text, at, end);
  if (at >= end) return {RapidTokenKind::none, {end, end}};
  const char c = text[at];
  if (is_digit(c) || (c == '.' && at + 1 < end && is_digit(text[at + 1])))
    return {RapidTokenKind::number, {at, behind_number(text, at, end)}};
  if (is_name_character(c)) return {RapidTokenKind::name, {at, behind_names(text, at, end)}};
  if (c == '"') return {RapidTokenKind::string, {at, behind_string(text, at, end)}};
  if (c == ':' && at + 1 < end && text[at + 1] == '=') return {RapidTokenKind::assign, {at, at + 2}};
  return {RapidTokenKind::symbol, {at, at + 1}};
}

std::string rapid_word(std::string_view text) {
  std::string word;
  for (const char c : text)
    if (!is_space(c)) word += upper(c);
  return word;
}

bool is_symbol(std::string_view text, const RapidToken& token, char symbol) {
  return token.kind == RapidTokenKind::symbol && text[token.span.begin] == symbol;
}

Span rapid_variable_at(std::string_view text, std::size_t at, std::size_t end) {
  const RapidToken name = rapid_token_at(text, at, end);
  if (name.kind != RapidTokenKind::name) return {at, at};
  Span variable = name.span;
  for (;;) {
    const RapidToken next = rapid_token_at(text, variable.end, end);
    if (is_symbol(text, next, '{')) {
      const std::size_t close = text.find('}', next.span.end);
      if (close >= end) return variable;
      variable.end = close + 1;
    } else if (is_symbol(text, next, '.')) {
      const RapidToken member = rapid_token_at(text, next.span.end, end);
      if (member.kind != RapidTokenKind::name) return variable;
      variable.end = member.span.end;
    } else {
      return variable;
    }
  }
}

std::optional<RapidList> rapid_list_at(std::string_view text, std::size_t at, std::size_t end) {
  constexpr int deepest = 8;
  struct Reader {
    std::string_view text;
    std::size_t end;
    std::optional<RapidList> list_at(std::size_t at, int depth) const {
      if (at >= end || text[at] != '[' || depth > deepest) return std::nullopt;
      RapidList list{.span = {at, at + 1}, .is_list = true};
      for (;;) {
        const RapidToken first = rapid_token_at(text, list.span.end, end);
        std::optional<RapidList> item = is_symbol(text, first, '[') ? list_at(first.span.begin, depth + 1)
                                                                    : value_at(text, list.span.end, end);
        if (!item) return std::nullopt;
        const RapidToken next = rapid_token_at(text, item->span.end, end);
        list.items.push_back(std::move(*item));
        list.span.end = next.span.end;
        if (is_symbol(text, next, ']')) return list;
        if (!is_symbol(text, next, ',')) return std::nullopt;
      }
    }
  };
  return Reader{text, end}.list_at(at, 0);
}

bool is_robtarget(const RapidList& list) {
  constexpr std::array<std::size_t, 4> sizes{3, 4, 4, 6};
  if (!list.is_list || list.items.size() != sizes.size()) return false;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const RapidList& part = list.items[i];
    const auto is_value = [](const RapidList& value) { return !value.is_list && !empty(value.span); };
    if (!part.is_list || part.items.size() != sizes[i] || !std::ranges::all_of(part.items, is_value))
      return false;
  }
  return true;
}

std::optional<RobotTarget> rapid_target(std::string_view text, const RapidList& list) {
  RobotTarget target;
  for (std::size_t i = 0; i < 3; ++i)
    if (!(target.position[i] = plain(text, list.items[0].items[i]))) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i)
    if (!(target.orientation[i] = plain(text, list.items[1].items[i]))) return std::nullopt;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto number = plain(text, list.items[3].items[i]);
    if (!number) return std::nullopt;
    if (std::abs(number->value) < rapid_not_connected) target.external[i] = number->value;
  }
  return target;
}

std::vector<Span> rapid_arguments(std::string_view text, Span span) {
  std::vector<Span> arguments;
  std::size_t at = span.begin;
  for (;;) {
    arguments.push_back(value_at(text, at, span.end).span);
    const RapidToken comma = rapid_token_at(text, arguments.back().end, span.end);
    if (!is_symbol(text, comma, ',')) return arguments;
    at = comma.span.end;
  }
}

std::string in_one_line(std::string_view text) {
  if (text.find_first_of("\n!") == std::string_view::npos) return std::string(text);
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const RapidToken token = rapid_token_at(text, at, text.size());
    line += text.substr(token.span.begin, token.span.end - token.span.begin);
    at = token.span.end;
  }
  return line;
}

}  // namespace counterflex
