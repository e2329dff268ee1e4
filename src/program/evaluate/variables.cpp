#include "program/evaluate/variables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "counterflex/files/text.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t highest_variable = 999;  // the highest variable without a meaning for the control
constexpr double highest_local = 30;

std::string normal(std::string_view name) {
  std::string text;
  for (const char c : name)
    if (!is_blank(c)) text += lower(c);
  return text;
}

ExpressionSyntax syntax_of(const Dialect& dialect) {
  if (dialect.sinumerik_words) return ExpressionSyntax::parentheses;
  if (dialect.o_words) return ExpressionSyntax::linuxcnc;
  return dialect.macro_words ? ExpressionSyntax::macro : ExpressionSyntax::brackets;
}

VariableType type_named(std::string_view name) {
  if (is_word(name, "REAL")) return VariableType::real;
  if (is_word(name, "INT")) return VariableType::integer;
  return is_word(name, "BOOL") ? VariableType::truth : VariableType::other;
}

/// R parameters and variables of other controls are real. Empty: a variable of a Sinumerik without DEF.
std::optional<VariableType> type_of(const Variables& variables, std::string_view name) {
  const bool parameter =
      name.size() > 1 && name[0] == 'r' && name.find_first_not_of("0123456789", 1) == std::string_view::npos;
  if (name.starts_with('#') || parameter) return VariableType::real;
  const auto found = variables.types.find(name);
  return found == variables.types.end() ? std::nullopt : std::optional(found->second);
}

/// Halves are rounded up above zero; where the value is near a half by rounding, or below zero, the result is
/// not certain.
std::optional<double> as_integer(double value) {
  constexpr double margin = 1e-6, largest = 2147483647;
  const double whole = std::round(value), from_half = std::abs(std::abs(value - std::trunc(value)) - 0.5);
  const bool certain = from_half > margin || (from_half == 0 && value > 0);
  return certain && std::abs(whole) <= largest ? std::optional(whole) : std::nullopt;
}

std::optional<double> as_truth(double value) {
  constexpr double margin = 1e-6;
  const bool certain = value == 0 || std::abs(value) > margin;
  return certain ? std::optional(value != 0 ? 1.0 : 0.0) : std::nullopt;
}

/// "r[5]" is "r5".
std::string without_index(const std::string& name) {
  if (!name.starts_with("r[") || name.back() != ']') return name;
  const std::string index = name.substr(2, name.size() - 3);
  const bool plain = !index.empty() && index.find_first_not_of("0123456789") == std::string::npos;
  return plain ? fmt::format("r{}", index) : name;
}

}  // namespace

void store(Variables& variables, const std::string& name, std::optional<double> value) {
  if (name.empty()) return;
  const auto type = type_of(variables, name);
  if (value && !type && *value != std::round(*value)) value.reset();
  if (value && type == VariableType::integer) value = as_integer(*value);
  if (value && type == VariableType::truth) value = as_truth(*value);
  if (!value || type == VariableType::other)
    variables.values.erase(name);
  else
    variables.values[name] = *value;
}

std::string variable_name(const Dialect& dialect, std::string_view spelt) {
  const std::string name = without_index(normal(spelt));
  const std::size_t digits = name.find_first_of("0123456789");
  const bool numbered = name.size() > 1 && (name[0] == '#' || name[0] == 'r') && digits == 1;
  if (numbered && name.find_first_not_of("0123456789", 1) == std::string::npos)
    return name.size() <= 4 && std::stoul(name.substr(1)) <= highest_variable && name[1] != '0' ? name : "";
  const bool named =
      name.starts_with("#<") || (dialect.sinumerik_words && name.find('[') == std::string::npos);
  return named ? name : "";
}

ConstantValue value_of_expression(std::string_view expression, const Dialect& dialect,
                                  const Variables& variables) {
  return evaluate_expression(expression, syntax_of(dialect), [&](const std::string& name) {
    const auto found = variables.values.find(name);
    return found == variables.values.end() ? std::nullopt : std::optional<double>(found->second);
  });
}

ConstantValue value_of_word(std::string_view expression, const Dialect& dialect, const Variables& variables) {
  const bool rounds = dialect.macro_words && normal(expression).find("rou") != std::string::npos;
  return rounds ? ConstantValue{} : value_of_expression(expression, dialect, variables);
}

void assign(const Block& block, std::string_view text, const Dialect& dialect, bool known,
            Variables& variables) {
  std::vector<std::pair<std::string, std::optional<double>>> assigned;
  for (const Assignment& assignment : block.assignments) {
    const std::string name = variable_name(dialect, part(text, assignment.variable));
    const auto value =
        known ? value_of_expression(part(text, assignment.value), dialect, variables).value : std::nullopt;
    if (!empty(assignment.type)) variables.types[name] = type_named(part(text, assignment.type));
    assigned.emplace_back(name, value);
    if (dialect.o_words) continue;
    if (name.empty()) variables.clear();
    store(variables, name, dialect.sinumerik_words ? value : std::nullopt);
  }
  for (const auto& [name, value] : assigned) {
    if (name.empty()) variables.clear();  // the block may set any variable
    store(variables, name, value);
  }
}

bool is_local(std::string_view name) {
  if (name.starts_with("#<")) return !name.starts_with("#<_");
  const auto number = name.starts_with('#') ? read_number(name.substr(1)) : std::nullopt;
  return number && *number <= highest_local;
}

Variables variables_of_body(const Variables& caller, const std::vector<double>& arguments) {
  Variables body;
  take_globals(caller, body);
  for (std::size_t i = 0; i < arguments.size(); ++i) body.values[fmt::format("#{}", i + 1)] = arguments[i];
  return body;
}

void take_globals(const Variables& body, Variables& caller) {
  std::erase_if(caller.values, [](const auto& variable) { return !is_local(variable.first); });
  for (const auto& variable : body.values)
    if (!is_local(variable.first)) caller.values.insert(variable);
}

}  // namespace counterflex
