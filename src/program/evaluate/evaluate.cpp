#include "program/evaluate/evaluate.hpp"

#include <algorithm>
#include <cmath>

#include "program/gcode/remarks.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

std::optional<double> value_in(const Reading& r, Span expression) {
  return value_of_word(part(r.program.text, expression), r.dialect, r.variables).value;
}

bool runs_once(const Reading& r) {
  return !r.in_body() && (r.state.displaced & modal_macro) == 0;
}

bool counts_from_position(const Block& block, const Reading& r) {
  bool relative = r.state.relative;
  for (const Word& word : block.words)
    if (word.letter == 'G' && (word.value == 90 || word.value == 91)) relative = word.value == 91;
  return relative;
}

void evaluate_word(Word& word, bool relative, const Block& block, Reading& r) {
  // Sinumerik and shop controls may set the variable before or after they read it in the same block.
  const bool in_order = !r.dialect.sinumerik_words && !r.dialect.macro_words;
  if (word.literal || (!in_order && !block.assignments.empty())) return;
  const std::optional<double> value = value_in(r, word.number);
  if (!value || ((relative || word.mode == DistanceMode::relative) && has_too_many_digits(*value))) return;
  word.literal = word.point = true;
  word.value = *value;
  word.decimals = 0;
  count_evaluated(r.program, block.line);
}

}  // namespace

bool has_too_many_digits(double value) {
  constexpr double digits = 1e4, rounding = 1e-6;
  return std::abs(value * digits - std::round(value * digits)) > rounding;
}

void count_evaluated(Program& program, int line) {
  if (++program.evaluated == 1)
    add_remark(program, line, "from here on variables and expressions are evaluated (--evaluate)");
}

void evaluate_words(Block& block, Reading& r) {
  if (!r.options.evaluate || !runs_once(r)) return;
  const bool relative = counts_from_position(block, r);
  for (Word& word : block.words) evaluate_word(word, relative, block, r);
  for (SpeedWord& word : block.speed_words) evaluate_word(word.value, false, block, r);
}

void take_assignments(const Block& block, Reading& r) {
  if (!r.options.evaluate) return;
  if ((r.state.displaced & modal_macro) != 0) return r.variables.clear();  // the macro may set any variable
  const std::string_view line = part(r.program.text, block.span);
  const bool flow = !empty(block.flow_keyword) && line.find('=') != std::string_view::npos;
  if (flow) return r.variables.clear();
  const bool known = runs_once(r) && empty(block.block_delete) && block.statement == Statement::none;
  assign(block, r.program.text, r.dialect, known, r.variables);
}

}  // namespace counterflex
