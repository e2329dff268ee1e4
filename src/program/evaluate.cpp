#include "program/evaluate.hpp"

#include <algorithm>
#include <cmath>

#include "program/constant_expression.hpp"
#include "program/remarks.hpp"
#include "program/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t highest_variable = 999;  // of those that mean nothing to the control

std::string normal(std::string_view name) {
  std::string text;
  for (const char c : name)
    if (!is_blank(c)) text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::optional<double> value_in(const Reading& r, Span expression) {
  const auto syntax = r.dialect.sinumerik_words ? ExpressionSyntax::parentheses : ExpressionSyntax::brackets;
  return constant_value(part(r.program.text, expression), syntax, [&](const std::string& name) {
    const auto found = r.variables.find(name);
    return found == r.variables.end() ? std::nullopt : std::optional<double>(found->second);
  });
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

}  // namespace

std::string variable_name(const Dialect& dialect, std::string_view spelt) {
  std::string name = normal(spelt);
  const std::size_t digits = name.find_first_of("0123456789");
  const bool numbered = name.size() > 1 && (name[0] == '#' || name[0] == 'r') && digits == 1;
  if (numbered && name.find_first_not_of("0123456789", 1) == std::string::npos)
    return name.size() <= 4 && std::stoul(name.substr(1)) <= highest_variable && name[1] != '0' ? name : "";
  const bool named = name.starts_with("#<") || (dialect.sinumerik_words && name.find('[') == std::string::npos);
  return named ? name : "";
}

bool has_too_many_digits(double value) {
  constexpr double digits = 1e4, rounding = 1e-6;
  return std::abs(value * digits - std::round(value * digits)) > rounding;
}

void note_worked_out(Program& program, int line) {
  if (++program.evaluated == 1)
    add_remark(program, line, "from here on variables and expressions are worked out (--evaluate)");
}

void evaluate_words(Block& block, Reading& r) {
  if (!r.options.evaluate || !runs_once(r)) return;
  const bool relative = counts_from_position(block, r);
  for (Word& word : block.words) {
    // A Sinumerik may set the variable before or after it is used in the same block.
    if (word.literal || (r.dialect.sinumerik_words && !block.assignments.empty())) continue;
    const std::optional<double> value = value_in(r, word.number);
    if (!value || ((relative || word.sense == Sense::relative) && has_too_many_digits(*value))) continue;
    word.literal = word.point = true;
    word.value = *value;
    word.decimals = 0;
    note_worked_out(r.program, block.line);
  }
}

void take_assignments(const Block& block, Reading& r) {
  if (!r.options.evaluate) return;
  const std::string_view line = part(r.program.text, block.span);
  const bool flow = !empty(block.flow_keyword) && line.find('=') != std::string_view::npos;
  if (flow) return r.variables.clear();
  for (const Assignment& assignment : block.assignments) {
    const std::string name = variable_name(r.dialect, part(r.program.text, assignment.variable));
    if (name.empty()) {
      r.variables.clear();  // any may have been set
      continue;
    }
    const bool shown = runs_once(r) && empty(block.block_delete) && block.statement == Statement::none;
    const std::optional<double> value = shown ? value_in(r, assignment.value) : std::nullopt;
    if (value)
      r.variables[name] = *value;
    else
      r.variables.erase(name);
  }
}

}  // namespace counterflex
