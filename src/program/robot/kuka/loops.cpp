#include "program/robot/kuka/loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "program/program_files.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto all_motions =
    std::to_array<std::string_view>({"LIN", "PTP", "CIRC", "LIN_REL", "PTP_REL", "CIRC_REL", "SPLINE",
                                     "PTP_SPLINE", "SLIN", "SCIRC", "SPTP"});

std::string head_of(std::string_view text, const RobotLine& line) {
  return krl_word(part(text, name_at(text, line.code.begin, line.code.end)));
}

/// "NAME[index].member" of a variable.
struct Indexed {
  std::string name, index, member;  ///< in upper case
};
std::optional<Indexed> indexed(std::string_view variable) {
  const std::string word = krl_word(variable);
  const std::size_t open = word.find('['), close = word.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return std::nullopt;
  Indexed result{word.substr(0, open), word.substr(open + 1, close - open - 1), ""};
  if (close + 1 == word.size()) return result;
  if (word[close + 1] != '.') return std::nullopt;
  result.member = word.substr(close + 2);
  return result;
}

/// FOR counter = first TO last
struct ForStatement {
  std::string counter;
  long first = 0, last = 0;
  Span last_number;
};
std::optional<ForStatement> for_statement(std::string_view text, const RobotLine& line) {
  const Span head = name_at(text, line.code.begin, line.code.end);
  const auto assignment = assignment_at(text, behind_blanks(text, head.end, line.code.end), line.code.end);
  if (krl_word(part(text, head)) != "FOR" || !assignment) return std::nullopt;
  const std::string value = [&] {
    std::string upper_case(part(text, assignment->value));
    for (char& c : upper_case) c = upper(c);
    return upper_case;
  }();
  const std::size_t to = value.find(" TO ");
  if (to == std::string::npos || value.find("STEP") != std::string::npos) return std::nullopt;
  constexpr std::size_t to_size = 4;
  const std::size_t begin = assignment->value.begin;
  Span last{behind_blanks(text, begin + to + to_size, assignment->value.end), assignment->value.end};
  const auto first_value = whole_number(text, {begin, begin + to}), last_value = whole_number(text, last);
  if (!first_value || !last_value) return std::nullopt;
  return ForStatement{krl_word(part(text, assignment->variable)), *first_value, *last_value, last};
}

/// What the statements of a loop do.
struct Body {
  std::string counter;
  KrlLoop loop{};
  bool followed = true;
  int conditions = 0;  ///< around the statement
};

/// The array and member of "LIN NAME[counter].member"; false for other motions.
bool read_target(std::string_view text, const RobotLine& line, Body& body) {
  if (head_of(text, line) != "LIN" || !body.loop.array.empty() || body.conditions > 0) return false;
  const Span head = name_at(text, line.code.begin, line.code.end);
  const Span variable = variable_at(text, behind_blanks(text, head.end, line.code.end), line.code.end);
  const auto target = indexed(part(text, variable));
  const std::size_t next = behind_blanks(text, variable.end, line.code.end);
  if (!target || target->index != body.counter || (next < line.code.end && text[next] == ':')) return false;
  body.loop.array = target->name;
  body.loop.member = target->member;
  body.loop.motion = line;
  return true;
}

/// The last name before the parameters: DEF NAME( ), DEFFCT INT NAME( ).
std::string name_of_routine(std::string_view text, const RobotLine& line) {
  Span last{};
  for (std::size_t at = line.code.begin; at < line.code.end && text[at] != '(';) {
    const Span name = name_at(text, at, line.code.end);
    if (!empty(name)) last = name;
    at = empty(name) ? at + 1 : name.end;
  }
  return krl_word(part(text, last));
}

/// Whether "NAME(" begins the statement: a call. BAS selects frames and speeds, but does not move the robot.
bool is_call(std::string_view text, const RobotLine& line) {
  constexpr auto no_calls =
      std::to_array<std::string_view>({"BAS", "IF", "ELSEIF", "WHILE", "UNTIL", "SWITCH", "WAIT"});
  const Span head = name_at(text, line.code.begin, line.code.end);
  const std::size_t next = behind_blanks(text, head.end, line.code.end);
  return next < line.code.end && text[next] == '(' && !is_among(krl_word(part(text, head)), no_calls);
}

/// The variable that a statement assigns, in upper case; empty for other statements.
std::string assigned_variable(std::string_view text, const RobotLine& line) {
  const auto assignment = assignment_at(text, line.code.begin, line.code.end);
  return assignment ? krl_word(part(text, assignment->variable)) : "";
}

/// Whether a statement of another routine may move the robot or select another frame.
bool moves_or_calls(std::string_view text, const RobotLine& line) {
  const std::string variable = assigned_variable(text, line);
  return is_among(head_of(text, line), all_motions) || is_call(text, line) || variable.starts_with("$BASE") ||
         variable.starts_with("$TOOL");
}

/// Whether a statement other than a motion leaves targets, frames and the robot's position as they are.
bool is_harmless(std::string_view text, const RobotLine& line) {
  constexpr auto harmless = std::to_array<std::string_view>(
      {"BAS", "WAIT", "TRIGGER", "IF", "ELSE", "ELSEIF", "ENDIF", "SWITCH", "CASE", "DEFAULT", "ENDSWITCH"});
  constexpr auto settings = std::to_array<std::string_view>({"$VEL", "$ACC", "$APO", "$OUT", "$ANOUT"});
  if (const std::string variable = assigned_variable(text, line); !variable.empty())
    return !variable.starts_with("$") ||
           std::any_of(settings.begin(), settings.end(),
                       [&](std::string_view name) { return variable.starts_with(name); });
  if (is_call(text, line)) return !may_move(text, head_of(text, line));
  return is_among(head_of(text, line), harmless);
}

/// Refuses a statement that changes an element of the loop: its target is not the one of the data list.
void refuse_change(std::string_view text, const std::string& file, const RobotLine& line, const Body& body) {
  const auto assignment = assignment_at(text, line.code.begin, line.code.end);
  const auto target = assignment ? indexed(part(text, assignment->variable)) : std::nullopt;
  if (!target || target->index != body.counter) return;
  constexpr auto members = std::to_array<std::string_view>({"", "X", "Y", "Z", "A", "B", "C"});
  const std::string_view member = std::string_view(target->member).substr(target->member.rfind('.') + 1);
  if (!is_among(member, members)) return;
  refuse(file, line, assignment->variable.begin,
         fmt::format("'{}' is computed at run time: its target is not the one of the data list; write the "
                     "values into the data list",
                     part(text, assignment->variable)));
}

/// How often the text uses the array, apart from assignments of elements with a number as index, which data
/// lists have, and declarations.
std::size_t uses_of_array(std::string_view text, std::string_view array) {
  std::size_t uses = 0;
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.span).starts_with(file_mark)) break;
    if (begins_declaration(head_of(text, line)) || head_of(text, line) == "GLOBAL") continue;
    for (std::size_t at = line.code.begin; at < line.code.end;) {
      const Span name = name_at(text, at, line.code.end);
      at = empty(name) ? at + 1 : name.end;
      if (!empty(name) && krl_word(part(text, name)) == array) ++uses;
    }
  }
  return uses;
}

void read_statement_of(std::string_view text, const std::string& file, const RobotLine& line, Body& body) {
  const std::string name = head_of(text, line);
  if (name == "ENDIF" || name == "ENDSWITCH") --body.conditions;
  if (name == "IF" || name == "SWITCH") ++body.conditions;
  refuse_change(text, file, line, body);
  body.loop.sets_speed = body.loop.sets_speed || is_call(text, line) || name == "BAS" ||
                         assigned_variable(text, line).starts_with("$VEL");
  if (is_among(name, all_motions) ? !read_target(text, line, body) : !is_harmless(text, line))
    body.followed = false;
}

}  // namespace

std::optional<long> whole_number(std::string_view text, Span span) {
  while (span.begin < span.end && is_blank(text[span.begin])) ++span.begin;
  while (span.end > span.begin && is_blank(text[span.end - 1])) --span.end;
  long value = 0;
  const auto [end, error] = std::from_chars(text.data() + span.begin, text.data() + span.end, value);
  if (error != std::errc() || end != text.data() + span.end || empty(span)) return std::nullopt;
  return value;
}

std::optional<KrlLoop> loop_over_array(std::string_view text, const std::string& file,
                                       const RobotLine& line) {
  const auto head = for_statement(text, line);
  if (!head) return std::nullopt;
  Body body{.counter = head->counter};
  body.loop.first = head->first;
  body.loop.last = head->last;
  body.loop.last_number = head->last_number;
  RobotLine inside = line;
  for (;;) {
    if (!next_robot_line(text, krl_comment, inside)) return std::nullopt;
    if (empty(inside.code)) continue;
    const std::string name = head_of(text, inside);
    if (part(text, inside.span).starts_with(file_mark) || name == "END") return std::nullopt;
    if (name == "ENDFOR") break;
    read_statement_of(text, file, inside, body);
  }
  body.loop.end = inside.line_end.end;
  if (!body.followed || body.loop.array.empty()) return std::nullopt;
  const std::string_view statements = text.substr(line.span.begin, body.loop.end - line.span.begin);
  const bool elsewhere = uses_of_array(text, body.loop.array) != uses_of_array(statements, body.loop.array);
  return elsewhere ? std::nullopt : std::optional(body.loop);
}

bool may_move(std::string_view text, std::string_view routine) {
  RobotLine line;
  bool inside = false;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.span).starts_with(file_mark)) return true;
    if (empty(line.code)) continue;
    const std::string head = head_of(text, line);
    if (inside && (begins_routine(text, line) || head == "END" || head == "ENDFCT")) return false;
    if (begins_routine(text, line))
      inside = name_of_routine(text, line) == routine;
    else if (inside && moves_or_calls(text, line))
      return true;
  }
  return true;
}

}  // namespace counterflex
