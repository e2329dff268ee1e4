#include "program/robot/kuka/loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "program/program_files.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/robot/kuka/routines.hpp"
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

/// The variable that a statement assigns, in upper case; empty for other statements.
std::string assigned_variable(std::string_view text, const RobotLine& line) {
  const auto assignment = assignment_at(text, line.code.begin, line.code.end);
  return assignment ? krl_word(part(text, assignment->variable)) : "";
}

/// Whether a called routine leaves the robot, its frame and its tool. One of another file may do anything.
bool leaves_robot(const KrlFacts& facts, const KrlCall& call) {
  if (reads_into(call, "$BASE") || reads_into(call, "$TOOL")) return false;
  const KrlRoutine* const routine = facts.find(call.word);
  if (routine == nullptr) return is_motionless_call(call.word);
  return !routine->moves && !routine->selects_frame && !routine->selects_tool;
}

/// Whether a statement other than a motion leaves targets, frames and the robot's position as they are. Calls
/// are judged when the loop is known.
bool is_harmless(std::string_view text, const RobotLine& line) {
  constexpr auto harmless = std::to_array<std::string_view>(
      {"WAIT", "TRIGGER", "IF", "ELSE", "ELSEIF", "ENDIF", "SWITCH", "CASE", "DEFAULT", "ENDSWITCH"});
  constexpr auto settings = std::to_array<std::string_view>({"$VEL", "$ACC", "$APO", "$OUT", "$ANOUT"});
  if (const std::string variable = assigned_variable(text, line); !variable.empty())
    return !variable.starts_with("$") ||
           std::any_of(settings.begin(), settings.end(),
                       [&](std::string_view name) { return variable.starts_with(name); });
  return is_krl_call(text, line) || is_among(head_of(text, line), harmless) || may_repeat(text, line);
}

/// Refuses a statement that changes an element of the loop: its target is not the one of the data list.
void refuse_change(std::string_view text, const std::string& file, const RobotLine& line, const Body& body) {
  const auto assignment = assignment_at(text, line.code.begin, line.code.end);
  const auto target = assignment ? indexed(part(text, assignment->variable)) : std::nullopt;
  if (!target || target->index != body.counter || target->name != body.loop.array) return;
  constexpr auto members = std::to_array<std::string_view>({"", "X", "Y", "Z", "A", "B", "C"});
  const std::string_view member = std::string_view(target->member).substr(target->member.rfind('.') + 1);
  if (!is_among(member, members)) return;
  refuse(file, line, assignment->variable.begin,
         fmt::format("'{}' is computed at run time: its target is not the one of the data list; write the "
                     "values into the data list",
                     part(text, assignment->variable)));
}

/// Whether the line declares variables; "GLOBAL INTERRUPT DECL" reads some.
bool declares_variables(std::string_view text, const RobotLine& line) {
  const Span head = name_at(text, line.code.begin, line.code.end);
  const Span next = name_at(text, behind_blanks(text, head.end, line.code.end), line.code.end);
  const bool is_global = krl_word(part(text, head)) == "GLOBAL" && krl_word(part(text, next)) != "INTERRUPT";
  return is_global || begins_declaration(krl_word(part(text, head)));
}

/// How often the text uses the array, apart from assignments of elements with a number as index, which data
/// lists have, and declarations.
std::size_t uses_of_array(std::string_view text, std::string_view array) {
  std::size_t uses = 0;
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.span).starts_with(file_mark)) break;
    if (declares_variables(text, line)) continue;
    for (std::size_t at = line.code.begin; at < line.code.end;) {
      const Span name = name_at(text, at, line.code.end);
      at = empty(name) ? at + 1 : name.end;
      if (!empty(name) && krl_word(part(text, name)) == array) ++uses;
    }
  }
  return uses;
}

void read_statement_of(std::string_view text, const RobotLine& line, Body& body) {
  const std::string name = head_of(text, line);
  if (name == "ENDIF" || name == "ENDSWITCH") --body.conditions;
  if (name == "IF" || name == "SWITCH") ++body.conditions;
  body.loop.sets_speed = body.loop.sets_speed || is_krl_call(text, line) || name == "BAS" ||
                         assigned_variable(text, line).starts_with("$VEL");
  const bool counts = assigned_variable(text, line) == body.counter;
  if (counts || is_among(name, all_motions) ? counts || !read_target(text, line, body)
                                            : !is_harmless(text, line))
    body.followed = false;
}

/// Whether a line has the name of the counter, other than as the index of an element of this pass,
/// NAME[counter].
bool uses_counter(std::string_view text, Span code, const Body& body) {
  for (std::size_t at = code.begin; at < code.end;) {
    const Span variable = variable_at(text, at, code.end), name = name_at(text, at, code.end);
    const auto element = indexed(part(text, variable));
    const bool is_element = element && element->name == body.loop.array && element->index == body.counter;
    if (!empty(name) && krl_word(part(text, name)) == body.counter) return true;
    at = is_element ? variable.end : empty(name) ? at + 1 : name.end;
  }
  return false;
}

/// What a statement computes with: without the variable that it sets, also as the counter of FOR.
Span read_part(std::string_view text, const RobotLine& line) {
  const Span head = name_at(text, line.code.begin, line.code.end);
  const std::size_t begin =
      krl_word(part(text, head)) == "FOR" ? behind_blanks(text, head.end, line.code.end) : line.code.begin;
  const auto assignment = assignment_at(text, begin, line.code.end);
  const bool sets_element =
      assignment && part(text, assignment->variable).find('[') != std::string_view::npos;
  return assignment && !sets_element ? assignment->value : line.code;
}

/// Whether the value that the loop leaves in its counter may be read: more passes would leave another one. A
/// loop that sets the counter reads its own value. Other routines with a counter of the same name have
/// another variable.
bool is_counter_read_outside(std::string_view text, std::size_t loop_begin, const Body& body) {
  struct Routine {
    bool declares = false, reads = false, has_loop = false;
  };
  std::vector<Routine> routines(1);
  std::vector<bool> loops;  // around the line: whether they set the counter
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.span).starts_with(file_mark)) break;
    const std::string head = head_of(text, line);
    const bool begins = begins_routine(text, line);
    if (begins) routines.emplace_back();
    if (line.span.begin == loop_begin) routines.back().has_loop = true;
    if (line.span.begin >= loop_begin && line.span.begin < body.loop.end) continue;
    if (begins || declares_variables(text, line)) {
      routines.back().declares = routines.back().declares || uses_counter(text, line.code, body);
      continue;
    }
    const Span read = read_part(text, line);
    const bool is_set = std::find(loops.begin(), loops.end(), true) != loops.end();
    routines.back().reads = routines.back().reads || (!is_set && uses_counter(text, read, body));
    if (head == "FOR")
      loops.push_back(uses_counter(text, {line.code.begin, read.begin}, body));
    else if (head == "ENDFOR" && !loops.empty())
      loops.pop_back();
  }
  const auto own = std::ranges::find(routines, true, &Routine::has_loop);
  const auto reads_same = [](const Routine& routine) { return routine.reads && !routine.declares; };
  if (own == routines.end()) return true;
  return own->reads || (!own->declares && std::ranges::any_of(routines, reads_same));
}

/// Judges the statements of the loop beside its motion, whose array and routines are known now.
void judge_statements(std::string_view text, const KrlFacts& facts, const RobotLine& first, Body& body) {
  KrlLoop& loop = body.loop;
  if (facts.changed_in(body.counter) > 0) body.followed = false;
  loop.acts = is_counter_read_outside(text, first.span.begin, body);
  RobotLine line = first;
  while (next_robot_line(text, krl_comment, line) && line.line_end.end < loop.end) {
    if (empty(line.code) || line.line == loop.motion.line) continue;
    const bool calls = is_krl_call(text, line);
    const KrlRoutine* const routine = calls ? facts.find(head_of(text, line)) : nullptr;
    for (const KrlCall& call : krl_calls(text, line))
      if (!leaves_robot(facts, call)) body.followed = false;
    const bool repeats = calls ? routine != nullptr && !routine->acts : may_repeat(text, line);
    loop.acts = loop.acts || !repeats || uses_counter(text, line.code, body);
    const std::string variable = assigned_variable(text, line);
    if (!variable.empty()) loop.assigned.push_back(variable);
    loop.sets_zone = loop.sets_zone || calls || head_of(text, line) == "BAS" || variable.starts_with("$APO");
  }
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
    read_statement_of(text, inside, body);
  }
  body.loop.end = inside.line_end.end;
  if (body.loop.array.empty()) return std::nullopt;
  for (inside = line; next_robot_line(text, krl_comment, inside) && inside.line_end.end < body.loop.end;)
    refuse_change(text, file, inside, body);
  if (!body.followed) return std::nullopt;
  judge_statements(text, krl_facts_of(text), line, body);
  if (!body.followed) return std::nullopt;
  const std::string_view statements = text.substr(line.span.begin, body.loop.end - line.span.begin);
  const bool elsewhere = uses_of_array(text, body.loop.array) != uses_of_array(statements, body.loop.array);
  return elsewhere ? std::nullopt : std::optional(body.loop);
}

}  // namespace counterflex
