#include "program/evaluate/evaluate.hpp"

#include <algorithm>
#include <cmath>

#include "program/gcode/remarks.hpp"
#include "program/text/number_style.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr int most_digits = 4;

bool has_more_digits(double value, int decimals) {
  constexpr double rounding = 1e-6;
  const double scaled = value * power_of_ten(decimals);
  return std::abs(scaled - std::round(scaled)) > rounding;
}

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

/// Digits behind the decimal point of a value that has not too many of them.
int decimals_of(double value) {
  int decimals = 0;
  while (has_more_digits(value, decimals)) ++decimals;
  return decimals;
}

void evaluate_word(Word& word, bool relative, const Block& block, Reading& r) {
  // Sinumerik and shop controls may set the variable before or after they read it in the same block.
  const bool in_order = !r.dialect.sinumerik_words && !r.dialect.macro_words;
  if (word.literal || (!in_order && !block.assignments.empty())) return;
  const std::optional<double> value = value_in(r, word.number);
  const bool is_difference = relative || word.mode == DistanceMode::relative;
  if (!value || (is_difference && has_too_many_digits(*value))) return;
  word.literal = word.point = true;
  word.value = *value;
  word.decimals = is_difference ? decimals_of(*value) : 0;
  count_evaluated(r.program, block.line);
}

}  // namespace

bool has_too_many_digits(double value) {
  return has_more_digits(value, most_digits);
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
