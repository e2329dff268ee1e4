#include "program/expand/lines.hpp"

#include <algorithm>

#include "program/text/scanner.hpp"

namespace counterflex {

void ExpandedLines::append(std::string_view line, int line_of_file, int called_from) {
  if (!text.empty() && text.back() != '\n') text += line_end;
  text += line;
  ++count;
  const bool continues = !runs.empty() && runs.back().called_from == called_from &&
                         runs.back().line + (count - runs.back().text_line) == line_of_file;
  if (!continues) runs.push_back({count, line_of_file, called_from});
}

LinesMark mark_of(const ExpandedLines& lines) {
  return {lines.text.size(), lines.runs.size(), lines.count};
}

void truncate_to(const LinesMark& mark, ExpandedLines& lines) {
  lines.text.resize(mark.text);
  lines.runs.resize(mark.runs);
  lines.count = mark.count;
}

void append_lines(std::string_view text, std::size_t at, int line, std::size_t end, ExpandedLines& lines) {
  Block block;
  block.text_line = line - 1;
  block.line_end = {at, at};
  while (block.line_end.end < end && next_line(text, block))
    lines.append(text.substr(block.span.begin, block.line_end.end - block.span.begin), block.line, 0);
}

int count_lines(std::string_view text) {
  const auto ends = std::count(text.begin(), text.end(), '\n');
  return static_cast<int>(ends) + (!text.empty() && text.back() != '\n' ? 1 : 0);
}

std::string_view whole_line(std::string_view text, const Block& block) {
  return text.substr(block.span.begin, block.line_end.end - block.span.begin);
}

std::string line_end_of(std::string_view text) {
  const std::size_t newline = text.find('\n');
  const bool returns = newline != std::string_view::npos && newline > 0 && text[newline - 1] == '\r';
  return returns ? "\r\n" : "\n";
}

std::string line_without(std::string_view text, const Dialect& dialect, const Block& block,
                         std::vector<Span> dropped) {
  std::sort(dropped.begin(), dropped.end(), [](Span a, Span b) { return a.begin < b.begin; });
  std::string line;
  std::size_t copied = block.span.begin;
  for (const Span span : dropped) {
    line.append(text, copied, span.begin - copied);
    copied = span.end;
    while (copied < block.span.end && is_blank(text[copied])) ++copied;
  }
  line.append(text, copied, block.span.end - copied);
  line.erase(line.find_last_not_of(" \t") + 1);
  const std::string_view is_ignored = dialect.semicolon_comments ? " \t" : " \t;";
  if (line.find_first_not_of(is_ignored) == std::string::npos) return {};
  return line.append(part(text, block.line_end));
}

}  // namespace counterflex
