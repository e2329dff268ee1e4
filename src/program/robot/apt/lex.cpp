#include "program/robot/apt/lex.hpp"

#include <algorithm>
#include <array>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Heads of apt_texts, in which '$' is an ordinary character.
constexpr auto apt_texts =
    std::to_array<std::string_view>({"PARTNO", "PPRINT", "INSERT", "REMARK", "TITLES"});

/// Position of the '$' that continues the statement `code` in the next line; its end without one.
std::size_t continuation_in(std::string_view text, Span code) {
  const std::string_view line = part(text, code);
  const std::size_t sign = line.find('$');
  if (sign == std::string_view::npos) return code.end;
  const std::string head = apt_word(line.substr(0, line.find_first_of("/ \t$")));
  const bool is_text = std::find(apt_texts.begin(), apt_texts.end(), head) != apt_texts.end();
  return is_text ? code.end : code.begin + sign;
}

bool ends_with_sign(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t");
  return last != std::string_view::npos && line[last] == '$';
}

/// Whether the line is a remark of Creo that '$' continues: "$$-> CSYS / 1, 0, 0, 0, $".
bool is_continued_remark(std::string_view text, const RobotLine& line) {
  const std::string_view comment = part(text, line.comment);
  return empty(line.code) && comment.starts_with("->") && ends_with_sign(comment);
}

/// Adds to the remark in `line` the lines that continue it. These have numbers alone.
void take_remark_lines(std::string_view text, RobotLine& line) {
  RobotLine last = line;
  while (next_robot_line(text, apt_comment, last)) {
    const std::string_view code = part(text, last.code);
    if (code.empty() || code.find_first_not_of("0123456789+-.eE,$ \t") != std::string_view::npos) return;
    ++line.more_lines;
    line.span.end = last.span.end;
    line.line_end = last.line_end;
    if (!ends_with_sign(code)) return;
  }
}

/// Without blanks, line ends, and '$' with the text behind it, at both ends.
Span without_blanks_and_signs(std::string_view text, Span span) {
  const auto skipped = [&](std::size_t at) {
    return is_blank(text[at]) || is_ignored(text[at]) || text[at] == '\n';
  };
  for (;;) {
    while (span.begin < span.end && skipped(span.begin)) ++span.begin;
    if (span.begin == span.end || text[span.begin] != '$') break;
    span.begin = std::min(text.find('\n', span.begin), span.end);
  }
  const std::size_t sign = part(text, span).find('$');
  if (sign != std::string_view::npos) span.end = span.begin + sign;
  while (span.end > span.begin && skipped(span.end - 1)) --span.end;
  return span;
}

}  // namespace

bool next_apt_line(std::string_view text, RobotLine& line) {
  if (!next_robot_line(text, apt_comment, line)) return false;
  if (is_continued_remark(text, line)) {
    take_remark_lines(text, line);
    return true;
  }
  RobotLine last = line;
  while (continuation_in(text, last.code) < last.code.end && next_robot_line(text, apt_comment, last)) {
    ++line.more_lines;
    line.span.end = last.span.end;
    line.line_end = last.line_end;
    line.comment = last.comment;
    if (!empty(last.code)) line.code.end = last.code.end;
  }
  return true;
}

bool apt_continues_behind(std::string_view text, std::size_t newline) {
  const std::size_t before = newline == 0 ? std::string_view::npos : text.rfind('\n', newline - 1);
  RobotLine line;
  line.line_end.end = before == std::string_view::npos ? 0 : before + 1;
  return next_robot_line(text, apt_comment, line) &&
         (is_continued_remark(text, line) || continuation_in(text, line.code) < line.code.end);
}

AptStatement apt_statement(std::string_view text, Span code) {
  AptStatement statement;
  const std::size_t slash = std::min(text.find('/', code.begin), code.end);
  statement.head = apt_word(part(text, {code.begin, slash}));
  for (std::size_t at = slash + 1; at <= code.end;) {
    const std::size_t stop = std::min(text.find(',', at), code.end);
    statement.parameters.push_back(without_blanks_and_signs(text, {at, stop}));
    at = stop + 1;
  }
  return statement;
}

std::string apt_word(std::string_view parameter) {
  std::string word;
  for (const char c : parameter)
    if (!is_blank(c)) word += upper(c);
  return word;
}

bool gives_tool_axes(std::string_view lines) {
  constexpr std::size_t with_axis = 6;
  RobotLine line;
  while (next_apt_line(lines, line)) {
    if (empty(line.code) || upper(lines[line.code.begin]) != 'G') continue;
    const AptStatement statement = apt_statement(lines, line.code);
    if (statement.head == "GOTO" && statement.parameters.size() >= with_axis) return true;
  }
  return false;
}

}  // namespace counterflex
