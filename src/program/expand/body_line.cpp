#include "program/expand/body_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr int decimals_of_variables = 12;

struct Replacement {
  Span span;
  std::string text;  ///< empty: the span is left out
};

std::string replaced(std::string_view text, const Block& block, std::vector<Replacement> replacements) {
  std::sort(replacements.begin(), replacements.end(),
            [](const Replacement& a, const Replacement& b) { return a.span.begin < b.span.begin; });
  std::string line;
  std::size_t copied = block.span.begin;
  bool left_out = false;
  for (const Replacement& one : replacements) {
    line.append(text, copied, one.span.begin - copied).append(one.text);
    copied = one.span.end;
    if (!one.text.empty()) continue;
    left_out = true;
    while (copied < block.span.end && is_blank(text[copied])) ++copied;
  }
  line.append(text, copied, block.span.end - copied);
  if (left_out) line.erase(line.find_last_not_of(" \t") + 1);
  if (left_out && line.find_first_not_of(" \t") == std::string::npos) return {};
  return line.append(part(text, block.line_end));
}

}  // namespace

BodyLine line_of_body(std::string_view text, const Dialect& dialect, const Block& block,
                      const Variables& variables) {
  std::vector<Replacement> replacements;
  for (const Word& word : block.words) {
    if (word.literal) continue;
    const auto value = value_of_word(part(text, word.number), dialect, variables).value;
    if (!value)
      return {{},
              fmt::format("{}{} in line {} of its body is not a number given by the call", word.letter,
                          part(text, word.number), block.line)};
    replacements.push_back({word.number, shortest_text(*value)});
  }
  for (const Assignment& assignment : block.assignments) {
    const std::string_view spelt = part(text, assignment.variable);
    const std::string name = variable_name(dialect, spelt);
    if (name.empty())
      return {{},
              fmt::format("{} in line {} of its body is an expression or a variable of the control", spelt,
                          block.line)};
    if (is_local(name)) {
      replacements.push_back({{assignment.variable.begin, assignment.value.end}, {}});
      continue;
    }
    const auto value = value_of_expression(part(text, assignment.value), dialect, variables).value;
    if (!value)
      return {{},
              fmt::format("the value of {} in line {} of its body is not known from the text", spelt,
                          block.line)};
    replacements.push_back({assignment.value, shortest_text(*value, decimals_of_variables)});
  }
  return {replaced(text, block, std::move(replacements)), {}};
}

}  // namespace counterflex
