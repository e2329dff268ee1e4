// A KUKA program that calls its parts.
#include "program/robot/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/robot/kuka/lex.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// KUKA System Software, Operating and Programming Instructions for System Integrators, "Names in KRL".
constexpr std::size_t longest_name = 24;

constexpr auto motion_words = std::to_array<std::string_view>({"LIN", "LIN_REL", "CIRC", "PTP", "PTP_REL"});

/// Words that mean the same in every program: keywords and arrays of the control.
constexpr auto common_words =
    std::to_array<std::string_view>({"C_DIS", "C_VEL", "C_ORI", "C_PTP", "CA", "BASE_DATA", "TOOL_DATA",
                                     "TRUE", "FALSE", "WAIT", "SEC", "FOR"});

bool is_fold(std::string_view comment, std::string_view word) {
  return krl_word(comment).starts_with(word);
}

/// The first name in the statement that may belong to the program; empty if it needs none. Names of the
/// control begin with '$', those of enumerations with '#'.
Span own_name(std::string_view text, Span code) {
  const Span head = name_at(text, code.begin, code.end);
  const std::string word = krl_word(part(text, head));
  const bool is_motion = is_among(word, motion_words);
  if (!is_motion && word != "WAIT" && text[code.begin] != '$') return code;
  for (std::size_t at = is_motion ? head.end : code.begin; at < code.end;) {
    if (const auto aggregate = aggregate_at(text, at, code.end);
        text[at] == '{' && aggregate &&
        std::ranges::all_of(aggregate->components, [&](const KrlComponent& c) {
          return c.number || text[c.value.begin] == '#' || text[c.value.begin] == '$';
        })) {
      at = aggregate->span.end;
    } else if (const auto number = number_at(text, at)) {
      at = number->span.end;
    } else if (const Span name = name_at(text, at, code.end); !empty(name)) {
      const char before = at > 0 ? text[at - 1] : ' ';
      const bool common = text[at] == '$' || before == '#' || before == '.' ||
                          is_among(krl_word(part(text, name)), common_words);
      if (!common) return name;
      at = name.end;
    } else if (std::string_view(" \t,=[].#+-").find(text[at]) != std::string_view::npos) {
      ++at;
    } else {
      return {at, at + 1};
    }
  }
  return {};
}

struct Layout {
  std::string attributes;          ///< the lines before DEF that begin with '&'
  Span name;                       ///< behind DEF
  std::size_t body = 0;            ///< behind the line of DEF
  std::string header;              ///< of a corrected program
  std::vector<RobotLine> divided;  ///< from the first linear motion to the last one
};

bool is_linear(std::string_view text, const RobotLine& line) {
  const std::string word = krl_word(part(text, name_at(text, line.code.begin, line.code.end)));
  return word == "LIN" || word == "LIN_REL" || word == "CIRC";
}

Layout layout_of(std::string_view text) {
  Layout layout;
  RobotLine line;
  std::size_t linear = 0;  // lines up to the last linear motion
  while (next_robot_line(text, krl_comment, line)) {
    if (layout.body == 0) {
      if (!empty(line.span) && text[line.span.begin] == '&')
        layout.attributes += part(text, {line.span.begin, line.line_end.end});
      if (!begins_routine(text, line)) continue;
      Span word = name_at(text, line.code.begin, line.code.end);
      while (krl_word(part(text, word)) != "DEF" && !empty(word))
        word = name_at(text, behind_blanks(text, word.end, line.code.end), line.code.end);
      layout.name = name_at(text, behind_blanks(text, word.end, line.code.end), line.code.end);
      layout.body = line.line_end.end;
      continue;
    }
    if (empty(line.code) && is_header_comment(part(text, line.comment)))
      layout.header += part(text, {line.span.begin, line.line_end.end});
    if (krl_word(part(text, line.code)) == "END") break;
    const bool is_motion = !empty(line.code) && is_linear(text, line);
    if (is_motion || !layout.divided.empty()) layout.divided.push_back(line);
    if (is_motion) linear = layout.divided.size();
  }
  layout.divided.resize(linear);
  return layout;
}

std::vector<PartStatement> statements_of(const std::string& file, std::string_view text,
                                         const Layout& layout) {
  std::vector<PartStatement> statements;
  int folds = 0;
  for (const RobotLine& line : layout.divided) {
    PartStatement statement{.span = {line.span.begin, line.line_end.end}, .may_begin = folds == 0};
    const std::string_view comment = part(text, line.comment);
    if (is_fold(comment, "FOLD")) ++folds;
    if (is_fold(comment, "ENDFOLD")) folds = std::max(folds - 1, 0);
    statements.push_back(statement);
    if (empty(line.code)) continue;
    if (const Span name = own_name(text, line.code); !empty(name))
      refuse_part(file, line, fmt::format("'{}' may need what only the main program has", part(text, name)));
    const std::string word = krl_word(part(text, name_at(text, line.code.begin, line.code.end)));
    statements.back().points = is_among(word, motion_words);
    statements.back().is_rapid = word == "PTP" || word == "PTP_REL";
  }
  return statements;
}

std::string call_of(const std::string& name, std::string_view line_end) {
  return name + "( )" + std::string(line_end);
}

}  // namespace

std::vector<ProgramPart> divide_krl(const std::string& file, const std::string& text, std::size_t most) {
  const Layout layout = layout_of(text);
  if (empty(layout.name) || layout.divided.empty())
    refuse_part(file, {.line = 1}, "it has no DEF NAME( ), or no linear motion");
  const std::vector<PartStatement> statements = statements_of(file, text, layout);
  const std::vector<std::size_t> begins = begins_of_parts(file, text, statements, most);
  const std::string name(part(text, layout.name));
  const std::string line_end(part(text, layout.divided.front().line_end));
  const std::size_t begin = statements.front().span.begin, end = statements.back().span.end;
  std::vector<ProgramPart> parts{{name, text.substr(0, begin)}};
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const std::size_t next = k + 1 < begins.size() ? statements[begins[k + 1]].span.begin : end;
    const std::size_t first = statements[begins[k]].span.begin;
    const std::string own_name = fmt::format("{}_{}", name, k + 1);
    if (own_name.size() > longest_name)
      refuse_part(file, {.line = 1},
                  fmt::format("the name of its part {} is longer than the {} characters of a name in KRL",
                              own_name, longest_name));
    parts.front().text += call_of(own_name, line_end);
    parts.push_back({own_name, layout.attributes + "DEF " + call_of(own_name, line_end) + layout.header +
                                   text.substr(first, next - first) + "END" + line_end});
  }
  parts.front().text += text.substr(end);
  return parts;
}

std::string joined_krl(const std::string&, const std::vector<ProgramPart>& parts) {
  std::string text = parts.front().text;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const Layout layout = layout_of(parts[k].text);
    const std::size_t begin = layout.body + layout.header.size();
    const std::size_t end = parts[k].text.rfind("END");
    const std::size_t at = text.find("\n" + parts[k].name + "( )");
    if (at == std::string::npos) return {};
    const std::size_t line_end = text.find('\n', at + 1);
    text.replace(at + 1, line_end - at, parts[k].text, begin, end - begin);
  }
  return text;
}

}  // namespace counterflex
