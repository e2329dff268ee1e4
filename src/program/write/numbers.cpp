#include "program/write/numbers.hpp"

#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

/// The changed numbers of a block, in the order of the text; they point into the step and the cycle's words.
struct NumberChanges {
  struct One {
    std::size_t begin, end;
    const WordNumber* to;
  };
  std::array<One, 8> list;
  std::size_t count = 0;
  bool words_missing = false;

  void add(const PackedAxisWord& word, const WordNumber& number) {
    if (!number.write) return;
    if (!word) {
      words_missing = true;
      return;
    }
    const Span span = word->number;
    std::size_t i = count++;
    for (; i > 0 && list[i - 1].begin > span.begin; --i) list[i] = list[i - 1];
    list[i] = {span.begin, span.end, &number};
  }
};

NumberChanges number_changes(const Move& move, const Step& step, const CycleWords& cycle) {
  NumberChanges changes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    changes.add(move.words[axis], step.axes[axis].number);
    if (step.arc) changes.add(move.arc->centre_words[axis], step.arc->centre[axis]);
  }
  if (step.arc) changes.add(move.arc->radius_word, step.arc->radius);
  if (!move.cycle) return changes;
  changes.add(move.cycle->bottom_word, cycle.bottom);
  changes.add(move.cycle->retract_word, cycle.retract);
  return changes;
}

}  // namespace

bool append_with_numbers(const Program& program, const Move& move, const Step& step, const CycleWords& cycle,
                         std::size_t line_limit, Rewritten& out) {
  const NumberChanges changes = number_changes(move, step, cycle);
  if (changes.words_missing) return false;
  const std::size_t line = out.text.size();
  std::size_t at = move.block.begin;
  for (std::size_t i = 0; i < changes.count; ++i) {
    const auto& [begin, end, to] = changes.list[i];
    out.text.append(program.text, at, begin - at);
    append_changed_number(part(program.text, {begin, end}), to->value, to->decimals, out.text);
    at = end;
  }
  out.text.append(program.text, at, move.block.end - at);
  if (line_limit > 0 && out.text.size() - line > line_limit) {
    out.text.resize(line);
    return false;
  }
  out.changed_words += changes.count;
  return true;
}

}  // namespace counterflex
