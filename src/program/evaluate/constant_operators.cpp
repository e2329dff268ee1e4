#include "program/evaluate/constant_operators.hpp"

#include <cmath>
#include <limits>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double closeness = 1e-6;
constexpr double widest_closeness = 1.001e-4;  // of LinuxCNC 2.9; 1e-6 in its manual

/// ROUND of LinuxCNC adds a half and truncates to an int.
std::optional<double> rounded_by_linuxcnc(double x) {
  const double sum = x + (x < 0 ? -0.5 : 0.5);
  if (!(std::abs(sum) < std::numeric_limits<int>::max())) return std::nullopt;
  return static_cast<int>(sum);
}

}  // namespace

std::optional<double> value_of_function(std::string_view name, double x, bool of_linuxcnc) {
  const bool differs = name == "round" || name == "fix" || name == "fup" || name == "asin" || name == "atan";
  if (differs && x < 0 && !of_linuxcnc) return std::nullopt;
  if (name == "round" && of_linuxcnc) return rounded_by_linuxcnc(x);
  if (name == "sin") return std::sin(x * deg);
  if (name == "cos") return std::cos(x * deg);
  if (name == "tan") return std::tan(x * deg);
  if (name == "asin") return std::asin(x) / deg;
  if (name == "acos") return std::acos(x) / deg;
  if (name == "atan") return std::atan(x) / deg;
  if (name == "sqrt") return std::sqrt(x);
  if (name == "abs") return std::abs(x);
  if (name == "exp") return std::exp(x);
  if (name == "ln") return std::log(x);
  if (name == "round") return std::round(x);
  if (name == "fix") return std::floor(x);
  if (name == "fup") return std::ceil(x);
  if (name == "trunc") return std::trunc(x);
  if (name == "pot") return x * x;
  return std::nullopt;
}

std::optional<double> remainder_of(double a, double b, bool of_linuxcnc) {
  if ((a < 0 || b < 0) && !of_linuxcnc) return std::nullopt;
  const double remainder = std::fmod(a, b);
  return remainder < 0 ? remainder + std::abs(b) : remainder;
}

std::optional<double> compared(double a, Relation comparison, double b, bool equal_if_close) {
  const double difference = std::abs(a - b);
  const bool tests_equality = comparison == Relation::equal || comparison == Relation::unequal;
  const bool close = difference < closeness;
  if (!equal_if_close && close && a != b) return std::nullopt;
  if (equal_if_close && tests_equality && !close && difference < widest_closeness) return std::nullopt;
  const bool equal = a == b || (equal_if_close && close);
  switch (comparison) {
    case Relation::equal:
      return equal;
    case Relation::unequal:
      return !equal;
    case Relation::less:
      return a < b;
    case Relation::less_equal:
      return a <= b;
    case Relation::greater:
      return a > b;
    case Relation::greater_equal:
      return a >= b;
  }
  return std::nullopt;
}

double joined(bool a, std::string_view name, bool b) {
  if (name == "and") return a && b;
  return name == "or" ? a || b : a != b;
}

}  // namespace counterflex
