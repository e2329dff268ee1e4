#include "program/robot/rapid/motion.hpp"

#include <algorithm>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// Position of the first '\' of `argument` that is outside of brackets.
std::size_t options_of(std::string_view text, Span argument) {
  int depth = 0;
  for (std::size_t at = argument.begin; at < argument.end;) {
    const RapidToken token = rapid_token_at(text, at, argument.end);
    if (is_symbol(text, token, '(') || is_symbol(text, token, '[')) ++depth;
    if (is_symbol(text, token, ')') || is_symbol(text, token, ']')) --depth;
    if (depth == 0 && is_symbol(text, token, '\\')) return token.span.begin;
    at = token.span.end;
  }
  return argument.end;
}

/// Tokens [begin, end) without blanks around them.
Span trimmed(std::string_view text, Span span) {
  Span all{rapid_token_at(text, span.begin, span.end).span.begin, span.begin};
  for (std::size_t at = span.begin;;) {
    const RapidToken token = rapid_token_at(text, at, span.end);
    if (token.kind == RapidTokenKind::none) break;
    all.end = at = token.span.end;
  }
  return {std::min(all.begin, all.end), all.end};
}

void add_options(std::string_view text, Span span, std::vector<RapidOption>& options) {
  for (std::size_t at = span.begin; at < span.end;) {
    const RapidToken name = rapid_token_at(text, at + 1, span.end);
    const RapidToken assign = rapid_token_at(text, name.span.end, span.end);
    RapidOption option{.name = rapid_word(part(text, name.span)), .value = {}};
    at = options_of(text, {name.span.end, span.end});
    if (assign.kind == RapidTokenKind::assign) option.value = trimmed(text, {assign.span.end, at});
    options.push_back(std::move(option));
  }
}

/// The value of "ToPoint:=p1" and of "p1".
Span without_name(std::string_view text, Span value) {
  const RapidToken name = rapid_token_at(text, value.begin, value.end);
  const RapidToken assign = rapid_token_at(text, name.span.end, value.end);
  return assign.kind == RapidTokenKind::assign ? trimmed(text, {assign.span.end, value.end}) : value;
}

}  // namespace

const RapidOption* RapidMotion::find(std::string_view name) const {
  const auto found = std::ranges::find(options, name, &RapidOption::name);
  return found != options.end() ? &*found : nullptr;
}

RapidMotion rapid_motion(std::string_view text, const RapidStatement& statement) {
  RapidMotion motion;
  std::vector<Span> values;
  for (const Span argument : rapid_arguments(text, {statement.rest, statement.span.end})) {
    const std::size_t options = options_of(text, argument);
    const Span value = trimmed(text, {argument.begin, options});
    if (!empty(value) || options == argument.end) values.push_back(without_name(text, value));
    add_options(text, {options, argument.end}, motion.options);
  }
  const std::size_t target_count = statement.head == "MOVEC" ? 2 : 1;
  motion.complete = values.size() == target_count + 3 &&
                    std::ranges::none_of(values, [](Span value) { return empty(value); });
  if (!motion.complete) return motion;
  motion.targets.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(target_count));
  motion.speed = values[target_count];
  motion.zone = values[target_count + 1];
  motion.tool = values[target_count + 2];
  return motion;
}

}  // namespace counterflex
