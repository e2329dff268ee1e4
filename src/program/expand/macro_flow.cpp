// Loops, conditions and jumps of G-code: O-words of LinuxCNC, macro words of shop controls.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/expand/control_flow.hpp"
#include "program/expand/definitions.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

struct OWordKind {
  std::string_view keyword;
  FlowKind kind;
};
constexpr std::array o_word_kinds{
    OWordKind{"IF", FlowKind::begin_if},          OWordKind{"ELSEIF", FlowKind::else_if},
    OWordKind{"ELSE", FlowKind::otherwise},       OWordKind{"ENDIF", FlowKind::end_if},
    OWordKind{"WHILE", FlowKind::either_while},   OWordKind{"ENDWHILE", FlowKind::end_loop},
    OWordKind{"DO", FlowKind::begin_loop},        OWordKind{"REPEAT", FlowKind::begin_repeat},
    OWordKind{"ENDREPEAT", FlowKind::end_repeat}, OWordKind{"BREAK", FlowKind::leave_loop},
    OWordKind{"CONTINUE", FlowKind::next_pass},   OWordKind{"RETURN", FlowKind::leave_body}};

/// The text behind the keyword, up to a comment.
std::string_view behind_keyword(std::string_view text, const Block& block) {
  const std::string_view rest = text.substr(block.flow_keyword.end, block.span.end - block.flow_keyword.end);
  return trimmed_text(rest.substr(0, rest.find_first_of("(;")));
}

/// Position of `word` in `text` outside brackets, or npos.
std::size_t find_outside(std::string_view text, std::string_view word) {
  int depth = 0;
  for (std::size_t at = 0; at + word.size() <= text.size(); ++at) {
    if (text[at] == '[') ++depth;
    if (text[at] == ']') --depth;
    if (depth == 0 && is_word(text.substr(at, word.size()), word)) return at;
  }
  return std::string_view::npos;
}

/// The number of "DO1", "END 1".
std::string loop_number(std::string_view text, ControlLine& line) {
  text = trimmed_text(text);
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
  if (!plain) throw UnknownFlow{line.begin.line, fmt::format("{} has no plain number", line.keyword)};
  return normal_name(text);
}

void read_condition(std::string_view text, const Block& block, std::string_view rest, ControlLine& line) {
  const std::size_t jump = find_outside(rest, "GOTO"), then = find_outside(rest, "THEN");
  if (jump != std::string_view::npos) {
    line.kind = FlowKind::jump;
    line.target = trimmed_text(rest.substr(jump + 4));
  } else if (then != std::string_view::npos) {
    line.kind = FlowKind::assign_if;
    line.rest = {static_cast<std::size_t>(rest.data() - text.data()) + then + 4, block.span.end};
  } else {
    line.kind = FlowKind::not_followed;
    line.keyword = "IF without GOTO and THEN";
  }
  line.condition = trimmed_text(rest.substr(0, std::min(jump, then)));
}

void add_block_numbers(std::string_view text, const Block& block, ControlFlow& flow) {
  for (const Word& word : block.words)
    if (word.letter == 'N' && word.literal)
      flow.labels[normal_name(part(text, word.number))].push_back({block.span.begin, block.text_line});
}

}  // namespace

void add_o_word(std::string_view text, const Block& block, ControlFlow& flow) {
  const std::string_view keyword = part(text, block.flow_keyword);
  const auto known = std::find_if(o_word_kinds.begin(), o_word_kinds.end(),
                                  [&](const OWordKind& one) { return is_word(keyword, one.keyword); });
  if (empty(block.flow_keyword) || known == o_word_kinds.end()) return;
  ControlLine line = flow_line_of(block);
  line.kind = known->kind;
  line.keyword = keyword;
  line.name = normal_name(part(text, block.flow_name));
  line.condition = behind_keyword(text, block);
  if (line.name.empty())
    throw UnknownFlow{block.line, fmt::format("the name of {} is an expression", keyword)};
  flow.lines.push_back(std::move(line));
}

void add_macro_word(std::string_view text, const Block& block, bool jumps, ControlFlow& flow) {
  if (jumps) add_block_numbers(text, block, flow);
  if (empty(block.flow_keyword)) return;
  const std::string_view keyword = part(text, block.flow_keyword), rest = behind_keyword(text, block);
  ControlLine line = flow_line_of(block);
  line.keyword = keyword;
  if (is_word(keyword, "IF")) {
    read_condition(text, block, rest, line);
  } else if (is_word(keyword, "GOTO")) {
    line.kind = FlowKind::jump;
    line.target = rest;
  } else if (is_word(keyword, "WHILE")) {
    const std::size_t loop = find_outside(rest, "DO");
    line.kind = FlowKind::begin_while;
    line.condition = trimmed_text(rest.substr(0, loop));
    line.name = loop_number(loop == std::string_view::npos ? "" : rest.substr(loop + 2), line);
  } else if (is_word(keyword, "DO") || is_word(keyword, "END")) {
    line.kind = is_word(keyword, "DO") ? FlowKind::begin_loop : FlowKind::end_loop;
    line.name = loop_number(rest, line);
  } else {
    return;  // DPRNT, POPEN ... print
  }
  flow.lines.push_back(std::move(line));
}

}  // namespace counterflex
