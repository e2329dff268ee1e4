#pragma once
/// Expressions whose value the text alone shows.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// The value of a variable by its name without blanks, lower case: "#5", "#<depth>", "r1", "_depth"; nothing where it is
/// not known.
using ValueOf = std::function<std::optional<double>(const std::string& name)>;

/// How expressions are spelt.
enum class ExpressionSyntax {
  brackets,    ///< G-code: [#1 + 2], SIN[30], #<name>, #[#1 + 1], 2 ** 3, 7 MOD 2, ATAN[1]/[2]
  parentheses  ///< Sinumerik: R1 + 2 * (R2 - 1), SIN(30), R[3], 7 MOD 2, ATAN2(1, 2)
};

/// The value of an expression of numbers, variables, signs, + - * / ** MOD DIV and functions (angles in degrees); nothing
/// for variables that `value_of` does not know, for other operators and functions, for division by zero and for what
/// cannot be held.
std::optional<double> constant_value(std::string_view expression, ExpressionSyntax syntax, const ValueOf& value_of);

/// In brackets, with #1, #2 ... those of `parameters`.
std::optional<double> constant_value(std::string_view expression, const std::vector<double>& parameters);

/// The text of such a value: with as many decimals as it needs, at most six.
std::string shortest_text(double value);

}  // namespace counterflex
