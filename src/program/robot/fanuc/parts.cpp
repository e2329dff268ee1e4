// A FANUC TP program that calls its parts.
#include "program/robot/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "program/robot/fanuc/numbering.hpp"
#include "program/robot/fanuc/positions.hpp"
#include "program/robot/fanuc/read.hpp"
#include "program/robot/writer.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {
namespace {

/// Statements whose effect does not depend on the program that has them, by their first characters. Frames,
/// registers and outputs belong to the control.
constexpr auto free_statements = std::to_array<std::string_view>(
    {"UFRAME_NUM", "UTOOL_NUM", "R[", "PR[", "DO[", "RO[", "GO[", "AO[", "F[", "SR[", "WAIT", "CALL", "RUN",
     "MESSAGE[", "TIMER[", "OVERRIDE", "PAYLOAD[", "$"});

/// The parts of the text of a program.
struct Layout {
  Span name;                           ///< behind /PROG
  std::size_t statements = 0;          ///< behind the line /MN
  std::vector<RobotLine> header;       ///< of a corrected program
  std::vector<RobotLine> lines;        ///< of /MN
  std::size_t positions = 0, end = 0;  ///< the lines /POS and /END
};

Layout layout_of(std::string_view text) {
  Layout layout;
  RobotLine line;
  layout.positions = layout.end = text.size();
  for (TpSection section = TpSection::attributes; next_tp_line(text, section, line);) {
    if (const auto next = tp_section(part(text, line.span))) {
      section = *next;
      const std::vector<Span> words = tp_words(text, line.span);
      if (words.size() > 1 && part(text, words[0]) == "/PROG") layout.name = words[1];
      if (section == TpSection::statements && layout.statements == 0) layout.statements = line.line_end.end;
      if (section == TpSection::positions) layout.positions = line.span.begin;
      if (section == TpSection::end) {
        layout.end = line.span.begin;
        layout.positions = std::min(layout.positions, layout.end);
        break;
      }
    } else if (section == TpSection::statements) {
      const bool of_header =
          layout.lines.empty() && empty(line.code) && is_header_comment(part(text, line.comment));
      (of_header ? layout.header : layout.lines).push_back(line);
    }
  }
  return layout;
}

PartStatement part_statement(const std::string& file, std::string_view text, const RobotLine& line) {
  PartStatement statement{.span = {line.span.begin, line.line_end.end}};
  if (empty(line.code)) return statement;
  const std::string code = tp_word(part(text, line.code));
  if (const TpMotion motion = tp_motion(text, line.code); motion.type != 0) {
    statement.points = motion.operands.size();
    statement.is_rapid = motion.type == 'J';
  } else if (!std::ranges::any_of(free_statements, [&](auto head) { return code.starts_with(head); })) {
    refuse_part(file, line,
                fmt::format("'{}' may depend on the place of other statements", part(text, line.code)));
  }
  if (code.find("LBL[") != std::string::npos)
    refuse_part(file, line, fmt::format("'{}' jumps", part(text, line.code)));
  return statement;
}

std::string lines_of(std::string_view text, const std::vector<RobotLine>& lines) {
  std::string all;
  for (const RobotLine& line : lines) all += part(text, {line.span.begin, line.line_end.end});
  return all;
}

/// A program with the name `name`, these statements and positions, and the rest of `text`.
std::string program_of(const std::string& text, const Layout& layout, const TpFile& program,
                       const std::string& name, const std::string& statements, const std::string& positions) {
  const std::size_t line_end = text.find('\n', layout.positions);
  std::string all = text.substr(0, layout.name.begin) + name +
                    text.substr(layout.name.end, layout.statements - layout.name.end) +
                    lines_of(text, layout.header) + statements +
                    text.substr(layout.positions, line_end + 1 - layout.positions) + positions +
                    text.substr(layout.end);
  return program.numbered ? with_numbered_lines(std::move(all), program.line_count.has_value()) : all;
}

/// `text` with the number of its position, the first one in it, changed.
TextChange renamed(std::string_view text, std::size_t operand, long number) {
  const std::size_t digits = text.find('[', operand) + 1;
  return {{digits, tp_integer(text, digits)->end}, std::to_string(number)};
}

std::string part_of(const std::string& text, const Layout& layout, const TpFile& program,
                    const std::string& name, std::span<const RobotLine> lines) {
  const std::string_view line_end = part(text, lines.front().line_end);
  std::map<long, long> numbers;
  for (const RobotLine& line : lines)
    for (const TpOperand& operand : tp_positions_in(text, line.code)) numbers[*operand.number] = 0;
  long last = 0;
  std::string positions;
  for (auto& [old, number] : numbers) {
    const Span span = program.positions.at(old).span;
    std::vector<TextChange> change{renamed(text, span.begin, number = ++last)};
    positions.append(with_changes(text, span, change)).append(line_end);
  }
  std::string statements;
  for (const RobotLine& line : lines) {
    std::vector<TextChange> changes;
    for (const TpOperand& operand : tp_positions_in(text, line.code))
      changes.push_back(renamed(text, operand.span.begin, numbers.at(*operand.number)));
    statements += with_changes(text, {line.span.begin, line.line_end.end}, changes);
  }
  return program_of(text, layout, program, name, statements, positions);
}

}  // namespace

std::vector<ProgramPart> divide_tp(const std::string& file, const std::string& text, std::size_t most) {
  const TpFile program = tp_file(file, text);
  const Layout layout = layout_of(text);
  if (empty(layout.name) || layout.lines.empty() || text.find('\n', layout.positions) > layout.end)
    refuse_part(file, {.line = 1}, "it has no /PROG NAME, or no statements");
  std::vector<PartStatement> statements;
  for (const RobotLine& line : layout.lines) {
    for (const TpOperand& operand : tp_positions_in(text, line.code))
      if (!operand.number || !program.positions.contains(*operand.number))
        refuse_part(file, line, fmt::format("the position of '{}' is computed", part(text, line.code)));
    statements.push_back(part_statement(file, text, line));
  }
  const std::vector<std::size_t> begins = begins_of_parts(file, text, statements, most);
  const std::string name(part(text, layout.name));
  const std::string_view line_end = part(text, layout.lines.front().line_end);
  std::vector<ProgramPart> parts{{name, ""}};
  std::string calls;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    const std::size_t end = k + 1 < begins.size() ? begins[k + 1] : layout.lines.size();
    const std::string own_name = fmt::format("{}_{}", name, k + 1);
    calls += fmt::format("{:4}:  CALL {}    ;{}", k + 1, own_name, line_end);
    parts.push_back({own_name, part_of(text, layout, program, own_name,
                                       std::span(layout.lines).subspan(begins[k], end - begins[k]))});
  }
  parts.front().text = program_of(text, layout, program, name, calls, "");
  return parts;
}

std::string joined_tp(const std::string& file, const std::vector<ProgramPart>& parts) {
  std::string all;
  for (std::size_t k = parts.size() > 1 ? 1 : 0; k < parts.size(); ++k) {
    const std::string& text = parts[k].text;
    const TpFile program = tp_file(file, text);
    for (const RobotLine& line : layout_of(text).lines) {
      std::vector<TextChange> changes;
      for (const TpOperand& operand : tp_positions_in(text, line.code)) {
        const Span span = program.positions.at(*operand.number).span;
        const std::size_t digits = text.find('[', span.begin) + 1;
        changes.push_back(
            {operand.span,
             text.substr(digits, span.end - digits).substr(std::to_string(*operand.number).size())});
      }
      const auto number = tp_line_number(text, line.span);
      all += with_changes(text, {number ? number->field.end : line.span.begin, line.span.end}, changes);
      all += '\n';
    }
  }
  return all;
}

}  // namespace counterflex
