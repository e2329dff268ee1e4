#include "program/robot/ur/names.hpp"

#include <algorithm>
#include <array>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// Counts the names in `code` from `at` on, but not in strings.
void count_names(std::string_view text, Span code, UrNames& names) {
  visit_ur_names(text, code, [&](Span name) {
    const auto found = names.variables.find(part(text, name));
    if (found == names.variables.end())
      names.variables[std::string(part(text, name))].read = 1;
    else
      ++found->second.read;
  });
}

void add_assignment(std::string_view text, const UrAssignment& assignment, bool in_body, UrNames& names) {
  UrVariable& variable = names.variables[std::string(part(text, assignment.variable))];
  variable.values.push_back(assignment.value);
  variable.in_body = variable.in_body || in_body;
  variable.by_member = variable.by_member || assignment.of_member;
}

}  // namespace

bool ur_begins_function(std::string_view head) {
  return head == "def" || head == "thread" || head == "sec";
}

bool ur_opens_body(std::string_view head) {
  return ur_begins_function(head) || head == "if" || head == "while" || head == "for" || head == "switch";
}

std::optional<UrAssignment> ur_assignment(std::string_view text, Span code) {
  Span name = ur_name_at(text, code.begin, code.end);
  if (part(text, name) == "global" || part(text, name) == "local")
    name = ur_name_at(text, behind_blanks(text, name.end, code.end), code.end);
  if (empty(name)) return std::nullopt;
  std::size_t at = behind_blanks(text, name.end, code.end);
  const std::size_t member = at;
  while (at < code.end && (text[at] == '[' || text[at] == '.')) {
    const std::size_t close = text[at] == '[' ? text.find(']', at) : ur_name_at(text, at + 1, code.end).end;
    if (close >= code.end) return std::nullopt;
    at = behind_blanks(text, text[at] == '[' ? close + 1 : close, code.end);
  }
  const bool is_assignment = at < code.end && text[at] == '=' && (at + 1 >= code.end || text[at + 1] != '=');
  if (!is_assignment) return std::nullopt;
  return UrAssignment{name, {behind_blanks(text, at + 1, code.end), code.end}, at != member};
}

UrNames ur_names(std::string_view text) {
  UrNames names;
  std::vector<UrFunctions*>
      bodies;  // of the open ones: the calls of their function; null outside of functions
  std::size_t depth_of_program = 0;
  RobotLine line;
  while (next_robot_line(text, ur_comment, line)) {
    if (empty(line.code) || text[line.code.begin] == '$') continue;
    const Span head = ur_name_at(text, line.code.begin, line.code.end);
    const std::string_view word = part(text, head);
    UrFunctions* const function = bodies.empty() ? nullptr : bodies.back();
    if (ur_begins_function(word)) {
      const Span name = ur_name_at(text, behind_blanks(text, head.end, line.code.end), line.code.end);
      if (bodies.empty()) depth_of_program = word == "def" ? 1 : 0;
      bodies.push_back(&names.functions[std::string(part(text, name))]);
    } else {
      if (ur_opens_body(word)) bodies.push_back(function);
      if (function != nullptr)
        for (const UrCallName& call : ur_calls(text, line.code)) function->insert(call.word);
    }
    if (word == "end" && !bodies.empty()) bodies.pop_back();
    const auto assignment = ur_assignment(text, line.code);
    if (assignment) add_assignment(text, *assignment, bodies.size() > depth_of_program, names);
    count_names(text, assignment ? assignment->value : line.code, names);
  }
  return names;
}

Span ur_resolved(std::string_view text, const UrNames& names, Span value) {
  if (empty(value) || ur_name_at(text, value.begin, value.end).end != value.end) return value;
  const auto found = names.variables.find(part(text, value));
  if (found == names.variables.end()) return value;
  // Outside of bodies statements run once, in the order of the text.
  const UrVariable& variable = found->second;
  const auto behind = std::ranges::lower_bound(variable.values, value.begin, {}, &Span::begin);
  if (variable.in_body || variable.by_member || behind == variable.values.begin()) return value;
  const Span last = *(behind - 1);
  const bool may_change = variable.values.size() > 1 && last.begin < names.last_unknown_call;
  return may_change ? value : last;
}

std::optional<double> ur_constant(std::string_view text, const UrNames& names, Span value) {
  const auto number = ur_number(text, ur_resolved(text, names, value));
  return number ? std::optional(number->value) : std::nullopt;
}

}  // namespace counterflex
