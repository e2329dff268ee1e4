// The elements of arrays in data lists.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/program_files.hpp"
#include "program/program_files.hpp"
#include "program/robot/kuka/loops.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/robot/writer.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// `number` in the place of `old`, which may have blanks around its digits, with the same width if it fits.
std::string in_place_of(std::string_view old, long number) {
  std::string text(old.substr(0, std::min(old.find_first_not_of(" \t"), old.size())));
  text += std::to_string(number);
  if (text.size() < old.size()) text.append(old.size() - text.size(), ' ');
  return text;
}

/// The index of a loop's array after insertion, and what was inserted.
struct Count {
  std::optional<long> first{};
  long next = 0;      ///< the next index after insertion
  long original = 0;  ///< the last index before
  std::optional<Span> size{};
  std::vector<TextChange> changes{};

  long inserted() const { return next - 1 - original; }
};

/// The size of the array in its declaration is in the program or in a data list.
Count count_array(std::string_view text, const std::string& array) {
  Count count;
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.code).find('[') == std::string_view::npos) continue;
    const auto element = element_in(text, line);
    if (!element) {
      const auto size = declared_size(text, line, array);
      if (size && whole_number(text, *size)) count.size = size;
      continue;
    }
    if (element->array != array) continue;
    if (!count.first) count.first = count.next = element->index;
    if (count.next != element->index)
      count.changes.push_back(
          {element->index_text, in_place_of(part(text, element->index_text), count.next)});
    count.original = element->index;
    ++count.next;
  }
  return count;
}

}  // namespace

std::optional<Span> declared_size(std::string_view text, const RobotLine& line, std::string_view array) {
  for (std::size_t at = line.code.begin; at < line.code.end;) {
    const Span name = name_at(text, at, line.code.end);
    at = empty(name) ? at + 1 : name.end;
    if (empty(name) || krl_word(part(text, name)) != array) continue;
    const std::size_t open = behind_blanks(text, name.end, line.code.end);
    const std::size_t close = text.find(']', open);
    if (open < line.code.end && text[open] == '[' && close < line.code.end) return Span{open + 1, close};
  }
  return std::nullopt;
}

namespace {

/// The first loop over an array in a text that reads as a program. A statement that changes an element ends
/// the search.
std::optional<KrlLoop> first_loop(std::string_view text) {
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) {
    const auto loop = loop_over_array(text, "", line);
    if (loop) return loop;
  }
  return std::nullopt;
}

/// Adds the names that lines of a list give to aggregates, and its elements of arrays.
struct ListScan {
  std::string array{};    ///< of the loop
  bool declared = false;  ///< with its size
  KrlArrays arrays{};
  std::vector<std::string> names{};  ///< of other aggregates

  void add(std::string_view lines) {
    RobotLine line;
    while (next_robot_line(lines, krl_comment, line)) {
      const std::string_view code = part(lines, line.code);
      if (code.find('{') == std::string_view::npos) {
        const auto size = declared_size(lines, line, array);
        declared = declared || (size && whole_number(lines, *size));
        continue;
      }
      const auto assignment = assignment_in(lines, line.code);
      if (assignment && code.find('[') < code.find('=') && element_in(lines, line)) continue;
      names.push_back(assignment ? krl_word(part(lines, assignment->variable)) : std::string(code));
    }
    add_elements(lines, arrays);
  }
};

ListScan scan_list(FileReader& list, const std::string& array) {
  constexpr std::size_t at_once = 1 << 16;
  ListScan scan{array};
  std::string text;
  while (list.append(text, at_once) > 0) {
    const std::size_t whole = text.rfind('\n') + 1;  // 0 without a newline
    scan.add(std::string_view(text).substr(0, whole));
    text.erase(0, whole);
  }
  scan.add(text);
  return scan;
}

/// Whether the text has the variable, apart from its indices and members.
bool has_name(std::string_view text, std::string_view variable) {
  const std::string name(variable.substr(0, variable.find_first_of("[.")));
  return krl_word(text).find(name) != std::string::npos;
}

std::size_t routines_in(std::string_view text) {
  std::size_t count = 0;
  RobotLine line;
  while (next_robot_line(text, krl_comment, line)) count += begins_routine(text, line);
  return count;
}

/// The first loop over an array, and no other statement that a text of several windows cannot have.
std::optional<KrlLoop> only_loop(std::string_view program) {
  if (names_targets(program) || routines_in(program) != 1) return std::nullopt;
  try {
    auto loop = first_loop(program);
    if (!loop || first_loop(program.substr(loop->end))) return std::nullopt;
    const auto alone = first_loop(program.substr(0, loop->end));
    return alone && alone->acts == loop->acts ? loop : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;  // its place is found when the program is read
  }
}

}  // namespace

std::optional<KrlCut> cut_behind_loop(std::string_view program, FileReader& list) {
  const auto loop = only_loop(program);
  if (!loop) return std::nullopt;
  const ListScan scan = scan_list(list, loop->array);
  const auto array = scan.arrays.find(loop->array);
  const bool complete = scan.declared && scan.arrays.size() == 1 && array != scan.arrays.end() &&
                        array->second.in_order && array->second.first == loop->first &&
                        array->second.last == loop->last;
  const auto is_used = [&](const std::string& name) { return has_name(program, name); };
  if (!complete || std::ranges::any_of(scan.names, is_used)) return std::nullopt;
  const auto before = program.substr(0, loop->end);
  return KrlCut{loop->end, 1 + static_cast<int>(std::ranges::count(before, '\n'))};
}

std::optional<KrlNumbering> numbering_in(std::string_view window) {
  const std::size_t list = data_list_at(window);
  if (list == window.size() ||
      window.substr(list, window.find('\n', list) - list).find(line_mark) == std::string_view::npos)
    return std::nullopt;
  const auto loop = first_loop(window.substr(0, list));
  return loop ? std::optional(KrlNumbering{loop->array}) : std::nullopt;
}

std::string KrlNumbering::numbered(std::string lines) {
  std::vector<TextChange> changes;
  RobotLine line;
  while (next_robot_line(lines, krl_comment, line)) {
    if (part(lines, line.code).find('[') == std::string_view::npos) continue;
    const auto element = element_in(lines, line);
    if (!element || element->array != array) continue;
    if (!next) next = element->index;
    if (*next != element->index)
      changes.push_back({element->index_text, in_place_of(part(lines, element->index_text), *next)});
    ++*next;
  }
  return changes.empty() ? lines : with_changes(lines, {0, lines.size()}, changes);
}

LoopCount loop_count_of(std::string_view program) {
  const auto loop = first_loop(program);
  return {loop ? loop->array : std::string()};
}

void add_elements(std::string_view lines, LoopCount& count) {
  KrlArrays arrays;
  add_elements(lines, arrays);
  if (const auto array = arrays.find(count.array); array != arrays.end()) count.last = array->second.last;
}

std::string with_loop_end(std::string program, const LoopCount& count) {
  const auto loop = first_loop(program);
  if (!loop || loop->last == count.last) return program;
  return program.replace(loop->last_number.begin, loop->last_number.end - loop->last_number.begin,
                         std::to_string(count.last));
}

std::string with_array_size(std::string lines, const LoopCount& count) {
  RobotLine line;
  std::vector<TextChange> changes;
  while (next_robot_line(lines, krl_comment, line)) {
    const std::string_view code = part(lines, line.code);
    if (code.find('[') == std::string_view::npos || code.find('{') != std::string_view::npos) continue;
    const auto size = declared_size(lines, line, count.array);
    const auto number = size ? whole_number(lines, *size) : std::nullopt;
    if (number && *number < count.last)
      changes.push_back({*size, in_place_of(part(lines, *size), count.last)});
  }
  return with_changes(lines, {0, lines.size()}, changes);
}

std::size_t data_list_at(std::string_view text) {
  if (text.starts_with(file_mark)) return 0;
  const std::size_t newline = text.find('\n' + std::string(file_mark));
  return newline == std::string_view::npos ? text.size() : newline + 1;
}

std::optional<int> number_behind_mark(std::string_view code) {
  if (!code.starts_with(file_mark) && !code.starts_with(back_mark)) return std::nullopt;
  const std::size_t mark = code.rfind(line_mark);
  const auto number =
      mark == std::string_view::npos ? std::nullopt : whole_number(code, {mark + 1, code.size()});
  return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

std::optional<KrlElement> element_in(std::string_view text, const RobotLine& line) {
  const auto assignment = assignment_in(text, line.code);
  if (!assignment) return std::nullopt;
  const std::string_view variable = part(text, assignment->variable);
  const std::size_t open = variable.find('['), close = variable.find(']');
  if (open == std::string_view::npos || close + 1 != variable.size()) return std::nullopt;
  const Span index_text{assignment->variable.begin + open + 1, assignment->variable.begin + close};
  const auto index = whole_number(text, index_text);
  if (!index) return std::nullopt;
  return KrlElement{krl_word(variable.substr(0, open)), *index, index_text, assignment->value};
}

void add_elements(std::string_view lines, KrlArrays& arrays) {
  RobotLine line;
  while (next_robot_line(lines, krl_comment, line)) {
    if (part(lines, line.code).find('[') == std::string_view::npos) continue;
    const auto element = element_in(lines, line);
    if (!element) continue;
    const auto [array, is_new] = arrays.try_emplace(element->array, KrlArray{element->index, element->index});
    if (is_new) continue;
    array->second.in_order = array->second.in_order && element->index == array->second.last + 1;
    array->second.last = element->index;
  }
}

std::string with_counted_arrays(std::string text, const std::string& file) {
  const std::size_t list = data_list_at(text);
  if (list == text.size()) return text;
  std::vector<TextChange> changes;
  RobotLine line;
  while (next_robot_line(text, krl_comment, line) && line.span.begin < list) {
    const auto loop = loop_over_array(text, file, line);
    if (!loop) continue;
    Count count = count_array(text, loop->array);
    if (count.inserted() <= 0) continue;
    changes.insert(changes.end(), count.changes.begin(), count.changes.end());
    changes.push_back({loop->last_number, std::to_string(loop->last + count.inserted())});
    if (!count.size)
      throw InputError(ErrorKind::program_text, {file, loop->motion.line, 1},
                       fmt::format("targets are inserted into the array {}, but neither the program nor its "
                                   "data lists declare its size; give the list that declares it with --data "
                                   "FILE.dat, or allow a larger --tolerance-mm",
                                   loop->array));
    if (*whole_number(text, *count.size) < count.next - 1)
      changes.push_back({*count.size, in_place_of(part(text, *count.size), count.next - 1)});
  }
  return with_changes(text, {0, text.size()}, changes);
}

}  // namespace counterflex
