#include "program/robot/kuka/lex.hpp"

#include <algorithm>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool is_name_character(char c) {
  return is_identifier_character(c) || c == '$';
}

/// Position of the first ',' or closing brace from `at` on that is outside of inner brackets, else
/// `end`.
std::size_t end_of_component(std::string_view text, std::size_t at, std::size_t end) {
  int depth = 0;
  for (; at < end; ++at) {
    const char c = text[at];
    if (depth == 0 && (c == ',' || c == '}')) return at;
    if (c == '{' || c == '(' || c == '[') ++depth;
    if (c == '}' || c == ')' || c == ']') --depth;
  }
  return end;
}

Span without_blanks_behind(std::string_view text, Span span) {
  while (span.end > span.begin && is_blank(text[span.end - 1])) --span.end;
  return span;
}

/// Position behind "E6POS:", the type of an aggregate, else `at`.
std::size_t behind_type(std::string_view text, std::size_t at, std::size_t end) {
  const Span type = name_at(text, behind_blanks(text, at, end), end);
  const std::size_t colon = behind_blanks(text, type.end, end);
  return type.end > type.begin && colon < end && text[colon] == ':' ? colon + 1 : at;
}

}  // namespace

std::optional<KrlAggregate> aggregate_at(std::string_view text, std::size_t at, std::size_t end) {
  if (at >= end || text[at] != '{') return std::nullopt;
  KrlAggregate aggregate;
  std::size_t next = behind_type(text, at + 1, end);
  for (;;) {
    const std::size_t stop = end_of_component(text, next, end);
    if (stop == end) return std::nullopt;
    const Span name = name_at(text, behind_blanks(text, next, stop), stop);
    if (name.begin == name.end) return std::nullopt;
    KrlComponent component;
    component.name = krl_word(text.substr(name.begin, name.end - name.begin));
    component.value = without_blanks_behind(text, {behind_blanks(text, name.end, stop), stop});
    component.span = {name.begin, std::max(name.end, component.value.end)};
    if (auto number = number_at(text, component.value.begin);
        number && number->span.end == component.value.end)
      component.number = number;
    aggregate.components.push_back(std::move(component));
    if (text[stop] == '}') {
      aggregate.span = {at, stop + 1};
      return aggregate;
    }
    next = stop + 1;
  }
}

const KrlComponent* find_component(const KrlAggregate& aggregate, std::string_view name) {
  for (const KrlComponent& component : aggregate.components)
    if (component.name == name) return &component;
  return nullptr;
}

Span name_at(std::string_view text, std::size_t at, std::size_t end) {
  if (at >= end || is_digit(text[at])) return {at, at};
  std::size_t behind = at;
  while (behind < end && is_name_character(text[behind])) ++behind;
  return {at, behind};
}

Span variable_at(std::string_view text, std::size_t at, std::size_t end) {
  Span variable = name_at(text, at, end);
  while (variable.end > variable.begin && variable.end < end) {
    const std::size_t next = behind_blanks(text, variable.end, end);
    if (next < end && text[next] == '[') {
      const std::size_t close = text.find(']', next);
      if (close >= end) break;
      variable.end = close + 1;
    } else if (next < end && text[next] == '.') {
      const Span member = name_at(text, behind_blanks(text, next + 1, end), end);
      if (member.begin == member.end) break;
      variable.end = member.end;
    } else {
      break;
    }
  }
  return variable;
}

bool begins_routine(std::string_view text, const RobotLine& line) {
  const auto word_at = [&](std::size_t at) { return name_at(text, at, line.code.end); };
  const auto word = [&](Span span) { return krl_word(text.substr(span.begin, span.end - span.begin)); };
  Span head = word_at(line.code.begin);
  if (word(head) == "GLOBAL") head = word_at(behind_blanks(text, head.end, line.code.end));
  return word(head) == "DEF" || word(head) == "DEFFCT";
}

std::string krl_word(std::string_view text) {
  std::string word;
  for (const char c : text)
    if (!is_blank(c)) word += upper(c);
  return word;
}

}  // namespace counterflex
