#pragma once
/// Functions, comparisons and logic of constant expressions.
#include <optional>
#include <string_view>

namespace counterflex {

/// A function of one argument. It has no value where controls differ: below zero some round and turn otherwise.
std::optional<double> value_of_function(std::string_view name, double x);

enum class Relation { equal, unequal, less, less_equal, greater, greater_equal };

/// 1 or 0. LinuxCNC (`equal_if_close`) takes values for equal that differ by less than 1e-6. There is no value where the
/// result depends on the control: on LinuxCNC whether values are equal that differ by 1e-6 to 1e-4, since versions
/// differ; on others any comparison of values that differ by less than 1e-6 and are not equal.
std::optional<double> compared(double a, Relation comparison, double b, bool equal_if_close);

/// AND, OR, XOR by their lower case names, of truth values.
double joined(bool a, std::string_view name, bool b);

}  // namespace counterflex
