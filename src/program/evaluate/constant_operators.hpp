#pragma once
/// Functions, comparisons and logic of constant expressions.
#include <optional>
#include <string_view>

namespace counterflex {

/// A function of one argument. Of other controls than LinuxCNC the value is empty if they differ: some round
/// negative values in another direction.
std::optional<double> value_of_function(std::string_view name, double x, bool of_linuxcnc);

/// The remainder of a / b. That of LinuxCNC is not negative. Of other controls it is empty if a or b is
/// negative: they differ.
std::optional<double> remainder_of(double a, double b, bool of_linuxcnc);

enum class Relation { equal, unequal, less, less_equal, greater, greater_equal };

/// 1 or 0. LinuxCNC (`equal_if_close`) treats values as equal that differ by less than 1e-6. The result is
/// empty if it depends on the control: on LinuxCNC for equality of values that differ by 1e-6 to 1e-4,
/// because versions differ; on other controls for any comparison of different values that differ by less than
/// 1e-6.
std::optional<double> compared(double a, Relation comparison, double b, bool equal_if_close);

/// AND, OR, XOR of truth values. The names are in lower case.
double joined(bool a, std::string_view name, bool b);

}  // namespace counterflex
