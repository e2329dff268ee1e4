#pragma once
/// Variables whose values are known from the text.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/evaluate/constant_expression.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

/// Type of a variable of a Sinumerik. INT rounds the values that it is assigned, BOOL makes them 0 or 1.
enum class VariableType { real, integer, truth, other };

/// By name, as returned by `variable_name`.
struct Variables {
  std::map<std::string, double, std::less<>> values{};
  std::map<std::string, VariableType, std::less<>> types{};  ///< by DEF

  void clear() { values.clear(); }
};

/// Sets the value, as a variable of its type takes it. It becomes unknown if that is not certain: halves
/// below zero, or a fraction for a variable of a Sinumerik without DEF.
void store(Variables& variables, const std::string& name, std::optional<double> value);

/// The name of the variable `spelt`: "#5", "#<depth>", "r1". Empty if the name is an expression or belongs to
/// the control; then any variable may be meant.
std::string variable_name(const Dialect& dialect, std::string_view spelt);

/// The value of an expression, or of a condition.
ConstantValue value_of_expression(std::string_view expression, const Dialect& dialect,
                                  const Variables& variables);

/// The value of the expression of a word. ROUND of shop controls gives the least increment there, which
/// depends on the axis and the machine: it is unknown.
ConstantValue value_of_word(std::string_view expression, const Dialect& dialect, const Variables& variables);

/// Stores the assignments of `block`. If `known` is false the variables become unknown. LinuxCNC reads all
/// values of a block before it assigns any. A Sinumerik assigns one after the other. On other controls an
/// assignment that reads a variable of the same block has an unknown value.
void assign(const Block& block, std::string_view text, const Dialect& dialect, bool known,
            Variables& variables);

/// Whether the variable is local to a subprogram of LinuxCNC: #1 to #30, #<name> without an underscore.
bool is_local(std::string_view name);

/// The known variables at the begin of the body of a LinuxCNC O-word: the global variables of `caller` and
/// the arguments.
Variables variables_of_body(const Variables& caller, const std::vector<double>& arguments);

/// Copies the global variables of `body` to the caller when the body ends.
void take_globals(const Variables& body, Variables& caller);

}  // namespace counterflex
