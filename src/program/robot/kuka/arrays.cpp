// The elements of arrays in data lists.
#include <algorithm>
#include <vector>

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

Count count_array(std::string_view text, std::size_t list, const std::string& array) {
  Count count;
  RobotLine line;
  line.line_end.end = list;
  while (next_robot_line(text, krl_comment, line)) {
    if (part(text, line.code).find('[') == std::string_view::npos) continue;
    const auto element = element_in(text, line);
    if (!element) {
      if (const auto size = declared_size(text, line, array)) count.size = size;
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

std::size_t data_list_at(std::string_view text) {
  if (text.starts_with(file_mark)) return 0;
  const std::size_t newline = text.find('\n' + std::string(file_mark));
  return newline == std::string_view::npos ? text.size() : newline + 1;
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
    Count count = count_array(text, list, loop->array);
    if (count.inserted() <= 0) continue;
    changes.insert(changes.end(), count.changes.begin(), count.changes.end());
    changes.push_back({loop->last_number, std::to_string(loop->last + count.inserted())});
    const auto size = count.size ? whole_number(text, *count.size) : std::nullopt;
    if (size && *size < count.next - 1)
      changes.push_back({*count.size, in_place_of(part(text, *count.size), count.next - 1)});
  }
  return with_changes(text, {0, text.size()}, changes);
}

}  // namespace counterflex
