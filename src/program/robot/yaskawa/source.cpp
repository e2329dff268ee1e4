#include "program/robot/yaskawa/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "program/robot/writer.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {
namespace {

/// A pseudo instruction replaces the one before it with the same key.
std::string condition_key(std::string_view text, Span line) {
  const std::string head = jbi_head(text, jbi_line_at(text, line.begin));
  return head == "///PULSE" ? "///RECTAN" : head;
}

/// Reads up to //INST, which becomes `line`.
void read_positions(std::string_view text, RobotLine& line, JbiLayout& layout) {
  bool inside = false, changed = true;
  std::vector<Span> conditions;
  while (next_robot_line(text, jbi_comment, line)) {
    const std::string head = jbi_head(text, line);
    if (head.starts_with("//") && !head.starts_with("///")) {
      if (inside) layout.positions.end = line.span.begin;
      inside = head == "//POS";
      if (inside) layout.positions = {line.line_end.end, line.line_end.end};
      const std::vector<Span> words = jbi_words(text, line.code);
      if (head == "//NAME" && words.size() > 1) layout.name = {words[1].begin, line.code.end};
      if (head == "//INST") return;
    } else if (inside && head == "///NPOS") {
      if (empty(layout.counts)) layout.counts = jbi_whole(line);
    } else if (inside && head.starts_with('/')) {
      const std::string key = condition_key(text, jbi_whole(line));
      std::erase_if(conditions, [&](Span other) { return condition_key(text, other) == key; });
      conditions.push_back(jbi_whole(line));
      changed = true;
    } else if (inside && !head.empty()) {
      if (std::exchange(changed, false)) layout.conditions.push_back(conditions);
      layout.condition_of.push_back(layout.conditions.size() - 1);
    }
  }
}

/// Reads from behind //INST to END.
void read_statements(std::string_view text, RobotLine& line, JbiLayout& layout) {
  layout.attributes = part(text, jbi_whole(line));
  layout.statements = line.line_end.end;
  for (bool begun = false; next_robot_line(text, jbi_comment, line);) {
    const std::string head = jbi_head(text, line);
    layout.ends = head == "END";
    if (layout.ends) break;
    const bool of_header =
        layout.lines.empty() && empty(line.code) && is_header_comment(part(text, line.comment));
    if (of_header) layout.header += part(text, jbi_whole(line));
    if (of_header || (!begun && (head.empty() || head == "NOP" || head.starts_with('/')))) {
      if (head.starts_with('/') && head != "///LVARS") layout.attributes += part(text, jbi_whole(line));
      layout.statements = line.line_end.end;
      begun = begun || head == "NOP";
      continue;
    }
    begun = true;
    layout.lines.push_back(line);
    if (head != "MOVL" && head != "MOVC") continue;
    if (layout.behind == 0) layout.first = layout.lines.size() - 1;
    layout.behind = layout.lines.size();
  }
}

/// `name` with the number `number` and as many digits.
TextChange renumbered(const JbiName& name, std::uint32_t number) {
  return {name.digits, fmt::format("{:0{}}", number, name.digits.end - name.digits.begin)};
}

/// The lines of pseudo instructions that hold for the position `i`.
const std::vector<Span>& conditions_of(const JbiSource& source, std::size_t i) {
  return source.layout.conditions[source.layout.condition_of[i]];
}

/// The first line ///NPOS with the counts of these positions.
std::string counts_line(const JbiSource& source, const JbiNumbers& numbers) {
  const JbiPositions& positions = source.job.positions;
  std::array<std::size_t, 2 * jbi_step_families> count{};
  for (const auto& [i, number] : numbers) ++count[static_cast<std::size_t>(positions.list[i].family)];
  std::vector<TextChange> changes;
  for (std::size_t i = 0; i < std::min(count.size(), positions.counts.size()); ++i)
    if (positions.counts[i].end <= source.layout.counts.end)
      changes.push_back({positions.counts[i], std::to_string(count[i])});
  return with_changes(source.text, source.layout.counts, changes);
}

}  // namespace

std::size_t JbiSource::index_of(const JbiName& name) const {
  const JbiPosition* position = job.positions.find(name.family, name.number);
  return position != nullptr ? static_cast<std::size_t>(position - job.positions.list.data())
                             : job.positions.list.size();
}

JbiSource jbi_source(const std::string& file, const std::string& text) {
  JbiSource source{text, jbi_job(text, file), {}};
  RobotLine line;
  read_positions(text, line, source.layout);
  read_statements(text, line, source.layout);
  return source;
}

Span jbi_whole(const RobotLine& line) {
  return {line.span.begin, line.line_end.end};
}

std::string jbi_head(std::string_view text, const RobotLine& line) {
  return empty(line.code) ? "" : jbi_word(part(text, jbi_words(text, line.code).front()));
}

std::set<std::size_t> jbi_positions_in(const JbiSource& source, std::span<const RobotLine> lines) {
  std::set<std::size_t> used;
  for (const RobotLine& line : lines)
    for (const JbiName& name : jbi_names(source.text, line.code)) used.insert(source.index_of(name));
  used.erase(source.job.positions.list.size());  // a variable that is not in the file
  return used;
}

JbiNumbers jbi_numbers(const JbiSource& source, const std::set<std::size_t>& used) {
  JbiNumbers numbers;
  std::array<std::uint32_t, jbi_step_families> next{};
  for (const std::size_t i : used) {
    const JbiPosition& position = source.job.positions.list[i];
    const bool keeps = is_variable(position.family);
    numbers[i] = keeps ? position.number : next[static_cast<std::size_t>(position.family)]++;
  }
  return numbers;
}

std::string jbi_position_lines(const JbiSource& source, const JbiNumbers& numbers) {
  std::string lines = counts_line(source, numbers);
  std::map<std::string, std::string_view> active;
  const std::vector<Span>* last = nullptr;
  for (const auto& [i, number] : numbers) {
    const std::vector<Span>& conditions = conditions_of(source, i);
    if (std::exchange(last, &conditions) != &conditions)
      for (const Span span : conditions) {
        const std::string_view condition = part(source.text, span);
        if (std::string_view& before = active[condition_key(source.text, span)]; before != condition)
          lines += before = condition;
      }
    const JbiPosition& position = source.job.positions.list[i];
    std::vector<TextChange> changes;
    if (number != position.number)
      changes.push_back(renumbered(jbi_values(source.text, position.line_begin)->name, number));
    lines += with_changes(source.text, jbi_whole(jbi_line_at(source.text, position.line_begin)), changes);
  }
  return lines;
}

std::string jbi_statements(const JbiSource& source, std::span<const RobotLine> lines,
                           const JbiNumbers& numbers) {
  std::string statements;
  for (const RobotLine& line : lines) {
    std::vector<TextChange> changes;
    for (const JbiName& name : jbi_names(source.text, line.code))
      if (const auto number = numbers.find(source.index_of(name));
          number != numbers.end() && number->second != name.number)
        changes.push_back(renumbered(name, number->second));
    statements += with_changes(source.text, jbi_whole(line), changes);
  }
  return statements;
}

std::string jbi_statement_with_values(const JbiSource& source, const RobotLine& line) {
  std::vector<TextChange> changes;
  for (const JbiName& name : jbi_names(source.text, line.code)) {
    const std::size_t i = source.index_of(name);
    if (i == source.job.positions.list.size()) continue;
    const auto values = jbi_values(source.text, source.job.positions.list[i].line_begin);
    std::string content(part(source.text, values->text));
    std::set<std::string_view> conditions;
    for (const Span span : conditions_of(source, i)) conditions.insert(part(source.text, span));
    for (const std::string_view condition : conditions) content.append(condition);
    const std::size_t begin = is_variable(name.family) ? name.digits.end : name.digits.begin;
    changes.push_back({{begin, name.digits.end}, std::move(content)});
  }
  return with_changes(source.text, jbi_whole(line), changes);
}

}  // namespace counterflex
