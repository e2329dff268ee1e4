#include "program/klartext/expand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "program/expand/expand.hpp"
#include "program/expand/lines.hpp"
#include "program/klartext/labels.hpp"
#include "program/klartext/lex.hpp"
#include "program/klartext/write/numbers.hpp"

namespace counterflex {
namespace {

enum class Role { other, label, call, repeat, end };

/// A block, and its role in the flow of the program.
struct FlowBlock {
  Role role = Role::other;
  Span bytes{};  ///< with its line end
  int line = 0;
  std::string name{};  ///< of the label
  int repeats = 1;
};

/// Whether the words include M2 or M30.
bool has_end_code(std::string_view words) {
  for (std::size_t at = words.find('M'); at != std::string_view::npos; at = words.find('M', at + 1)) {
    int code = -1;
    std::from_chars(words.data() + at + 1, words.data() + words.size(), code);
    if (code == 2 || code == 30) return true;
  }
  return false;
}

/// "REP 3", "REP 3/3" behind the label; 0 if it is not a plain number.
int repeats_in(std::string_view rest) {
  int count = 0;
  std::from_chars(rest.data() + rest.find("REP") + 3, rest.data() + rest.size(), count);
  return count;
}

class KlartextExpander {
 public:
  KlartextExpander(const std::string& text, const std::string& file) : text_(text), file_(file) {
    lines_.line_end = line_end_of(text);
    KlartextBlock block;
    while (next_klartext_block(text, block)) add(block);
  }

  Expansion run(std::string& text) {
    const auto end =
        std::find_if(blocks_.begin(), blocks_.end(), [](auto& b) { return b.role == Role::end; });
    const auto main = static_cast<std::size_t>(end - blocks_.begin());
    const bool calls = std::any_of(blocks_.begin(), end,
                                   [](auto& b) { return b.role == Role::call || b.role == Role::repeat; });
    if (!calls) return {};
    expansion_.file_lines = blocks_.empty() ? 0 : blocks_.back().line;
    if (why_not_.empty()) put(0, main, 0);
    if (!why_not_.empty()) return left_alone();
    for (std::size_t i = main; i < blocks_.size(); ++i) append(blocks_[i], 0);
    WrittenNumbers numbers{.renumbers = numbered_};
    text = renumbered_klartext(lines_.text, numbers);
    expansion_.lines = std::move(lines_.runs);
    return std::move(expansion_);
  }

 private:
  void add(const KlartextBlock& block) {
    FlowBlock flow{.bytes = {block.span.begin, block.line_end.end}, .line = block.line};
    numbered_ = numbered_ || !empty(block.number);
    const std::string rest = squeezed(after_head(text_, block));
    const bool calls = block.head == "CALL" && rest.starts_with("LBL");
    if (block.head == "LBL" || calls) {
      flow.name = label_name(calls ? std::string_view(rest).substr(3) : rest);
      flow.role = !calls ? Role::label : rest.find("REP") == std::string::npos ? Role::call : Role::repeat;
      if (flow.role == Role::repeat) flow.repeats = repeats_in(rest);
      if (calls && flow.name == "Q") refuse(block.line, "the label is a Q parameter");
      if (calls && !empty(block.block_delete)) refuse(block.line, "'/' may skip the call");
      if (flow.repeats < 1) refuse(block.line, "REP needs an integer from 1");
    } else if (block.head == "END" || (empty(block.block_delete) && has_end_code(words_of(block, rest)))) {
      flow.role = Role::end;
    } else if (rest.find("GOTOLBL") != std::string::npos) {
      refuse(block.line, "the program jumps to a label");
    }
    blocks_.push_back(std::move(flow));
  }

  static std::string words_of(const KlartextBlock& block, const std::string& rest) {
    if (block.head == "M") return "M" + rest;
    return block.head == "L" || block.head == "STOP" ? rest : "";
  }

  void refuse(int line, const std::string& why) {
    if (why_not_.empty()) why_not_ = fmt::format("line {}: {}", line, why);
  }

  /// Position of the label, before `end`.
  std::optional<std::size_t> find_label(const std::string& name, std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i)
      if (blocks_[i].role == Role::label && blocks_[i].name == name) return i;
    return std::nullopt;
  }

  /// Copies the blocks from `begin` to `end`. `called_from`: line of the call in the program, 0 for the
  /// program itself.
  void put(std::size_t begin, std::size_t end, int called_from) {
    for (std::size_t i = begin; i < end && why_not_.empty(); ++i) {
      const FlowBlock& block = blocks_[i];
      const int from = called_from > 0 ? called_from : block.line;
      if (block.role == Role::call)
        put_body(block, from);
      else if (block.role == Role::repeat)
        put_repeats(i, begin, from);
      else if (block.role == Role::end)
        refuse(block.line, "a subprogram ends the program");
      else if (called_from == 0 || block.role != Role::label)
        append(block, called_from);
    }
  }

  void put_body(const FlowBlock& call, int from) {
    const auto label = find_label(call.name, 0, blocks_.size());
    if (!label) return refuse(call.line, fmt::format("LBL {} is missing", call.name));
    const auto end = find_label("0", *label, blocks_.size());
    if (!end) return refuse(call.line, fmt::format("LBL 0 is missing behind LBL {}", call.name));
    if (std::find(called_.begin(), called_.end(), *label) != called_.end())
      return refuse(call.line, fmt::format("LBL {} calls itself", call.name));
    count_call(call);
    called_.push_back(*label);
    put(*label + 1, *end, from);
    called_.pop_back();
  }

  void put_repeats(std::size_t repeat, std::size_t begin, int from) {
    const FlowBlock& call = blocks_[repeat];
    const auto label = find_label(call.name, begin, repeat);
    if (!label) return refuse(call.line, fmt::format("LBL {} is not before its REP", call.name));
    for (int k = 0; k < call.repeats && why_not_.empty(); ++k) {
      count_call(call);
      put(*label + 1, repeat, from);
    }
  }

  void count_call(const FlowBlock& call) {
    if (expansion_.calls++ == 0) expansion_.first_call = call.line;
    const std::string exceeded =
        limit_exceeded({static_cast<std::size_t>(lines_.count), lines_.text.size(), expansion_.calls},
                       {static_cast<std::size_t>(expansion_.file_lines), text_.size(), 0});
    if (!exceeded.empty())
      throw InputError(ErrorKind::program_text, {file_, call.line, 1},
                       fmt::format("CALL LBL {}: {}; reduce the repeats, or leave out --expand-subprograms",
                                   call.name, exceeded));
  }

  void append(const FlowBlock& block, int called_from) {
    int line = block.line;
    for (std::size_t at = block.bytes.begin; at < block.bytes.end;) {
      const std::size_t end = std::min(text_.find('\n', at), block.bytes.end - 1) + 1;
      lines_.append(std::string_view(text_).substr(at, end - at), line++, called_from);
      at = end;
    }
  }

  /// No call is replaced.
  Expansion left_alone() const {
    Expansion expansion;
    for (const FlowBlock& block : blocks_)
      if (block.role == Role::call || block.role == Role::repeat)
        expansion.unexpanded_calls.push_back({block.line, why_not_});
    return expansion;
  }

  const std::string& text_;
  const std::string& file_;
  std::vector<FlowBlock> blocks_{};
  std::vector<std::size_t> called_{};  // labels of the bodies that are being copied
  std::string why_not_{};
  bool numbered_ = false;
  ExpandedLines lines_{};
  Expansion expansion_{};
};

}  // namespace

Expansion expand_klartext(std::string& text, const std::string& file) {
  const std::string original = text;
  return KlartextExpander(original, file).run(text);
}

}  // namespace counterflex
