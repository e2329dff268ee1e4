// An ABB RAPID module that calls the routines of its parts.
#include "program/robot/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "program/robot/rapid/lex.hpp"
#include "program/robot/rapid/module.hpp"
#include "program/robot/rapid/statement.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {
namespace {

/// ABB, RAPID Kernel, 3HAC16585, "Identifiers".
constexpr std::size_t longest_name = 32;

/// Instructions that act on the routine that has them.
constexpr auto instructions_of_routine =
    std::to_array<std::string_view>({"GOTO", "RETURN", "RAISE", "RETRY", "TRYNEXT"});

struct Layout {
  Span module;                         ///< the name behind MODULE
  std::size_t module_line = 0;         ///< the byte at which the line of MODULE begins
  std::size_t behind_module = 0;       ///< behind this line
  std::string header;                  ///< of a corrected program
  std::set<std::string> own;           ///< names that other modules do not see, in upper case
  Span divided;                        ///< whole lines, from the first linear motion to the last one
  std::vector<RapidStatement> inside;  ///< of the routine with the linear motions
};

bool is_motion(const RapidStatement& statement) {
  return statement.kind == RapidKind::call && statement.head.starts_with("MOVE");
}

std::size_t begin_of_line(std::string_view text, std::size_t at) {
  const std::size_t newline = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  return newline == std::string_view::npos ? 0 : newline + 1;
}

std::size_t behind_line(std::string_view text, std::size_t at) {
  const std::size_t newline = text.find('\n', at);
  return newline == std::string_view::npos ? text.size() : newline + 1;
}

RobotLine line_at(std::string_view text, std::size_t at) {
  return {.line = 1 + static_cast<int>(
                          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'))};
}

std::string header_in(std::string_view text, std::size_t begin) {
  std::string header;
  RobotLine line;
  line.line_end.end = begin;
  while (next_robot_line(text, rapid_comment, line) && empty(line.code) &&
         is_header_comment(part(text, line.comment)))
    header += part(text, {line.span.begin, line.line_end.end});
  return header;
}

/// All names of a statement, in upper case.
std::vector<std::string> names_of(std::string_view text, const RapidStatement& statement) {
  std::vector<std::string> names;
  for (std::size_t at = statement.span.begin;;) {
    const RapidToken token = rapid_token_at(text, at, statement.span.end);
    if (token.kind == RapidTokenKind::none) return names;
    if (token.kind == RapidTokenKind::name) names.push_back(rapid_word(part(text, token.span)));
    at = token.span.end;
  }
}

bool is_local(std::string_view text, const RapidStatement& statement) {
  const RapidToken first = rapid_token_at(text, statement.span.begin, statement.span.end);
  return rapid_word(part(text, first.span)) == "LOCAL";
}

Layout layout_of(const std::string& file, std::string_view text) {
  Layout layout;
  std::vector<RapidStatement> routine;
  std::set<std::string> of_routine;
  for (std::size_t at = 0;;) {
    const RapidStatement statement = rapid_statement_at(text, at, text.size());
    if (statement.kind == RapidKind::none) break;
    at = statement.behind;
    const bool begins = statement.kind == RapidKind::routine_begin;
    if (statement.kind == RapidKind::module_begin) {
      const RapidToken keyword = rapid_token_at(text, statement.span.begin, text.size());
      layout.module = rapid_token_at(text, keyword.span.end, text.size()).span;
      layout.module_line = begin_of_line(text, statement.span.begin);
      layout.behind_module = behind_line(text, statement.span.begin);
      layout.header = header_in(text, layout.behind_module);
    }
    const bool inside = !routine.empty();
    if (begins) {
      of_routine.clear();
      for (const std::string& name : names_of(text, statement)) {
        of_routine.insert(name);  // parameters
        if (is_local(text, statement)) layout.own.insert(name);
      }
    }
    if (const Span name = rapid_declaration(text, statement).name; !empty(name))
      if (inside || is_local(text, statement))
        (inside ? of_routine : layout.own).insert(rapid_word(part(text, name)));
    if (begins || inside) routine.push_back(statement);
    if (statement.kind != RapidKind::routine_end && statement.kind != RapidKind::module_end) continue;
    const auto is_linear = [](const RapidStatement& s) {
      return is_motion(s) && (s.head == "MOVEL" || s.head == "MOVEC");
    };
    const auto first = std::ranges::find_if(routine, is_linear);
    if (first != routine.end()) {
      if (!layout.inside.empty())
        refuse_part(file, line_at(text, first->span.begin), "a second routine has linear motions");
      const auto last = std::find_if(routine.rbegin(), routine.rend(), is_linear);
      layout.divided = {begin_of_line(text, first->span.begin), behind_line(text, last->span.begin)};
      layout.inside = routine;
      layout.own.insert(of_routine.begin(), of_routine.end());
    }
    routine.clear();
  }
  return layout;
}

void check_statement(const std::string& file, std::string_view text, const Layout& layout,
                     const RapidStatement& statement) {
  const auto refuse_it = [&](std::string_view why) {
    const std::string words = in_one_line(part(text, statement.span));
    refuse_part(file, line_at(text, statement.span.begin), fmt::format("'{}' {}", words, why));
  };
  const bool acts_here = is_among(statement.head, instructions_of_routine);
  if ((statement.kind != RapidKind::call && statement.kind != RapidKind::assignment) || acts_here)
    refuse_it("cannot be in another routine");
  for (const std::string& name : names_of(text, statement))
    if (layout.own.contains(name)) refuse_it("needs data or a routine that only the main module has");
}

/// The lines to divide, each with the motion that it has.
std::vector<PartStatement> statements_of(std::string_view text, const Layout& layout) {
  std::vector<PartStatement> statements;
  auto next = layout.inside.begin();
  for (std::size_t at = layout.divided.begin; at < layout.divided.end;) {
    PartStatement line{.span = {at, behind_line(text, at)}};
    while (next != layout.inside.end() && next->span.begin < line.span.end) {
      if (next->span.begin >= at && is_motion(*next)) line.points = 1;
      if (next->span.begin >= at && is_motion(*next)) line.is_rapid = next->head.ends_with('J');
      if (next->span.begin < at) line.may_begin = false;
      if (next->behind > line.span.end) break;
      ++next;
    }
    statements.push_back(line);
    at = line.span.end;
  }
  return statements;
}

std::string routine_of(const std::string& part) {
  return "run_" + part;
}

std::string call_of(const std::string& part, std::string_view blanks, std::string_view line_end) {
  return fmt::format("{}{};{}", blanks, routine_of(part), line_end);
}

std::string head_of(std::string_view text, const Layout& layout, const std::string& name,
                    std::string_view line_end) {
  return fmt::format("{}MODULE {}{}{}  PROC {}(){}", text.substr(0, layout.module_line), name, line_end,
                     layout.header, routine_of(name), line_end);
}

std::string tail_of(std::string_view line_end) {
  return fmt::format("  ENDPROC{0}ENDMODULE{0}", line_end);
}

}  // namespace

std::vector<ProgramPart> divide_rapid(const std::string& file, const std::string& text, std::size_t most) {
  const Layout layout = layout_of(file, text);
  if (empty(layout.module) || layout.inside.empty())
    refuse_part(file, {.line = 1}, "it has no MODULE, or no routine with linear motions");
  for (const RapidStatement& statement : layout.inside)
    if (statement.span.begin >= layout.divided.begin && statement.span.begin < layout.divided.end)
      check_statement(file, text, layout, statement);
  const std::vector<PartStatement> statements = statements_of(text, layout);
  const std::vector<std::size_t> begins = begins_of_parts(file, text, statements, most);
  const std::string name(part(text, layout.module));
  const std::string_view first = part(text, statements.front().span);
  const std::string_view blanks = first.substr(0, first.find_first_not_of(" \t"));
  const std::string_view line_end = first.ends_with("\r\n") ? "\r\n" : "\n";
  std::vector<ProgramPart> parts{{name, text.substr(0, layout.divided.begin)}};
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const std::size_t end = k + 1 < begins.size() ? statements[begins[k + 1]].span.begin : layout.divided.end;
    const std::size_t begin = statements[begins[k]].span.begin;
    const std::string own_name = fmt::format("{}_{}", name, k + 1);
    if (routine_of(own_name).size() > longest_name)
      refuse_part(file, {.line = 1},
                  fmt::format("the name of its part {} is longer than the {} characters of a name in RAPID",
                              routine_of(own_name), longest_name));
    parts.front().text += call_of(own_name, blanks, line_end);
    parts.push_back({own_name, head_of(text, layout, own_name, line_end) + text.substr(begin, end - begin) +
                                   tail_of(line_end)});
  }
  parts.front().text += text.substr(layout.divided.end);
  return parts;
}

std::string joined_rapid(const std::string&, const std::vector<ProgramPart>& parts) {
  std::string text = parts.front().text;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const std::string& own = parts[k].text;
    const std::string routine = routine_of(parts[k].name);
    const std::size_t head = own.find(routine + "()"), tail = own.rfind("  ENDPROC"),
                      call = text.find(routine + ";");
    if (head == std::string::npos || tail == std::string::npos || call == std::string::npos) return {};
    const std::size_t at = begin_of_line(text, call), begin = behind_line(own, head);
    text.replace(at, behind_line(text, call) - at, own, begin, tail - begin);
  }
  return text;
}

}  // namespace counterflex
