// Data lists: names of targets, and the targets of loops.
#include <fmt/format.h>

#include <algorithm>

#include "program/robot/kuka/names.hpp"
#include "program/robot/kuka/read.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// The aggregate of an element, or of its member.
std::optional<KrlAggregate> target_of_element(std::string_view text, Span value, std::string_view member) {
  auto aggregate = aggregate_at(text, value.begin, value.end);
  if (!aggregate || member.empty()) return aggregate;
  const KrlComponent* component = find_component(*aggregate, member);
  if (component == nullptr) return std::nullopt;
  return aggregate_at(text, component->value.begin, component->value.end);
}

/// The line that has the value of an element.
RobotLine line_of(std::string_view text, const KrlNamed& element) {
  const std::size_t newline = text.rfind('\n', element.value.begin);
  RobotLine line;
  line.line = element.line - 1;
  line.line_end.end = newline == std::string_view::npos ? 0 : newline + 1;
  next_robot_line(text, krl_comment, line);
  return line;
}

/// The element of an array in a data list. Refuses an element whose value is not in braces.
const KrlNamed& element_of(const KrlReading& r, const KrlLoop& loop, long index) {
  const std::string name = fmt::format("{}[{}]", loop.array, index);
  const auto found = r.named.find(name);
  if (found != r.named.end() && !computed_in(r, name)) return found->second;
  refuse(r.robot.program.file, loop.motion, loop.motion.code.begin,
         fmt::format(
             "the data list does not give '{}' of this loop as a target of plain numbers: {} = {{X 1, Y 2, "
             "Z 3, A 0, B 0, C 0}}",
             name, name));
}

/// The move of a loop to one element. In the order of the text it is at the statement of the loop.
void add_element_move(KrlReading& r, const KrlLoop& loop, const RobotLine& line, Span value,
                      const TargetMove& how) {
  const std::string_view text = r.robot.program.text;
  const auto aggregate = target_of_element(text, value, loop.member);
  const auto target = aggregate ? krl_target(*aggregate) : std::nullopt;
  if (!target)
    refuse(r.robot.program.file, line, value.begin,
           fmt::format("'{}' is not a target of plain numbers: {{X 1, Y 2, Z 3, A 0, B 0, C 0}}",
                       part(text, value)));
  add_target_move(r.robot, line, *target, how);
  r.robot.program.moves.back().text_line = loop.motion.line;
}

/// Refuses a loop whose targets are not in the data lists, one behind the other.
void refuse_incomplete(const KrlReading& r, const KrlLoop& loop) {
  const auto array = r.arrays.find(loop.array);
  const auto wrong = [&](const std::string& what) {
    refuse(r.robot.program.file, loop.motion, loop.motion.code.begin,
           fmt::format("the targets {0}[{1}] to {0}[{2}] of this loop {3}", loop.array, loop.first, loop.last,
                       what));
  };
  if (array == r.arrays.end()) wrong("are in no data list; give the list that has them with --data FILE.dat");
  if (!array->second.in_order) wrong("are not in the order of their indices in the data list");
  if (array->second.first > loop.first || array->second.last < loop.last)
    wrong(fmt::format("are not all in the data list: it has {} to {}", array->second.first,
                      array->second.last));
}

/// The size of the array of a loop is one of the program's counts.
void read_declaration(KrlReading& r, const RobotLine& line) {
  Program& program = r.robot.program;
  for (const KrlLoop& loop : r.loops) {
    const auto size = declared_size(program.text, line, loop.array);
    const auto number = size ? whole_number(program.text, *size) : std::nullopt;
    if (!number) continue;
    program.counts.push_back(*size);
    const long last = r.list_follows ? loop.last : r.arrays.find(loop.array)->second.last;
    if (*number < last)
      refuse(
          program.file, line, size->begin,
          fmt::format("'{}' is declared with {} elements, but the list has {}", loop.array, *number, last));
  }
}

}  // namespace

std::optional<int> computed_in(const KrlReading& r, std::string_view variable) {
  if (const int line = r.facts.changed_in(variable)) return line;
  const auto found = r.named.find(variable);
  return found == r.named.end() ? std::nullopt : found->second.computed_in;
}

std::optional<KrlAggregate> named_aggregate(const KrlReading& r, std::string_view name) {
  const auto value_of = [&](std::string_view variable) {
    const auto found = r.named.find(variable);
    const bool known = found != r.named.end() && !computed_in(r, variable);
    return known ? std::optional(found->second.value) : std::nullopt;
  };
  const std::string_view text = r.robot.program.text;
  const std::size_t point = name.rfind('.');
  if (const auto value = value_of(name)) return target_of_element(text, *value, "");
  if (point == std::string_view::npos) return std::nullopt;
  const auto value = value_of(name.substr(0, point));
  return value ? target_of_element(text, *value, name.substr(point + 1)) : std::nullopt;
}

void read_names_of_lists(KrlReading& r) {
  const std::string_view text = r.robot.program.text;
  RobotLine line;
  const std::size_t list = data_list_at(text);
  line.line =
      static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(list), '\n'));
  line.line_end.end = list;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.code).find('{') == std::string_view::npos) continue;
    if (const auto assignment = assignment_in(text, line.code))
      r.named.insert_or_assign(krl_word(part(text, assignment->variable)),
                               KrlNamed{assignment->value, {}, line.line});
  }
}

bool read_data_loop(KrlReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  if (in_body(r) || !r.why_not_followed.empty()) return false;
  const auto loop = loop_over_array(text, r.robot.program.file, line);
  if (!loop) return false;
  // An array that the program itself assigns: its loop is not followed.
  if (!r.data_lists && r.named.contains(fmt::format("{}[{}]", loop->array, loop->first))) return false;
  if (!r.list_follows) refuse_incomplete(r, *loop);
  r.loops.push_back(*loop);
  r.behind_loop = loop->end;
  r.robot.program.counts.push_back(loop->last_number);
  if (loop->sets_speed) r.robot.state.feed_mm_min = 0;
  if (loop->sets_zone) r.zone_mm = 0;
  for (const std::string& variable : loop->assigned)
    r.named.insert_or_assign(changed_part(variable), KrlNamed{{}, line.line});
  const TargetMove how = with_krl_zone(r, part(text, loop->motion.code), {.stays_whole = loop->acts});
  if (r.list_follows) {
    r.followed = KrlFollowedLoop{*loop, how};
    return true;
  }
  std::vector<Move>& moves = r.robot.program.moves;
  const std::size_t all = moves.size() + static_cast<std::size_t>(loop->last - loop->first + 1);
  if (all > moves.capacity()) moves.reserve(std::max(all, 2 * moves.capacity()));
  for (long index = loop->first; index <= loop->last; ++index) {
    const KrlNamed& element = element_of(r, *loop, index);
    add_element_move(r, *loop, line_of(text, element), element.value, how);
  }
  return true;
}

void read_data_line(KrlReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  if (r.loops.empty() || part(text, line.code).find('[') == std::string_view::npos) return;
  const auto element = element_in(text, line);
  if (!element) return read_declaration(r, line);
  if (r.followed) {
    if (element->array == r.followed->loop.array)
      add_element_move(r, r.followed->loop, line, element->value, r.followed->how);
    return;
  }
  for (const KrlLoop& loop : r.loops)
    if (loop.array == element->array && (element->index < loop.first || element->index > loop.last))
      r.robot.program.counts.push_back(element->index_text);
}

}  // namespace counterflex
