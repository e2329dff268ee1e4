#include "program/expand/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "counterflex/program/program.hpp"
#include "program/expand/body_line.hpp"
#include "program/expand/call.hpp"
#include "program/expand/follow_flow.hpp"
#include "program/expand/lines.hpp"
#include "program/expand/main_flow.hpp"
#include "program/expand/structures.hpp"
#include "program/expand/subprograms.hpp"
#include "program/outline.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t deepest_calls = 100;

/// The program itself, or a body that is being executed.
struct Frame {
  const ControlFlow& flow;
  Variables& variables;
  bool flows = false;                      ///< it has loops, conditions or jumps
  const Definition* definition = nullptr;  ///< of a body
  bool writes_values = false;              ///< the body of an O-word, which has its own variables
  int called_from = 0;
  bool left = false;  ///< by RETURN
};

/// Executes a program, or copies it if its flow is unknown, and replaces calls by the bodies.
class Expander {
 public:
  Expander(std::string_view text, const std::string& file, const Dialect& dialect, std::string_view why_none)
      : text_(text),
        file_(file),
        dialect_(dialect),
        why_none_(why_none),
        subprograms_(text, file, dialect),
        program_{text, file, dialect, subprograms_.numbered()},
        lines_{{}, line_end_of(text)} {
    reads_results_ = text.find("<_value") != std::string_view::npos;
    expansion_.file_lines = count_lines(text);
  }

  /// Throws `UnknownFlow` if a loop, a condition or a jump of the program cannot be executed.
  ExpandedText execute() {
    const MainFlow main = read_main_flow(program_);
    // Calls of a Sinumerik stay: without flow, the text does not change.
    if (!main.any && !may_expand(dialect_)) return {};
    follows_ = true;
    was_executed_.resize(static_cast<std::size_t>(expansion_.file_lines) + 1);
    expansion_.in_order = may_execute(dialect_);
    return finish(copy_program(main));
  }

  /// Copies loops, conditions and jumps of the program unchanged.
  ExpandedText copy(std::optional<UnknownFlow> unknown) {
    unknown_ = std::move(unknown);
    const LinePlace rest = copy_program({});
    if (unknown_)
      expansion_.unexpanded_calls.push_back(
          {lines_.count + 1 + unknown_->line - rest.line, unknown_->why, true});
    return finish(rest);
  }

 private:
  ExpandedText finish(LinePlace rest) {
    if (rest.at < text_.size()) lines_.append(text_.substr(rest.at), rest.line, 0);
    expansion_.lines = std::move(lines_.runs);
    // If no block outside of definitions moves, a definition may be the program (M99 repeats it), or may be
    // called from other files.
    if (!other_calls_ && moves_) expansion_.unused = std::move(kept_);
    return {std::move(lines_.text), std::move(expansion_), seeks_numbers_};
  }

  /// Copies everything up to the end of the program, definitions included. Returns the begin of the rest.
  LinePlace copy_program(const MainFlow& main) {
    Variables variables;
    Frame frame{main.flow, variables, main.any};
    Block block;
    bool opened = false, has_words = false;
    while (next_line(text_, block)) {
      lex(text_, file_, dialect_, block);
      if (block.percent && (opened || has_words)) return {block.span.begin, block.line};
      opened = opened || block.percent;
      has_words = has_words || !block.words.empty();
      if (const auto definition = definition_at(program_, block)) {
        keep(*definition);
        block = before(definition->after);
        continue;
      }
      if (follows_ && block.span.begin >= main.end) {
        if (main.any) throw UnknownFlow{block.line, "the program continues into another program"};
        expansion_.in_order = false;
      }
      const bool ends = ends_main(block, dialect_);
      // The line that ends a Sinumerik program is not changed.
      if (ends && dialect_.sinumerik_words) return {block.span.begin, block.line};
      run_main_line(block, frame);
      if (ends && structures_.open.empty()) break;
    }
    return {block.line_end.end, block.line + 1};
  }

  void run_main_line(Block& block, Frame& frame) {
    if (follows_) {
      run_line(block, frame);
      return;
    }
    note_unknown(block);
    follow_structures(text_, dialect_, block, structures_);
    if (!structures_.open.empty()) leave_to_linuxcnc(block);
    copy_block(block, frame, {});
    frame.variables.clear();
  }

  /// The line of the text that is not executed, for the remark on it.
  void note_unknown(const Block& block) {
    if (!unknown_ || unknown_->line != block.line) return;
    expansion_.unexpanded_calls.push_back({lines_.count + 1, unknown_->why, true});
    unknown_.reset();
  }

  void keep(const Definition& d) {
    const std::size_t begin = lines_.text.size();
    append_lines(text_, d.begin.at, d.begin.line, d.after.at, lines_);
    kept_.push_back({begin, lines_.text.size()});
  }

  /// Executes a line and sets `block` before the next one. Returns why the copy of a body cannot continue;
  /// empty if it can.
  std::string run_line(Block& block, Frame& frame) {
    count_line(frame);
    const ControlLine* line = flow_line_at(frame.flow, block);
    if (line == nullptr || line->kind == FlowKind::label)
      return copy_block(block, frame, line == nullptr ? Span{} : line->label);
    if (expansion_.executed++ == 0) expansion_.first_executed = block.line;
    jumped_from_ = block.line;
    const FlowStep step = follow(frame.flow, *line, dialect_, loops_, frame.variables);
    if (!step.written.empty()) lines_.append(step.written + lines_.line_end, block.line, block.line);
    if (!empty(step.rest)) assign_rest(block, step.rest, frame);
    frame.left = step.leaves;
    const int called_from = block.called_from;
    block = before(step.next);
    block.called_from = called_from;
    return {};
  }

  void count_line(const Frame& frame) {
    ++run_lines_;
    if (!frame.flows) return;
    if (const std::string exceeded = exceeded_limit(); !exceeded.empty())
      throw UnknownFlow{jumped_from_, exceeded};
  }

  std::string exceeded_limit() const {
    return limit_exceeded({run_lines_, lines_.text.size(), expansion_.calls},
                          {static_cast<std::size_t>(expansion_.file_lines), text_.size(), 0});
  }

  /// "#1=5" of "IF [...] THEN #1=5".
  void assign_rest(const Block& block, Span rest, Frame& frame) {
    Block assignment;
    assignment.line = block.line;
    assignment.text_line = block.text_line;
    assignment.span = rest;
    assignment.line_end = block.line_end;
    const bool is_one = lexes(text_, file_, dialect_, assignment) && assignment.words.empty() &&
                        assignment.assigns && empty(assignment.flow_keyword) &&
                        assignment.statement == Statement::none;
    if (!is_one) throw UnknownFlow{block.line, "THEN needs exactly one assignment behind it"};
    lines_.append(line_without(text_, dialect_, block, {{block.flow_keyword.begin, rest.begin}}), block.line,
                  origin(block, frame));
    assign_block(assignment, frame);
  }

  /// The line from which a copy comes; 0 if a line of the program is executed for the first time.
  int origin(const Block& block, const Frame& frame) {
    if (frame.definition != nullptr || !frame.flows || !follows_) return frame.called_from;
    const auto index = static_cast<std::size_t>(block.text_line);
    const bool again = was_executed_[index];
    was_executed_[index] = true;
    return again ? jumped_from_ : 0;
  }

  /// Copies a block, or the body that it calls. Returns why the copy of a body cannot continue; empty if it
  /// can.
  std::string copy_block(const Block& block, Frame& frame, Span label) {
    note_moves(block);
    const auto call = may_expand(dialect_) ? call_in(text_, dialect_, block) : std::nullopt;
    if (!call) return copy_words(block, frame, label);
    const std::string why = expand(*call, block, frame);
    // A call in a body of LinuxCNC would be read differently at another place.
    if (why.empty() || (frame.definition != nullptr && dialect_.o_words)) return why;
    other_calls_ = true;
    seeks_numbers_ = seeks_numbers_ || call->name.kind == NameKind::block;
    lines_.append(whole_line(text_, block), block.line, origin(block, frame));
    expansion_.unexpanded_calls.push_back({lines_.count, why});
    frame.variables.clear();
    leave_to_linuxcnc(block);
    return {};
  }

  /// A call or a loop stays in the text.
  void leave_to_linuxcnc(const Block& block) {
    if (!dialect_.o_words) return;
    if (loops_.keeps_break)
      throw UnknownFlow{block.line, "a call is not replaced, and LinuxCNC keeps a break of a loop before it"};
    loops_.is_unknown = true;
  }

  /// A block without a call; in the body of an O-word, with the values of its expressions.
  std::string copy_words(const Block& block, Frame& frame, Span label) {
    if (may_expand(dialect_)) other_calls_ = other_calls_ || may_call(block, dialect_);
    seeks_numbers_ = seeks_numbers_ || (find_m(block, 99) != nullptr && find_letter(block, 'P') != nullptr);
    BodyLine line;
    if (frame.writes_values)
      line = line_of_body(text_, dialect_, block, frame.variables);
    else if (!empty(label))
      line.text = line_without(text_, dialect_, block, {label});
    else
      line.text = whole_line(text_, block);
    if (!line.why_not.empty()) return line.why_not;
    const int from = origin(block, frame);
    if (!line.text.empty()) lines_.append(line.text, block.line, from);
    if (const std::string why = why_never_replaced(block, dialect_); !why.empty())
      expansion_.unexpanded_calls.push_back({lines_.count, why});
    assign_block(block, frame);
    return {};
  }

  /// A subprogram may set any variable, and so may a macro that every position calls.
  void assign_block(const Block& block, Frame& frame) {
    const bool sinumerik = dialect_.sinumerik_words;
    if (block.statement == Statement::modal_call)
      calls_macro_ =
          !block.statement_is_bare && !modal_drilling_cycle(trimmed_text(part(text_, block.statement_text)));
    calls_macro_ = calls_macro_ || std::any_of(block.words.begin(), block.words.end(), [&](const Word& word) {
                     return dialect_.macro_words && word.letter == 'G' && word.literal && word.value >= 66 &&
                            word.value < 67;
                   });
    const bool calls = block.statement == Statement::call || (!sinumerik && may_call(block, dialect_));
    if (calls_macro_ || calls) frame.variables.clear();
    const bool known = empty(block.block_delete) && (sinumerik || block.statement == Statement::none);
    assign(block, text_, dialect_, known, frame.variables);
  }

  /// Replaces the call by the bodies. If this fails, restores the text and returns the reason.
  std::string expand(const SubprogramCall& call, const Block& block, Frame& caller) {
    if (!why_none_.empty()) return std::string(why_none_);
    if (!call.why_not.empty()) return call.why_not;
    if (!structures_.open.empty()) return "it is in a condition or a loop";
    const auto [definition, why, repeats, seeks_numbers] = subprograms_.find(call);
    seeks_numbers_ = seeks_numbers_ || seeks_numbers;
    if (definition == nullptr) return why;
    if (std::string deep = refuse_depth(*definition, call, block); !deep.empty()) return deep;
    const bool by_word = call.name.kind == NameKind::word;
    std::vector<double> arguments;
    if (by_word) {
      if (reads_results_) return "the program reads values returned by calls";
      const std::string unknown = evaluate_arguments(call, dialect_, caller.variables, arguments);
      if (!unknown.empty()) return unknown;
    }
    Variables own = by_word ? variables_of_body(caller.variables, arguments) : Variables{};
    Frame body{
        definition->flow, by_word ? own : caller.variables, has_flow(definition->flow), definition, by_word,
        block.line};

    const LinesMark mark = mark_of(lines_);
    const Counts before_call = counts();
    const LoopState loops_before = loops_;
    // The other words of the block are executed first.
    if (const std::string rest = line_without(text_, dialect_, block, call.dropped); !rest.empty())
      lines_.append(rest, block.line, origin(block, caller));
    std::string failed = copy_bodies(body, repeats, call, block);
    if (!follows_ && loops_.keeps_break)
      failed = "LinuxCNC keeps a break of its while loop for a loop of the program";
    if (by_word) take_globals(own, caller.variables);
    if (failed.empty()) return {};
    truncate_to(mark, lines_);
    restore(before_call);
    loops_ = loops_before;
    return failed;
  }

  struct Counts {
    std::size_t calls, executed, unexpanded_calls;
  };

  Counts counts() const {
    return {expansion_.calls, expansion_.executed, expansion_.unexpanded_calls.size()};
  }

  void restore(const Counts& counted) {
    expansion_.calls = counted.calls;
    expansion_.executed = counted.executed;
    expansion_.unexpanded_calls.resize(counted.unexpanded_calls);
  }

  std::string copy_bodies(Frame& body, long repeats, const SubprogramCall& call, const Block& block) {
    std::string failed;
    stack_.push_back(body.definition);
    try {
      for (long i = 0; i < repeats && failed.empty(); ++i) {
        count_call(call, block);
        failed = copy_body(body);
      }
    } catch (const UnknownFlow& unknown) {
      failed = unknown.why;
    }
    stack_.pop_back();
    return failed;
  }

  std::string copy_body(Frame& body) {
    Block block = before(body.definition->body);
    block.called_from = body.called_from;
    body.left = false;
    while (!body.left && next_line(text_, block)) {
      lex(text_, file_, dialect_, block);
      const bool is_return = !body.writes_values && find_m(block, 99) != nullptr && empty(block.block_delete);
      if (is_return || block.span.begin >= body.definition->end.at) break;
      if (std::string why = run_line(block, body); !why.empty()) return why;
    }
    if (!body.left) copy_last_block(block, body);
    return {};
  }

  /// Words beside M99 are executed before it returns.
  void copy_last_block(const Block& block, const Frame& body) {
    const Word* m99 = find_m(block, 99);
    const auto counts_word = [&](const Word& word) { return word.letter != 'N' && &word != m99; };
    if (m99 == nullptr || std::none_of(block.words.begin(), block.words.end(), counts_word)) return;
    note_moves(block);
    lines_.append(line_without(text_, dialect_, block, {m99->span}), block.line, body.called_from);
  }

  void note_moves(const Block& block) {
    moves_ = moves_ || std::any_of(block.words.begin(), block.words.end(),
                                   [](const Word& word) { return word.letter >= 'X' && word.letter <= 'Z'; });
  }

  /// A condition may end the recursion of a subprogram.
  std::string refuse_depth(const Definition& d, const SubprogramCall& call, const Block& block) const {
    const bool may_end = has_flow(d.flow);
    if (!may_end && std::find(stack_.begin(), stack_.end(), &d) != stack_.end())
      refuse(file_, block, call.span.begin, "the subprogram calls itself: its expansion does not end");
    if (stack_.size() < deepest_calls) return {};
    std::string why = fmt::format("calls are nested more than {} deep", deepest_calls);
    if (!may_end) refuse(file_, block, call.span.begin, why);
    return why;
  }

  void count_call(const SubprogramCall& call, const Block& block) {
    if (expansion_.calls++ == 0) expansion_.first_call = block.line;
    const std::string exceeded = exceeded_limit();
    if (exceeded.empty()) return;
    if (expansion_.executed > 0) throw UnknownFlow{block.line, exceeded};
    refuse(file_, block, call.span.begin,
           fmt::format("{}: {}; reduce the repeats, or leave out --expand-subprograms",
                       part(text_, call.span), exceeded));
  }

  std::string_view text_;
  const std::string& file_;
  const Dialect& dialect_;
  std::string_view why_none_;
  Subprograms subprograms_;
  ProgramText program_;
  ExpandedLines lines_;
  Expansion expansion_{};
  LoopState loops_{};
  bool follows_ = false;                  ///< the program itself is executed
  std::optional<UnknownFlow> unknown_{};  ///< why it is not executed
  Structures structures_{};               ///< of a program that is not executed
  std::vector<bool> was_executed_{};      ///< by lines of the program
  std::size_t run_lines_ = 0;
  int jumped_from_ = 0;
  bool calls_macro_ = false;
  std::vector<const Definition*> stack_{};  ///< bodies that are being copied
  std::vector<Span> kept_{};                ///< definitions in the program
  bool reads_results_ = false;              ///< #<_value> of LinuxCNC
  bool other_calls_ = false;                ///< a call stays that may run any definition
  bool seeks_numbers_ = false;
  bool moves_ = false;  ///< axis words occur outside of definitions
};

/// The text of a Sinumerik changes only if it is executed.
ExpandedText unexpanded(const UnknownFlow& unknown) {
  ExpandedText left;
  left.expansion.unexpanded_calls.push_back({unknown.line, unknown.why, true});
  return left;
}

}  // namespace

ExpandedText expand_text(std::string_view text, const std::string& file, const Dialect& dialect,
                         std::string_view why_none) {
  if (!why_none.empty()) return Expander(text, file, dialect, why_none).copy(std::nullopt);
  try {
    return Expander(text, file, dialect, {}).execute();
  } catch (const UnknownFlow& unknown) {
    if (!may_expand(dialect)) return unexpanded(unknown);
    // Copies repeat block numbers: a jump to one of them would reach another block.
    const bool jumps = outline_of(text, dialect).jumps;
    return Expander(text, file, dialect, jumps ? "the program jumps to block numbers" : "").copy(unknown);
  }
}

}  // namespace counterflex
