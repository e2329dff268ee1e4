#pragma once
/// Expressions whose value the text alone shows.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// The value of numbers, #1, #2 ... (those of `parameters`), brackets, signs and + - * /; nothing for other
/// variables and functions, for division by zero and for what cannot be held.
std::optional<double> constant_value(std::string_view expression, const std::vector<double>& parameters);

/// The text of such a value: with as many decimals as it needs, at most six.
std::string shortest_text(double value);

}  // namespace counterflex
