#pragma once
/// Variables whose values the text shows.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/evaluate/constant_expression.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

/// Values by the names that `variable_name` gives.
using Variables = std::map<std::string, double, std::less<>>;

/// The key of the variable that `spelt` spells: "#5", "#<depth>", "r1". Empty where the name is worked out, or
/// belongs to the control: then any variable may be meant.
std::string variable_name(const Dialect& dialect, std::string_view spelt);

/// The value of an expression, or of a condition.
ConstantValue value_of_expression(std::string_view expression, const Dialect& dialect, const Variables& variables);

/// Stores what `block` assigns. With `known` false the variables become unknown. LinuxCNC reads all values of a block
/// before it assigns any. A Sinumerik assigns one after the other. On other controls the value of an assignment that
/// reads a variable of the same block is not known.
void assign(const Block& block, std::string_view text, const Dialect& dialect, bool known, Variables& variables);

/// Whether the variable belongs to a subprogram of LinuxCNC alone: #1 to #30, #<name> without an underscore.
bool is_local(std::string_view name);

/// What the body of an O-word of LinuxCNC knows when it begins: the global variables of `caller` and its arguments.
Variables variables_of_body(const Variables& caller, const std::vector<double>& arguments);

/// Takes the global variables of `body` over when it ends.
void take_globals(const Variables& body, Variables& caller);

}  // namespace counterflex
