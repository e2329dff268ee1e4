// Loops, conditions, labels and jumps of a Sinumerik.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/expand/control_flow.hpp"
#include "program/expand/definitions.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Removes the name at the begin of `text`, with the blanks behind it.
std::string take_name(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && is_identifier_character(text[end])) ++end;
  const std::string name = upper_case(text.substr(0, end));
  text = trimmed_text(text.substr(end));
  return name;
}

/// "IF R1<3 GOTOB BEGIN": position of the word GOTO, GOTOB, GOTOF or GOTOC; npos if the line has no such
/// word.
std::size_t jump_in(const std::string& line) {
  for (std::size_t at = line.find("GOTO"); at != std::string::npos; at = line.find("GOTO", at + 1))
    if (at == 0 || is_blank(line[at - 1]) || line[at - 1] == ')') return at;
  return std::string::npos;
}

std::size_t comment_at(std::string_view line) {
  bool quoted = false;
  std::size_t at = 0;
  for (; at < line.size() && (quoted || line[at] != ';'); ++at)
    if (line[at] == '"') quoted = !quoted;
  return at;
}

/// A keyword, and the name of its structure.
struct SiemensKeyword {
  std::string_view keyword, structure;
  FlowKind kind;
};
constexpr std::array siemens_keywords{SiemensKeyword{"IF", "IF", FlowKind::begin_if},
                                      SiemensKeyword{"ELSE", "IF", FlowKind::otherwise},
                                      SiemensKeyword{"ENDIF", "IF", FlowKind::end_if},
                                      SiemensKeyword{"FOR", "FOR", FlowKind::begin_for},
                                      SiemensKeyword{"ENDFOR", "FOR", FlowKind::end_for},
                                      SiemensKeyword{"WHILE", "WHILE", FlowKind::begin_while},
                                      SiemensKeyword{"ENDWHILE", "WHILE", FlowKind::end_loop},
                                      SiemensKeyword{"LOOP", "LOOP", FlowKind::begin_loop},
                                      SiemensKeyword{"ENDLOOP", "LOOP", FlowKind::end_loop},
                                      SiemensKeyword{"REPEAT", "REPEAT", FlowKind::begin_loop},
                                      SiemensKeyword{"UNTIL", "REPEAT", FlowKind::loop_until},
                                      SiemensKeyword{"REPEATB", "", FlowKind::not_followed},
                                      SiemensKeyword{"CASE", "", FlowKind::not_followed}};

/// "N50" of "n050"; another name as it is.
std::string label_of_number(std::string name) {
  const bool is_number = name.size() > 1 && upper(name[0]) == 'N' &&
                         name.find_first_not_of("0123456789", 1) == std::string::npos;
  return is_number ? fmt::format("N{}", normal_name(std::string_view(name).substr(1))) : name;
}

void read_jump(std::string_view words, ControlLine& line) {
  line.kind = FlowKind::jump;
  const std::string direction = take_name(words);
  line.target = direction == "GOTOS" ? "" : (direction + " ") + label_of_number(take_name(words));
}

void read_siemens_keyword(std::string_view rest, ControlLine& line) {
  const std::string statement = upper_case(rest);
  std::string_view after = statement;
  const std::string name = take_name(after);
  const std::size_t jump = jump_in(statement);
  line.keyword = name;
  if (jump != std::string::npos) {
    if (jump == 0 || name == "IF") read_jump(std::string_view(statement).substr(jump), line);
    if (line.kind != FlowKind::jump)
      line.kind = FlowKind::not_followed, line.keyword = "GOTO behind other words";
    if (name == "IF") line.condition = trimmed_text(std::string_view(statement).substr(2, jump - 2));
  } else if (name == "REPEAT" && !after.empty()) {
    line.kind = FlowKind::not_followed;
    line.keyword = "REPEAT of labels";
  } else {
    const auto known = std::find_if(siemens_keywords.begin(), siemens_keywords.end(),
                                    [&](const SiemensKeyword& one) { return one.keyword == name; });
    if (known == siemens_keywords.end()) return;
    line.kind = known->kind;
    line.name = known->structure;
    line.condition = std::string(after);
  }
}

}  // namespace

void add_siemens_flow(std::string_view text, const Block& block, bool jumps, ControlFlow& flow) {
  ControlLine line = flow_line_of(block);
  std::string_view rest = part(text, block.span);
  rest = trimmed_text(rest.substr(0, comment_at(rest)));
  const bool skipped = rest.starts_with('/');
  if (skipped) rest = trimmed_text(rest.substr(std::min(rest.find_first_not_of("/0123456789"), rest.size())));
  if (rest.size() > 1 && upper(rest[0]) == 'N' && is_digit(rest[1])) {
    const std::size_t end = std::min(rest.find_first_not_of("0123456789", 1), rest.size());
    if (jumps) flow.labels[label_of_number(std::string(rest.substr(0, end)))].push_back(line.begin);
    rest = trimmed_text(rest.substr(end));
  }
  std::string_view ahead = rest;
  const std::string name = take_name(ahead);
  if (!name.empty() && !is_digit(name[0]) && ahead.starts_with(':') && !ahead.starts_with(":=")) {
    const auto at = static_cast<std::size_t>(rest.data() - text.data());
    line.label = {at, static_cast<std::size_t>(ahead.data() - text.data()) + 1};
    flow.labels[name].push_back(line.begin);
    rest = trimmed_text(ahead.substr(1));
  }
  read_siemens_keyword(rest, line);
  if (skipped && line.kind != FlowKind::label)
    throw UnknownFlow{block.line, "a jump or a loop is in a block that '/' may skip"};
  if (line.kind != FlowKind::label || !empty(line.label)) flow.lines.push_back(std::move(line));
}

CountedLoop read_counted_loop(const ControlLine& line) {
  const std::string_view text = line.condition;
  const std::size_t equals = std::min(text.find('='), text.size());
  for (std::size_t to = equals; (to = text.find("TO", to)) != std::string_view::npos; ++to) {
    const bool is_alone = !is_identifier_character(text[to - 1]) &&
                          (to + 2 == text.size() || !is_identifier_character(text[to + 2]));
    if (is_alone)
      return {trimmed_text(text.substr(0, equals)), text.substr(equals + 1, to - equals - 1),
              text.substr(to + 2)};
  }
  throw UnknownFlow{line.begin.line, "FOR needs the form FOR variable = begin TO end"};
}

}  // namespace counterflex
