#pragma once
/// Expressions whose values are known from the text alone.
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace counterflex {

/// The value of a variable. The name is in lower case without blanks: "#5", "#<depth>", "r1", "_depth". Empty
/// if the value is unknown.
using ValueOf = std::function<std::optional<double>(const std::string& name)>;

/// Spelling of expressions, and precedence of the operators of conditions.
enum class ExpressionSyntax {
  brackets,  ///< G-code: [#1 + 2], SIN[30], #<name>, #[#1 + 1], 2 ** 3, 7 MOD 2, ATAN[1]/[2]; no conditions
  linuxcnc,  ///< brackets; EQ NE GT GE LT LE have lower precedence than +, and higher than AND OR XOR
  /// Brackets, as on Fanuc; AND has the precedence of *, OR and XOR that of +, comparisons the lowest.
  macro,
  /// Sinumerik: R1 + 2 * (R2 - 1), SIN(30), R[3], 7 MOD 2, ATAN2(1, 2), == <> < > <= >= AND OR XOR NOT.
  parentheses
};

/// A value, or the reason why it is unknown.
struct ConstantValue {
  std::optional<double> value{};
  bool depends_on_rounding = false;  ///< the result of a comparison depends on the rounding of the control
};

/// The value of an expression of numbers, variables, signs, + - * / ** MOD DIV, functions (angles in
/// degrees), comparisons and logic, whose values are 1 and 0. The value is unknown for variables that
/// `value_of` does not know, for other operators and functions, for a division by zero and for an overflow. A
/// comparison of nearly equal values is unknown if controls differ, see `compared`.
ConstantValue evaluate_expression(std::string_view expression, ExpressionSyntax syntax,
                                  const ValueOf& value_of);

/// The value without the reason.
std::optional<double> constant_value(std::string_view expression, ExpressionSyntax syntax,
                                     const ValueOf& value_of);

/// The text of a value, with as many decimals as it needs, at most `decimals`.
std::string shortest_text(double value, int decimals = 6);

}  // namespace counterflex
