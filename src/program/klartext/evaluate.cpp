// Evaluates Q parameters whose values are known from the text, with ReadOptions::evaluate.
#include "program/evaluate/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <utility>

#include "program/evaluate/constant_expression.hpp"
#include "program/klartext/read.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_digits = 2;  // Q0 to Q99; the others belong to the control and to its cycles

/// Behind "Q5" at the beginning of `text`.
std::size_t end_of_parameter(std::string_view text) {
  std::size_t end = 1;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end;
}

/// "q5" of "Q5" or "Q05" at the beginning of `text` (squeezed); empty for other names.
std::string parameter_at(std::string_view text) {
  if (!text.starts_with('Q')) return {};
  const std::size_t end = end_of_parameter(text);
  std::size_t begin = 1;
  while (begin + 1 < end && text[begin] == '0') ++begin;
  const bool known = end > begin && end <= begin + most_digits;
  return known ? "q" + std::string(text.substr(begin, end - begin)) : "";
}

std::optional<double> value_of(const KlartextReading& r, std::string expression) {
  std::replace(expression.begin(), expression.end(), ',', '.');
  return constant_value(expression, ExpressionSyntax::parentheses, [&](const std::string& name) {
    const auto found = r.variables.find(name);
    return found == r.variables.end() ? std::nullopt : std::optional<double>(found->second);
  });
}

/// The values on both sides of `name` in `text`; empty if it is not there.
std::optional<std::pair<std::string, std::string>> sides_of(const std::string& text, std::string_view name) {
  const std::size_t at = text.find(name);
  if (at == std::string::npos) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + name.size()));
}

/// FN 0 to FN 8 as an expression: "+Q2-+5", "SQRT(+16)" of FN 5: Q1 = SQRT +16; empty for other functions.
std::string expression_of(int function, std::string text) {
  constexpr std::array<std::string_view, 3> of_one{"SQRT", "SIN", "COS"};  // FN 5 to FN 7
  if (const std::size_t comment = text.find(';'); comment != std::string::npos) text.erase(comment);
  if (function >= 0 && function <= 3) return text;
  if (function == 4) {
    const auto sides = sides_of(text, "DIV");
    return sides ? sides->first + "/" + sides->second : "";
  }
  if (function >= 5 && function <= 7) {
    const std::string_view name = of_one[static_cast<std::size_t>(function - 5)];
    return text.starts_with(name) ? fmt::format("{}({})", name, text.substr(name.size())) : "";
  }
  const auto sides = function == 8 ? sides_of(text, "LEN") : std::nullopt;
  return sides ? fmt::format("SQRT(({0})*({0})+({1})*({1}))", sides->first, sides->second) : "";
}

void forget_all_in(std::string_view text, KlartextReading& r) {
  for (std::size_t at = 0; at < text.size(); ++at)
    if (const std::string name = parameter_at(text.substr(at)); !name.empty()) r.variables.erase(name);
}

/// FN 23 and FN 24 (circle data) set the parameter and the two after it.
void forget_results(int function, const std::string& name, KlartextReading& r) {
  const int first = std::atoi(name.c_str() + 1), count = function == 23 || function == 24 ? 3 : 1;
  for (int i = 0; i < count; ++i) r.variables.erase(fmt::format("q{}", first + i));
}

/// A difference with too many digits gives an unknown position. "DR", "M" and "R" are not positions.
bool can_be_evaluated(const KlartextWord& word, double value) {
  const std::string_view places = "X Y Z CX CY PR PA F R";
  const bool place = places.find(word.key) != std::string_view::npos;
  return place && !(word.incremental && has_too_many_digits(value));
}

}  // namespace

bool read_words(const KlartextBlock& block, KlartextReading& r) {
  if (!lex_klartext_words(r.program.text, r.program.file, block, r.words)) return false;
  if (!r.options.evaluate || may_skip_or_repeat(r)) return true;
  for (KlartextWord& word : r.words) {
    if (word.literal || word.key.empty()) continue;
    const std::size_t begin = word.span.begin + word.key.size() + (word.incremental ? 1 : 0);
    const std::string expression = squeezed(part(r.program.text, {begin, word.span.end}));
    if (expression.find('Q') == std::string::npos) continue;
    const std::optional<double> value = value_of(r, expression);
    if (!value || !can_be_evaluated(word, *value)) continue;
    word.literal = true;
    word.value = *value;
    word.number = {begin, word.span.end};
    count_evaluated(r.program, block.line);
  }
  return true;
}

std::optional<double> klartext_value(const KlartextBlock& block, KlartextReading& r,
                                     std::string_view squeezed_text) {
  const bool expression = squeezed_text.find('Q') != std::string_view::npos;
  if (expression && (!r.options.evaluate || may_skip_or_repeat(r))) return std::nullopt;
  const std::optional<double> value = value_of(r, std::string(squeezed_text));
  if (expression && value) count_evaluated(r.program, block.line);
  return value;
}

void take_parameter(const KlartextBlock& block, KlartextReading& r) {
  if (!r.options.evaluate) return;
  std::string text = block.head == "Q" ? "Q" : "";
  text += squeezed(after_head(r.program.text, block));
  int function = 0;  // "Q1 = 5" is FN 0
  if (block.head == "FN") {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), function);
    const std::size_t colon = static_cast<std::size_t>(end - text.data());
    if (error != std::errc{} || colon >= text.size() || text[colon] != ':') return forget_all_in(text, r);
    text.erase(0, colon + 1);
  }
  const std::string name = parameter_at(text);
  const std::size_t equals = end_of_parameter(text);
  const bool assigns = !name.empty() && equals < text.size() && text[equals] == '=';
  if (function == 28) return r.variables.clear();  // TABREAD sets a parameter for each column
  if (!assigns) return forget_all_in(text, r);
  const bool runs_once = !may_skip_or_repeat(r) && empty(block.block_delete) && block.parts.size() == 1;
  const std::string expression = runs_once ? expression_of(function, text.substr(equals + 1)) : "";
  const std::optional<double> value = expression.empty() ? std::nullopt : value_of(r, expression);
  forget_results(function, name, r);
  if (value) r.variables[name] = *value;
}

}  // namespace counterflex
