#include "program/evaluate/variables.hpp"

#include <fmt/format.h>

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
    if (!is_blank(c)) text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

ExpressionSyntax syntax_of(const Dialect& dialect) {
  if (dialect.sinumerik_words) return ExpressionSyntax::parentheses;
  if (dialect.o_words) return ExpressionSyntax::linuxcnc;
  return dialect.macro_words ? ExpressionSyntax::macro : ExpressionSyntax::brackets;
}

}  // namespace

std::string variable_name(const Dialect& dialect, std::string_view spelt) {
  std::string name = normal(spelt);
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
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional<double>(found->second);
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
    assigned.emplace_back(name, value);
    if (dialect.o_words) continue;
    if (name.empty()) variables.clear();
    variables.erase(name);
    if (dialect.sinumerik_words && value && !name.empty()) variables[name] = *value;
  }
  for (const auto& [name, value] : assigned) {
    if (name.empty()) variables.clear();  // the block may set any variable
    variables.erase(name);
    if (value && !name.empty()) variables[name] = *value;
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
  for (std::size_t i = 0; i < arguments.size(); ++i) body[fmt::format("#{}", i + 1)] = arguments[i];
  return body;
}

void take_globals(const Variables& body, Variables& caller) {
  std::erase_if(caller, [](const auto& variable) { return !is_local(variable.first); });
  for (const auto& variable : body)
    if (!is_local(variable.first)) caller.insert(variable);
}

}  // namespace counterflex
