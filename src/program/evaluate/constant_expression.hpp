#pragma once
/// Expressions whose value the text alone shows.
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace counterflex {

/// The value of a variable by its name without blanks, lower case: "#5", "#<depth>", "r1", "_depth"; nothing where it is
/// not known.
using ValueOf = std::function<std::optional<double>(const std::string& name)>;

/// How expressions are spelt, and how the operators of conditions bind.
enum class ExpressionSyntax {
  brackets,    ///< G-code: [#1 + 2], SIN[30], #<name>, #[#1 + 1], 2 ** 3, 7 MOD 2, ATAN[1]/[2]; no conditions
  linuxcnc,    ///< brackets; EQ NE GT GE LT LE bind looser than +, and tighter than AND OR XOR
  macro,       ///< brackets, as Fanuc has them; AND binds as *, OR and XOR as +, comparisons last
  parentheses  ///< Sinumerik: R1 + 2 * (R2 - 1), SIN(30), R[3], 7 MOD 2, ATAN2(1, 2), == <> < > <= >= AND OR XOR NOT
};

/// A value, or why it is unknown.
struct ConstantValue {
  std::optional<double> value{};
  bool depends_on_rounding = false;  ///< a comparison has a result that depends on how the control rounds
};

/// The value of an expression of numbers, variables, signs, + - * / ** MOD DIV, functions (angles in degrees),
/// comparisons and logic, whose values are 1 and 0. It is unknown for variables that `value_of` does not know, for other
/// operators and functions, for division by zero and for what cannot be held. Comparisons of
/// nearly equal values have none where controls differ: see `compared`.
ConstantValue evaluate_expression(std::string_view expression, ExpressionSyntax syntax, const ValueOf& value_of);

/// The same, without the reason.
std::optional<double> constant_value(std::string_view expression, ExpressionSyntax syntax, const ValueOf& value_of);

/// The text of such a value: with as many decimals as it needs, at most `decimals`.
std::string shortest_text(double value, int decimals = 6);

}  // namespace counterflex
