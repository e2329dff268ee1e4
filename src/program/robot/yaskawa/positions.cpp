#include "program/robot/yaskawa/positions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "counterflex/files/input_error.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t rectangular_numbers = 6;  // X, Y, Z, Rx, Ry, Rz

/// "///USER 3": its word in upper case, and the text behind it.
struct PseudoInstruction {
  std::string word;
  Span argument;
};

PseudoInstruction pseudo_instruction(std::string_view text, Span code) {
  std::size_t begin = code.begin;
  while (begin < code.end && text[begin] == '/') ++begin;
  const std::size_t end = std::min(text.find_first_of(" \t", begin), code.end);
  return {jbi_word(text.substr(begin, end - begin)), {behind_blanks(text, end, code.end), code.end}};
}

/// What reading of the position data has found so far.
struct Scan {
  std::string_view text;
  const std::string& file;
  JbiPositions positions{};
  JbiSection section{};
  bool has_form = false;  ///< RECTAN or PULSE was read
  bool inside = false;    ///< behind //POS
};

long number_of(const Scan& scan, const RobotLine& line, const PseudoInstruction& instruction) {
  long number = -1;
  const Span span = instruction.argument;
  const auto [end, error] =
      std::from_chars(scan.text.data() + span.begin, scan.text.data() + span.end, number);
  if (error != std::errc() || end != scan.text.data() + span.end || number < 0)
    refuse(scan.file, line, span.begin,
           fmt::format("'{0}' is not the number of ///{1}; write ///{1} 1", part(scan.text, span),
                       instruction.word));
  return number;
}

void read_counts(Scan& scan, Span argument) {
  for (std::size_t at = argument.begin; at < argument.end;) {
    const std::size_t stop = std::min(scan.text.find(',', at), argument.end);
    const std::size_t begin = behind_blanks(scan.text, at, stop);
    std::size_t end = begin;
    while (end < stop && is_digit(scan.text[end])) ++end;
    scan.positions.counts.push_back({begin, end});
    at = stop + 1;
  }
}

void read_type(Scan& scan, const RobotLine& line, Span argument) {
  constexpr auto types =
      std::to_array<std::string_view>({"PULSE", "BASE", "ROBOT", "TOOL", "USER", "MTOOL", "MASTER"});
  scan.section.type = jbi_word(part(scan.text, argument));
  if (!is_among(scan.section.type, types))
    refuse(scan.file, line, argument.begin,
           fmt::format("'{}' is not a type of positions; use PULSE, BASE, ROBOT or USER",
                       part(scan.text, argument)));
}

void read_pseudo_instruction(Scan& scan, const RobotLine& line) {
  const PseudoInstruction instruction = pseudo_instruction(scan.text, line.code);
  const std::string& word = instruction.word;
  if (word == "NPOS") return read_counts(scan, instruction.argument);
  if (word == "USER") scan.section.user = number_of(scan, line, instruction);
  if (word == "TOOL") scan.section.tool = number_of(scan, line, instruction);
  if (word == "POSTYPE") return read_type(scan, line, instruction.argument);
  if (word == "RECTAN" || word == "PULSE") {
    scan.section.rectangular = word == "RECTAN";
    scan.has_form = true;
    return;
  }
  if (word == "USER" || word == "TOOL" || word == "RCONF") return;
  if (scan.section.unknown.empty()) scan.section.unknown = word;
}

/// The pseudo instructions above a position must agree: its numbers have no meaning otherwise.
void check_section(const Scan& scan, const RobotLine& line) {
  const JbiSection& section = scan.section;
  const auto wrong = [&](std::string_view what) {
    refuse(scan.file, line, line.code.begin,
           fmt::format("the position '{}' {}",
                       part(scan.text, {line.code.begin, scan.text.find('=', line.code.begin)}), what));
  };
  if (!scan.has_form) wrong("has neither ///RECTAN nor ///PULSE above it; write one of them");
  if (section.rectangular && section.type.empty())
    wrong("has ///RECTAN but no ///POSTYPE above it: write ///POSTYPE BASE, ROBOT or USER");
  if (section.rectangular && section.type == "PULSE")
    wrong("has ///RECTAN and ///POSTYPE PULSE above it; use ///PULSE, or ///POSTYPE BASE, ROBOT or USER");
  if (!section.rectangular && !section.type.empty() && section.type != "PULSE")
    wrong(fmt::format("has ///PULSE and ///POSTYPE {} above it; use ///RECTAN, or ///POSTYPE PULSE",
                      section.type));
  if (section.type == "USER" && !section.user)
    wrong("has ///POSTYPE USER but no ///USER above it; write the number of the user coordinate system");
}

/// Refuses the first value that is not a number.
[[noreturn]] void refuse_values(const Scan& scan, const RobotLine& line) {
  const std::size_t equals = scan.text.find('=', line.code.begin);
  std::size_t at = line.code.begin;
  if (equals < line.code.end)
    for (at = behind_blanks(scan.text, equals + 1, line.code.end); at < line.code.end;) {
      const auto number = number_at(scan.text, at);
      const std::size_t next = number ? behind_blanks(scan.text, number->span.end, line.code.end) : at;
      if (!number || (next < line.code.end && scan.text[next] != ',')) break;
      at = behind_blanks(scan.text, next + 1, line.code.end);
    }
  refuse(scan.file, line, std::min(at, line.code.end),
         fmt::format("'{}' is not a position; write C00001=1.000,2.000,3.000,0.0000,0.0000,0.0000",
                     part(scan.text, line.code)));
}

void read_position(Scan& scan, const RobotLine& line) {
  const auto values = jbi_values(scan.text, line.span.begin);
  if (!values) refuse_values(scan, line);
  check_section(scan, line);
  const JbiFamily family = values->name.family;
  const bool of_robot = family == JbiFamily::robot || family == JbiFamily::robot_variable;
  if (of_robot && scan.section.rectangular && values->numbers.size() < rectangular_numbers)
    refuse(scan.file, line, values->name.span.begin,
           fmt::format("the position '{}' has {} numbers; it needs {}: X, Y, Z, Rx, Ry, Rz",
                       part(scan.text, values->name.span), values->numbers.size(), rectangular_numbers));
  auto& sections = scan.positions.sections;
  if (sections.empty() || sections.back() != scan.section) sections.push_back(scan.section);
  scan.positions.list.push_back({.line_begin = line.span.begin,
                                 .number = values->name.number,
                                 .section = static_cast<std::uint32_t>(sections.size() - 1),
                                 .family = family});
}

void sort_by_name(Scan& scan) {
  auto& by_name = scan.positions.by_name;
  const auto& all = scan.positions.list;
  by_name.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) by_name[i] = static_cast<std::uint32_t>(i);
  const auto key = [&](std::uint32_t i) { return std::pair(all[i].family, all[i].number); };
  std::stable_sort(by_name.begin(), by_name.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  const auto twice = std::adjacent_find(by_name.begin(), by_name.end(),
                                        [&](std::uint32_t a, std::uint32_t b) { return key(a) == key(b); });
  if (twice == by_name.end()) return;
  const std::size_t first = all[*twice].line_begin, second = all[*(twice + 1)].line_begin;
  RobotLine line = jbi_line_at(scan.text, second);
  line.line = jbi_line_number(scan.text, second);
  refuse(scan.file, line, line.code.begin,
         fmt::format("the position '{}' has values in line {} already; give each position once",
                     part(scan.text, jbi_values(scan.text, second)->name.span),
                     jbi_line_number(scan.text, first)));
}

std::size_t index_of(const JbiPositions& positions, JbiFamily family, std::uint32_t number) {
  const auto key = [&](std::uint32_t i) {
    return std::pair(positions.list[i].family, positions.list[i].number);
  };
  const auto wanted = std::pair(family, number);
  const auto at = std::lower_bound(positions.by_name.begin(), positions.by_name.end(), wanted,
                                   [&](std::uint32_t i, const auto& name) { return key(i) < name; });
  return at != positions.by_name.end() && key(*at) == wanted ? *at : positions.list.size();
}

}  // namespace

const JbiPosition* JbiPositions::find(JbiFamily family, std::uint32_t number) const {
  const std::size_t index = index_of(*this, family, number);
  return index < list.size() ? &list[index] : nullptr;
}

JbiPosition* JbiPositions::find(JbiFamily family, std::uint32_t number) {
  const std::size_t index = index_of(*this, family, number);
  return index < list.size() ? &list[index] : nullptr;
}

std::optional<JbiValues> jbi_values(std::string_view text, std::size_t line_begin) {
  const Span code = jbi_line_at(text, line_begin).code;
  std::size_t end = code.begin;
  while (end < code.end && is_identifier_character(text[end])) ++end;
  const auto name = jbi_name(text, {code.begin, end});
  const std::size_t equals = behind_blanks(text, end, code.end);
  if (!name || equals >= code.end || text[equals] != '=') return std::nullopt;
  JbiValues values{*name, {equals + 1, code.end}, {}};
  for (std::size_t at = equals;;) {  // '=' or ','
    at = behind_blanks(text, at + 1, code.end);
    if (at == code.end && !values.numbers.empty()) break;  // a comma ends some lines
    const auto number = number_at(text, at);
    if (!number || number->span.end > code.end) return std::nullopt;
    values.numbers.push_back(*number);
    at = behind_blanks(text, number->span.end, code.end);
    if (at == code.end) break;
    if (text[at] != ',') return std::nullopt;
  }
  return values;
}

int jbi_line_number(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

JbiPositions jbi_positions(std::string_view text, const std::string& file) {
  Scan scan{text, file};
  RobotLine line;
  while (next_robot_line(text, jbi_comment, line)) {
    const std::string_view code = part(text, line.code);
    if (code.empty()) continue;
    if (code.starts_with("//") && !code.starts_with("///")) {
      const std::string word = pseudo_instruction(text, line.code).word;
      if (word == "INST") {
        scan.positions.end = line.line_end.end;
        sort_by_name(scan);
        return std::move(scan.positions);
      }
      scan.inside = word == "POS";
    } else if (scan.inside && code.front() == '/') {
      read_pseudo_instruction(scan, line);
    } else if (scan.inside) {
      read_position(scan, line);
    }
  }
  throw InputError(ErrorKind::program_text, {file, std::max(line.line, 1), 1},
                   "the job has no //INST: its instructions are missing");
}

}  // namespace counterflex
