#include "program/expand/expand.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/expand/text.hpp"
#include "program/gcode/remarks.hpp"
#include "program/klartext/lex.hpp"

namespace counterflex {
namespace {

/// The run of lines of `text_line`; null if nothing was expanded.
const LineRun* run_of(const Expansion& expansion, int text_line) {
  const auto& runs = expansion.lines;
  const auto behind = std::upper_bound(runs.begin(), runs.end(), text_line,
                                       [](int line, const LineRun& run) { return line < run.text_line; });
  return behind == runs.begin() ? nullptr : &*std::prev(behind);
}

}  // namespace

bool may_expand(const Dialect& dialect) {
  return (dialect.family & (shop_families | mach3_family | linuxcnc_family)) != 0 &&
         dialect.name != klartext_name;
}

bool may_execute(const Dialect& dialect) {
  return dialect.sinumerik_words || dialect.o_words || dialect.macro_words;
}

Expansion expand_subprograms(std::string& text, const std::string& file, const Dialect& dialect) {
  if (!may_execute(dialect) && !may_expand(dialect)) return {};
  ExpandedText expanded = expand_text(text, file, dialect, "");
  const auto replaced = [&] { return expanded.expansion.calls > 0 || expanded.expansion.executed > 0; };
  if (expanded.seeks_numbers && replaced())
    expanded = expand_text(text, file, dialect,
                           "M97 or M99 with P searches a block number, which copies would repeat");
  if (replaced())
    text = std::move(expanded.text);
  else
    expanded.expansion.lines.clear();
  return std::move(expanded.expansion);
}

std::string limit_exceeded(const ExpandedSize& expanded, const ExpandedSize& original) {
  if (expanded.lines > original.lines + most_added_lines)
    return fmt::format("the expansion adds more than {} lines", most_added_lines);
  if (expanded.bytes > original.bytes + most_added_bytes)
    return fmt::format("the expansion adds more than {} bytes", most_added_bytes);
  if (expanded.calls > original.calls + most_expanded_calls)
    return fmt::format("the expansion has more than {} calls", most_expanded_calls);
  return {};
}

int line_of_file(const Expansion& expansion, int text_line) {
  const LineRun* run = run_of(expansion, text_line);
  return run == nullptr ? text_line : run->line + (text_line - run->text_line);
}

void place_in_file(const Expansion& expansion, Block& block) {
  const LineRun* run = run_of(expansion, block.text_line);
  if (run == nullptr) return;
  block.line = run->line + (block.text_line - run->text_line);
  block.called_from = run->called_from;
}

bool is_unused(const Expansion& expansion, std::size_t at) {
  const auto& unused = expansion.unused;
  const auto behind = std::upper_bound(unused.begin(), unused.end(), at,
                                       [](std::size_t place, Span span) { return place < span.begin; });
  return behind != unused.begin() && at < std::prev(behind)->end;
}

void add_unused(Span definition, Expansion& expansion) {
  auto& unused = expansion.unused;
  const auto behind = std::upper_bound(unused.begin(), unused.end(), definition.begin,
                                       [](std::size_t place, Span span) { return place < span.begin; });
  unused.insert(behind, definition);
}

std::string_view why_not_expanded(const Expansion& expansion, int text_line) {
  const auto& calls = expansion.unexpanded_calls;
  const auto call = std::lower_bound(calls.begin(), calls.end(), text_line,
                                     [](const UnexpandedCall& c, int line) { return c.text_line < line; });
  return call != calls.end() && call->text_line == text_line ? std::string_view(call->why)
                                                             : std::string_view();
}

namespace {

/// Adds remarks on executed lines, or on the reason why they were not executed. False if nothing was to be
/// executed.
bool remark_execution(Program& program) {
  const Expansion& expansion = program.expansion;
  if (expansion.executed > 0)
    add_remark(
        program, expansion.first_executed,
        fmt::format(
            "loops, conditions and jumps are replaced by the blocks that they execute, {} of them; this "
            "is the first",
            expansion.executed));
  const auto& left = expansion.unexpanded_calls;
  const auto flow =
      std::find_if(left.begin(), left.end(), [](const UnexpandedCall& one) { return one.is_flow; });
  if (flow != left.end())
    add_remark(program, line_of_file(expansion, flow->text_line),
               "loops, conditions and jumps are not executed: " + flow->why);
  return expansion.executed > 0 || flow != left.end();
}

}  // namespace

void remark_expansion(Program& program) {
  const bool sinumerik = find_dialect(program.dialect)->sinumerik_words;
  const bool flow = remark_execution(program);
  const Expansion& expansion = program.expansion;
  if (expansion.calls > 0)
    return add_remark(
        program, expansion.first_call,
        fmt::format("{} of subprograms replaced by the bodies; this is the first",
                    expansion.calls == 1 ? "one call" : fmt::format("{} calls", expansion.calls)));
  if (flow || !expansion.unexpanded_calls.empty()) return;
  add_remark(program, 1,
             sinumerik
                 ? "the program has no loop, condition or jump: nothing is expanded"
                 : "the program itself has no call by M98 or an O-word and no CALL LBL: nothing is expanded");
}

}  // namespace counterflex
