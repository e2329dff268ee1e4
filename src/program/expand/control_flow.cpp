#include "program/expand/control_flow.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool opens_structure(FlowKind kind) {
  return kind == FlowKind::begin_if || kind == FlowKind::begin_while || kind == FlowKind::begin_loop ||
         kind == FlowKind::begin_repeat || kind == FlowKind::begin_for;
}

bool closes_structure(FlowKind kind) {
  return kind == FlowKind::end_if || kind == FlowKind::end_loop || kind == FlowKind::loop_while ||
         kind == FlowKind::loop_until || kind == FlowKind::end_repeat || kind == FlowKind::end_for;
}

bool ends_structure(FlowKind end, FlowKind begin) {
  switch (end) {
    case FlowKind::end_if:
      return begin == FlowKind::begin_if;
    case FlowKind::end_loop:
      return begin == FlowKind::begin_while || begin == FlowKind::begin_loop;
    case FlowKind::loop_while:
    case FlowKind::loop_until:
      return begin == FlowKind::begin_loop;
    case FlowKind::end_repeat:
      return begin == FlowKind::begin_repeat;
    default:
      return begin == FlowKind::begin_for;
  }
}

/// Finds the partners of lines, from first to last.
class Joining {
 public:
  explicit Joining(std::vector<ControlLine>& lines) : lines_(lines) {}

  void run() {
    for (std::size_t at = 0; at < lines_.size(); ++at) {
      ControlLine& line = lines_[at];
      if (line.kind == FlowKind::either_while)
        line.kind = closes_do(line) ? FlowKind::loop_while : FlowKind::begin_while;
      if (opens_structure(line.kind)) open_.push_back(at);
      if (closes_structure(line.kind)) close(at);
      if (line.kind == FlowKind::else_if || line.kind == FlowKind::otherwise) branch(at);
      if (line.kind == FlowKind::leave_loop || line.kind == FlowKind::next_pass)
        line.partner = loop_around(line);
      refuse_kept_state(line);
    }
    if (!open_.empty())
      throw UnknownFlow{lines_[open_.back()].begin.line,
                        fmt::format("{} has no end", lines_[open_.back()].keyword)};
  }

 private:
  [[noreturn]] static void refuse_end(const ControlLine& line) {
    throw UnknownFlow{line.begin.line, fmt::format("{} has no beginning", line.keyword)};
  }

  /// LinuxCNC does not forget the passes of a repeat loop that return leaves, nor the continue of a do loop.
  void refuse_kept_state(const ControlLine& line) const {
    const bool is_in_repeat = std::any_of(open_.begin(), open_.end(), [&](std::size_t at) {
      return lines_[at].kind == FlowKind::begin_repeat;
    });
    if (line.kind == FlowKind::leave_body && is_in_repeat)
      throw UnknownFlow{
          line.begin.line,
          fmt::format("{} is in a repeat loop, and LinuxCNC keeps its other passes for the next call",
                      line.keyword)};
    if (line.kind == FlowKind::next_pass && lines_[line.partner].kind == FlowKind::begin_loop)
      throw UnknownFlow{line.begin.line,
                        fmt::format("{} is in a do loop, and LinuxCNC repeats the next while or repeat loop",
                                    line.keyword)};
  }

  bool closes_do(const ControlLine& line) const {
    return !open_.empty() && lines_[open_.back()].kind == FlowKind::begin_loop &&
           lines_[open_.back()].name == line.name;
  }

  void close(std::size_t at) {
    ControlLine& line = lines_[at];
    if (open_.empty() || !ends_structure(line.kind, lines_[open_.back()].kind) ||
        lines_[open_.back()].name != line.name)
      refuse_end(line);
    const std::size_t begin = open_.back();
    open_.pop_back();
    line.partner = begin;
    lines_[begin].partner = at;
    if (line.kind == FlowKind::end_if) end_branches(begin, at);
  }

  void branch(std::size_t at) {
    const bool is_in_if = !open_.empty() && lines_[open_.back()].kind == FlowKind::begin_if;
    if (!is_in_if || lines_[open_.back()].name != lines_[at].name) refuse_end(lines_[at]);
    lines_[last_branch(open_.back())].next_branch = at;
  }

  std::size_t last_branch(std::size_t begin) const {
    std::size_t at = begin;
    while (lines_[at].next_branch != 0) at = lines_[at].next_branch;
    return at;
  }

  void end_branches(std::size_t begin, std::size_t end) {
    std::size_t at = begin;
    for (; lines_[at].next_branch != 0; at = lines_[at].next_branch) lines_[at].partner = end;
    lines_[at].partner = lines_[at].next_branch = end;
  }

  std::size_t loop_around(const ControlLine& line) const {
    const auto around = std::find_if(open_.rbegin(), open_.rend(), [&](std::size_t at) {
      const FlowKind kind = lines_[at].kind;
      return (kind == FlowKind::begin_while || kind == FlowKind::begin_loop) && lines_[at].name == line.name;
    });
    if (around == open_.rend())
      throw UnknownFlow{line.begin.line, fmt::format("{} is not in a while or do loop", line.keyword)};
    return *around;
  }

  std::vector<ControlLine>& lines_;
  std::vector<std::size_t> open_{};
};

}  // namespace

void add_flow(std::string_view text, const Dialect& dialect, const Block& block, bool jumps,
              ControlFlow& flow) {
  const std::size_t before = flow.lines.size();
  if (dialect.sinumerik_words) return add_siemens_flow(text, block, jumps, flow);
  if (dialect.o_words)
    add_o_word(text, block, flow);
  else
    add_macro_word(text, block, jumps, flow);
  if (flow.lines.size() > before && !empty(block.block_delete))
    throw UnknownFlow{block.line, "a jump or a loop is in a block that '/' may skip"};
}

void join_structures(ControlFlow& flow) {
  Joining(flow.lines).run();
}

const ControlLine* flow_line_at(const ControlFlow& flow, const Block& block) {
  const auto found =
      std::lower_bound(flow.lines.begin(), flow.lines.end(), block.text_line,
                       [](const ControlLine& line, int number) { return line.begin.line < number; });
  return found != flow.lines.end() && found->begin.line == block.text_line ? &*found : nullptr;
}

bool has_flow(const ControlFlow& flow) {
  return std::any_of(flow.lines.begin(), flow.lines.end(),
                     [](const ControlLine& line) { return line.kind != FlowKind::label; });
}

bool has_jumps(const ControlFlow& flow) {
  return std::any_of(flow.lines.begin(), flow.lines.end(),
                     [](const ControlLine& line) { return line.kind == FlowKind::jump; });
}

ControlLine flow_line_of(const Block& block) {
  ControlLine line;
  line.begin = {block.span.begin, block.text_line};
  line.behind = {block.line_end.end, block.text_line + 1};
  return line;
}

std::string_view trimmed_text(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

}  // namespace counterflex
