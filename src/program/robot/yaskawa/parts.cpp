// A Yaskawa job that calls its parts.
#include "program/robot/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

#include "program/robot/yaskawa/motion.hpp"
#include "program/robot/yaskawa/source.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Yaskawa Motoman knowledge base, "Inform Header Fields", NAME (knowledge.motoman.com, attachment
/// 21577948130839). NX100, "Job Data Format", HW0481924, section 4.1.2, allows 8.
constexpr std::size_t longest_name = 32;

/// The first local variable of a statement: LB000, LP[I000]. Empty if it has none.
Span local_variable(std::string_view text, Span code) {
  constexpr auto kinds = std::to_array<std::string_view>({"B", "I", "D", "R", "S", "P", "BP", "EX", "PX"});
  bool quoted = false;
  for (std::size_t at = code.begin; at < code.end;) {
    std::size_t end = at;
    while (end < code.end && is_identifier_character(text[end])) ++end;
    const Span span{at, end};
    if (text[at] == '"') quoted = !quoted;
    at = std::max(end, at + 1);
    if (quoted || empty(span)) continue;
    const std::string word = jbi_word(part(text, span));
    if (word == "JOB") at = std::min(text.find_first_of(" \t", end), code.end);  // a name
    const std::size_t letters = std::min(word.find_first_of("0123456789"), word.size());
    const bool has_number = letters < word.size() || (end < code.end && text[end] == '[');
    if (word[0] == 'L' && has_number && is_among(word.substr(1, letters - 1), kinds)) return span;
  }
  return {};
}

bool has_speed(std::string_view text, Span code) {
  return std::ranges::any_of(jbi_words(text, code), [&](Span span) {
    const std::string word = jbi_word(part(text, span));
    return word.starts_with("V=") || word.starts_with("VJ=") || word.starts_with("VR=") ||
           word.starts_with("VE=");
  });
}

/// Whether SPEED in another job acts on a step is not known: no manual was at hand.
void check_speed(const std::string& file, const JbiSource& source, const RobotLine& line) {
  const std::string head = jbi_head(source.text, line);
  if (is_jbi_move(head) && !head.starts_with('+') && !has_speed(source.text, line.code))
    refuse_part(file, line,
                fmt::format("'{}' has no speed of its own, and SPEED may act in one job only",
                            part(source.text, line.code)));
}

void check_statement(const std::string& file, const JbiSource& source, const RobotLine& line) {
  const std::string_view text = source.text;
  const auto refuse_it = [&](std::string_view why) {
    refuse_part(file, line, fmt::format("'{}' {}", part(text, line.code), why));
  };
  const std::string head = jbi_head(text, line);
  const JbiFlow flow = jbi_flow(head);
  if (flow == JbiFlow::label) refuse_it("is a label, to which other statements may jump");
  if (flow == JbiFlow::jump) refuse_it("jumps");
  if (head == "GETARG") refuse_it("needs the arguments of the main job");
  if (head.ends_with("SFTON") || head.ends_with("SFTOF")) refuse_it("may act in one job only");
  if (const Span local = local_variable(text, line.code); !empty(local))
    refuse_part(file, line, fmt::format("'{}' is a local variable of the main job", part(text, local)));
  check_speed(file, source, line);
}

/// What holds where the divided lines begin and end.
void check_around(const std::string& file, const JbiSource& source) {
  const std::span<const RobotLine> lines(source.layout.lines);
  const RobotLine* shift = nullptr;
  for (const RobotLine& line : lines.first(source.layout.first)) {
    const std::string head = jbi_head(source.text, line);
    if (head.ends_with("SFTON")) shift = &line;
    if (head.ends_with("SFTOF")) shift = nullptr;
  }
  if (shift != nullptr)
    refuse_part(file, *shift, fmt::format("'{}' may act in one job only", part(source.text, shift->code)));
  for (const RobotLine& line : lines.subspan(source.layout.behind)) check_speed(file, source, line);
}

std::vector<PartStatement> statements_of(const std::string& file, const JbiSource& source) {
  const std::string_view text = source.text;
  std::vector<PartStatement> statements;
  std::vector<const RobotLine*> open;  // loops and conditions
  std::size_t behind_move = 0;
  for (const RobotLine& line : source.layout.divided()) {
    const std::string head = jbi_head(text, line);
    PartStatement& statement =
        statements.emplace_back(PartStatement{.span = jbi_whole(line), .may_begin = open.empty()});
    if (head.empty()) continue;
    check_statement(file, source, line);
    const JbiFlow flow = jbi_flow(head);
    const bool closes = flow == JbiFlow::branch || flow == JbiFlow::body_end;
    if (closes && open.empty())
      refuse_part(file, line, fmt::format("'{}' belongs to a line before the first linear move", head));
    if (flow == JbiFlow::body_begin) open.push_back(&line);
    if (flow == JbiFlow::body_end) open.pop_back();
    if (!is_jbi_move(head)) continue;
    for (const JbiName& name : jbi_names(text, line.code))
      statement.points += name.family == JbiFamily::robot || name.family == JbiFamily::robot_variable;
    statement.is_rapid = head == "MOVJ";
    if (head.starts_with('+')) statement.may_begin = false;
    // The three MOVC of a circle are one after the other.
    if (head == "MOVC" && circle_step(source.job, line.span.begin) != JbiCircleStep::start)
      for (std::size_t i = behind_move; i < statements.size(); ++i) statements[i].may_begin = false;
    behind_move = statements.size();
  }
  if (!open.empty())
    refuse_part(file, *open.back(),
                fmt::format("'{}' ends behind the last linear move", part(text, open.back()->code)));
  return statements;
}

std::string part_of(const JbiSource& source, const std::string& name, std::span<const RobotLine> lines) {
  const auto& [text, job, layout] = source;
  const std::string line_end(part(text, lines.front().line_end));
  const JbiNumbers numbers = jbi_numbers(source, jbi_positions_in(source, lines));
  return text.substr(0, layout.name.begin) + name +
         text.substr(layout.name.end, layout.positions.begin - layout.name.end) +
         jbi_position_lines(source, numbers) + layout.attributes + "NOP" + line_end + layout.header +
         jbi_statements(source, lines, numbers) + "END" + line_end;
}

/// The statements around `calls`, with all variables and those positions of steps that no part takes.
std::string main_of(const JbiSource& source, const std::string& calls) {
  const auto& [text, job, layout] = source;
  const std::span<const RobotLine> lines(layout.lines);
  const auto before = lines.first(layout.first), after = lines.subspan(layout.behind);
  std::set<std::size_t> used = jbi_positions_in(source, before);
  used.merge(jbi_positions_in(source, after));
  const std::set<std::size_t> taken = jbi_positions_in(source, layout.divided());
  for (std::size_t i = 0; i < job.positions.list.size(); ++i)
    if (is_variable(job.positions.list[i].family) || !taken.contains(i)) used.insert(i);
  const JbiNumbers numbers = jbi_numbers(source, used);
  const std::size_t end = lines.empty() ? layout.statements : lines.back().line_end.end;
  return text.substr(0, layout.positions.begin) + jbi_position_lines(source, numbers) +
         text.substr(layout.positions.end, layout.statements - layout.positions.end) +
         jbi_statements(source, before, numbers) + calls + jbi_statements(source, after, numbers) +
         text.substr(end);
}

std::string call_of(const std::string& name) {
  return "CALL JOB:" + name;
}

/// A part must not take the name of a job that the statements name, and a position not a number that
/// statements have although the file does not have its values.
void check_names(const std::string& file, const JbiSource& source, const std::set<std::string>& called) {
  for (const RobotLine& line : source.layout.lines) {
    const auto refuse_it = [&](std::string_view why) {
      refuse_part(file, line, fmt::format("'{}' needs {}", part(source.text, line.code), why));
    };
    for (const JbiName& name : jbi_names(source.text, line.code))
      if (!is_variable(name.family) && source.index_of(name) == source.job.positions.list.size())
        refuse_it("a position that has no values above //INST");
    for (const Span word : jbi_words(source.text, line.code))
      if (called.contains(std::string(part(source.text, word))))
        refuse_it("a job that has the name of a part");
  }
}

}  // namespace

std::vector<ProgramPart> divide_jbi(const std::string& file, const std::string& text, std::size_t most) {
  const JbiSource source = jbi_source(file, text);
  const JbiLayout& layout = source.layout;
  if (empty(layout.name) || layout.name.end > layout.positions.begin || layout.behind == 0 || !layout.ends)
    refuse_part(file, {.line = 1}, "it has no //NAME, no //POS, no linear move, or no END");
  check_around(file, source);
  const std::vector<PartStatement> statements = statements_of(file, source);
  const std::vector<std::size_t> begins = begins_of_parts(file, text, statements, most);
  const std::string name(part(text, layout.name));
  std::vector<ProgramPart> parts{{name, ""}};
  std::set<std::string> called;
  std::string calls;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const std::size_t end = k + 1 < begins.size() ? begins[k + 1] : statements.size();
    const std::string own_name = fmt::format("{}_{}", name, k + 1);
    if (own_name.size() > longest_name)
      refuse_part(file, {.line = 1},
                  fmt::format("the name of its part {} is longer than the {} characters of a name of a job",
                              own_name, longest_name));
    called.insert("JOB:" + own_name);
    calls.append(call_of(own_name)).append(part(text, layout.lines[layout.first].line_end));
    parts.push_back(
        {own_name, part_of(source, own_name, layout.divided().subspan(begins[k], end - begins[k]))});
  }
  check_names(file, source, called);
  parts.front().text = main_of(source, calls);
  return parts;
}

std::string joined_jbi(const std::string& file, const std::vector<ProgramPart>& parts) {
  std::map<std::string, std::string> called;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const JbiSource source = jbi_source(file, parts[k].text);
    std::string& statements = called[call_of(parts[k].name)];
    for (const RobotLine& line : source.layout.lines) statements += jbi_statement_with_values(source, line);
  }
  const JbiSource source = jbi_source(file, parts.front().text);
  std::string all = source.layout.attributes + source.layout.header;
  for (const RobotLine& line : source.layout.lines) {
    const auto call = called.find(std::string(part(source.text, line.code)));
    all += call != called.end() ? call->second : jbi_statement_with_values(source, line);
  }
  return all;
}

}  // namespace counterflex
