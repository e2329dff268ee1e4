#include "program/robot/kuka/names.hpp"

#include <algorithm>
#include <array>

#include "program/robot/kuka/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr auto types = std::to_array<std::string_view>(
    {"DECL", "INT", "REAL", "BOOL", "CHAR", "POS", "E3POS", "E6POS", "FRAME", "AXIS", "E3AXIS", "E6AXIS"});

}  // namespace

bool begins_declaration(std::string_view head) {
  return std::find(types.begin(), types.end(), head) != types.end();
}

std::optional<KrlAssignment> assignment_at(std::string_view text, std::size_t at, std::size_t end) {
  const Span variable = variable_at(text, at, end);
  const std::size_t equals = behind_blanks(text, variable.end, end);
  if (empty(variable) || equals >= end || text[equals] != '=') return std::nullopt;
  return KrlAssignment{variable, {behind_blanks(text, equals + 1, end), end}};
}

std::optional<KrlAssignment> assignment_in(std::string_view text, Span code) {
  for (std::size_t at = code.begin; at < code.end;) {
    if (const auto assignment = assignment_at(text, at, code.end)) return assignment;
    const Span name = name_at(text, at, code.end);
    if (empty(name)) return std::nullopt;
    at = behind_blanks(text, name.end, code.end);
  }
  return std::nullopt;
}

bool names_targets(std::string_view lines) {
  RobotLine line;
  while (next_robot_line(lines, krl_comment, line)) {
    if (part(lines, line.code).find('=') == std::string_view::npos) continue;
    const auto assignment = assignment_in(lines, line.code);
    if (!assignment || lines[assignment->variable.begin] == '$') continue;
    const auto aggregate = aggregate_at(lines, assignment->value.begin, assignment->value.end);
    if (aggregate && (krl_target(*aggregate) || find_component(*aggregate, "A1") != nullptr)) return true;
  }
  return false;
}

std::map<std::string, std::size_t, std::less<>> uses_of_names(std::string_view text) {
  std::map<std::string, std::size_t, std::less<>> uses;
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) {
    const std::string head = krl_word(part(text, name_at(text, line.code.begin, line.code.end)));
    if (begins_declaration(head) && !assignment_in(text, line.code)) continue;
    for (std::size_t at = line.code.begin; at < line.code.end;) {
      const Span variable = variable_at(text, at, line.code.end);
      at = empty(variable) ? at + 1 : variable.end;
      const std::string name = krl_word(part(text, variable));
      if (!empty(variable)) ++uses[name.substr(0, name.find('.'))];
    }
  }
  return uses;
}

}  // namespace counterflex
