#include "program/robot/ur/lex.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Position of the first ',' or closing bracket from `at` on that is outside of inner brackets and of
/// strings; `end` without one.
std::size_t end_of_argument(std::string_view text, std::size_t at, std::size_t end) {
  int depth = 0;
  bool quoted = false;
  for (; at < end; ++at) {
    const char c = text[at];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (depth == 0 && (c == ',' || c == ')' || c == ']')) return at;
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
  }
  return end;
}

Span ur_trimmed(std::string_view text, Span span) {
  while (span.begin < span.end && is_blank(text[span.begin])) ++span.begin;
  while (span.end > span.begin && is_blank(text[span.end - 1])) --span.end;
  return span;
}

UrArgument argument_of(std::string_view text, Span span) {
  UrArgument argument{{span.begin, span.begin}, span, span};
  const Span name = ur_name_at(text, span.begin, span.end);
  const std::size_t equals = behind_blanks(text, name.end, span.end);
  const bool named = !empty(name) && equals < span.end && text[equals] == '=' &&
                     (equals + 1 >= span.end || text[equals + 1] != '=');
  if (named) argument = {name, ur_trimmed(text, {equals + 1, span.end}), span};
  return argument;
}

/// The parameters of the motion functions in order: "The URScript Programming Language", module motion.
std::span<const std::string_view> parameters_of(std::string_view function) {
  static constexpr auto line = std::to_array<std::string_view>({"pose", "a", "v", "t", "r"});
  static constexpr auto process = std::to_array<std::string_view>({"pose", "a", "v", "r"});
  static constexpr auto circle =
      std::to_array<std::string_view>({"pose_via", "pose_to", "a", "v", "r", "mode"});
  if (function == "movec") return circle;
  if (function == "movep") return process;
  return line;
}

}  // namespace

std::optional<UrCall> ur_call_at(std::string_view text, std::size_t at, std::size_t end) {
  UrCall call{ur_name_at(text, at, end), {}, {}};
  const std::size_t open = behind_blanks(text, call.name.end, end);
  if (empty(call.name) || open >= end || text[open] != '(') return std::nullopt;
  for (std::size_t next = open + 1;;) {
    const std::size_t stop = end_of_argument(text, next, end);
    if (stop >= end || text[stop] == ']') return std::nullopt;
    const Span span = ur_trimmed(text, {next, stop});
    const bool none = empty(span) && call.arguments.empty() && text[stop] == ')';
    if (!none) call.arguments.push_back(argument_of(text, span));
    next = stop + 1;
    if (text[stop] == ',') continue;
    call.span = {at, next};
    return call;
  }
}

std::optional<UrCall> ur_call_in_line(std::string_view text, std::size_t begin) {
  RobotLine line;
  line.line_end.end = begin;
  next_robot_line(text, ur_comment, line);
  return ur_call_at(text, line.code.begin, line.code.end);
}

std::optional<UrNumbers> ur_list(std::string_view text, Span value) {
  if (!part(text, value).starts_with('[') || text[value.end - 1] != ']') return std::nullopt;
  UrNumbers numbers;
  std::size_t at = value.begin + 1;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t stop = end_of_argument(text, at, value.end);
    const char expected = i + 1 < numbers.size() ? ',' : ']';
    if (stop >= value.end || text[stop] != expected) return std::nullopt;
    const auto number = ur_number(text, ur_trimmed(text, {at, stop}));
    if (!number) return std::nullopt;
    numbers[i] = *number;
    at = stop + 1;
  }
  return at == value.end ? std::optional(numbers) : std::nullopt;
}

std::optional<UrPose> ur_pose(std::string_view text, Span value) {
  if (!part(text, value).starts_with("p[")) return std::nullopt;
  const auto numbers = ur_list(text, {value.begin + 1, value.end});
  return numbers ? std::optional(UrPose{value, *numbers}) : std::nullopt;
}

std::optional<RobotNumber> ur_number(std::string_view text, Span value) {
  auto number = number_at(text, value.begin);
  if (number && number->span.end != value.end) number.reset();
  return number;
}

Span ur_name_at(std::string_view text, std::size_t at, std::size_t end) {
  if (at >= end || is_digit(text[at])) return {at, at};
  std::size_t behind = at;
  while (behind < end && is_identifier_character(text[behind])) ++behind;
  return {at, behind};
}

std::vector<UrCallName> ur_calls(std::string_view text, Span code) {
  std::vector<UrCallName> calls;
  Span before{};  // the last name
  visit_ur_names(text, code, [&](Span name) {
    const bool is_method = name.begin > code.begin && text[name.begin - 1] == '.';
    const bool has_object = is_method && before.end + 1 == name.begin;
    const std::size_t open = behind_blanks(text, name.end, code.end);
    if (open < code.end && text[open] == '(')
      calls.push_back({{has_object ? before.begin : name.begin, name.end},
                       (is_method ? "." : "") + std::string(part(text, name))});
    before = name;
  });
  return calls;
}

std::optional<std::size_t> ur_second_statement(std::string_view text, Span value) {
  constexpr auto operators = std::to_array<std::string_view>({"and", "or", "xor", "not", "run"});
  bool behind_operand = false;
  for (std::size_t at = value.begin; at < value.end;) {
    const char c = text[at];
    std::size_t end = at;
    if (c == '"') end = std::min(text.find('"', at + 1), value.end - 1) + 1;
    while (c != '"' && end < value.end && (is_identifier_character(text[end]) || text[end] == '.')) ++end;
    const bool is_operand = end > at && c != '.' && !is_among(text.substr(at, end - at), operators);
    if (is_operand && behind_operand) return at;
    if (end > at || !is_blank(c)) behind_operand = is_operand || c == '.' || c == ')' || c == ']';
    at = std::max(end, at + 1);
  }
  return std::nullopt;
}

Span ur_operand(std::string_view text, Span value) {
  const auto call = ur_call_at(text, value.begin, value.end);
  if (!call || call->span.end != value.end) return value;
  const std::string_view name = part(text, call->name);
  const std::size_t count = call->arguments.size();
  if (name == "pose_trans" && count == 2) return ur_operand(text, call->arguments[1].value);
  if (name == "get_inverse_kin" && (count == 1 || count == 2))
    return ur_operand(text, call->arguments[0].value);
  return value;
}

const UrArgument* ur_argument(std::string_view text, const UrCall& call, std::string_view name) {
  const auto parameters = parameters_of(part(text, call.name));
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const UrArgument& argument = call.arguments[i];
    const bool positional = empty(argument.name);
    if (positional ? i < parameters.size() && parameters[i] == name : part(text, argument.name) == name)
      return &argument;
  }
  return nullptr;
}

}  // namespace counterflex
