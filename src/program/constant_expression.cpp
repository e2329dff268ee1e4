#include "program/constant_expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "counterflex/files/numbers.hpp"
#include "counterflex/geometry/units.hpp"
#include "program/scanner.hpp"

namespace counterflex {
namespace {

using Value = std::optional<double>;

/// A function of one argument; none where it has no value there, or where controls differ: below zero some
/// round and turn otherwise.
Value value_of_function(std::string_view name, double x) {
  const bool differs = name == "round" || name == "fix" || name == "fup" || name == "asin" || name == "atan";
  if (differs && x < 0) return std::nullopt;
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

/// Reads sums of products of powers of factors, as LinuxCNC does, from text without blanks in lower case.
class Evaluation {
 public:
  Evaluation(std::string text, ExpressionSyntax syntax, const ValueOf& value_of)
      : text_(std::move(text)),
        open_(syntax == ExpressionSyntax::brackets ? '[' : '('),
        close_(syntax == ExpressionSyntax::brackets ? ']' : ')'),
        value_of_(value_of) {}

  Value run() {
    const Value value = sum();
    return at_ == text_.size() ? value : std::nullopt;
  }

 private:
  static constexpr int deepest = 100;

  bool has_brackets() const { return open_ == '['; }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(std::string_view what) {
    if (std::string_view(text_).substr(at_, what.size()) != what) return false;
    at_ += what.size();
    return true;
  }

  Value sum() {
    Value value = product();
    while (value && (peek() == '+' || peek() == '-')) {
      const bool plus = text_[at_++] == '+';
      const Value other = product();
      value = other ? Value(plus ? *value + *other : *value - *other) : std::nullopt;
    }
    return value;
  }

  Value product() {
    Value value = power();
    while (value) {
      const bool times = peek() == '*', over = peek() == '/', divides = !has_brackets() && take("div");
      const bool modulo = !times && !over && !divides && take("mod");
      if (!times && !over && !divides && !modulo) return value;
      if (times || over) ++at_;
      const Value other = power();
      if (!other || (!times && *other == 0)) return std::nullopt;
      if (modulo && (*value < 0 || *other < 0)) return std::nullopt;  // controls differ
      value = times ? *value * *other : modulo ? std::fmod(*value, *other) : *value / *other;
      if (divides) value = std::trunc(*value);
    }
    return value;
  }

  Value power() {
    Value value = factor();
    while (value && take("**")) {
      const Value other = factor();
      value = other ? Value(std::pow(*value, *other)) : std::nullopt;
    }
    return value;
  }

  Value factor() {
    if (take("-")) {
      const Value value = primary();
      return value ? Value(-*value) : std::nullopt;
    }
    take("+");
    return primary();
  }

  Value primary() {
    if (has_brackets() && take("#")) return numbered("#");
    if (peek() == open_) return bracket();
    return is_letter(peek()) || peek() == '_' ? named() : number();
  }

  Value bracket() { return up_to(close_); }

  /// The sum behind the bracket that stands here, which `close` ends.
  Value up_to(char close) {
    ++at_;
    if (++depth_ > deepest) return std::nullopt;
    const Value value = sum();
    --depth_;
    return take(std::string_view(&close, 1)) ? value : std::nullopt;
  }

  /// "#5", "#[#1+1]", "##2", "#<name>", behind `sign`.
  Value numbered(std::string sign) {
    if (peek() == '<') {
      const std::size_t close = text_.find('>', at_);
      if (close == std::string::npos) return std::nullopt;
      const std::string name = sign + text_.substr(at_, close + 1 - at_);
      at_ = close + 1;
      return value_of_(name);
    }
    Value index;
    if (take("#"))
      index = ++depth_ > deepest ? std::nullopt : numbered("#");
    else
      index = peek() == '[' ? up_to(']') : is_digit(peek()) ? number() : std::nullopt;
    if (!index || *index < 0 || *index > 1e6 || *index != std::floor(*index)) return std::nullopt;
    return value_of_(sign + std::to_string(static_cast<long>(*index)));
  }

  /// A function with its argument; on a Sinumerik also R5, R[5] and variables by name.
  Value named() {
    std::size_t end = at_;
    while (end < text_.size() &&
           (is_letter(text_[end]) || text_[end] == '_' || (!has_brackets() && is_digit(text_[end]))))
      ++end;
    const std::string name = text_.substr(at_, end - at_);
    at_ = end;
    if (!has_brackets() && name == "r" && peek() == '[') return numbered("r");
    if (!has_brackets() && name == "atan2" && peek() == open_) return atan_of_two();
    if (peek() != open_) return has_brackets() ? std::nullopt : value_of_(name);
    const Value argument = bracket();
    if (!argument) return std::nullopt;
    if (has_brackets() && name == "atan" && take("/")) {
      const Value second = peek() == open_ ? bracket() : std::nullopt;
      return second && *argument >= 0 ? Value(std::atan2(*argument, *second) / deg) : std::nullopt;
    }
    return value_of_function(name, *argument);
  }

  Value atan_of_two() {
    ++at_;
    const Value first = sum();
    if (!first || !take(",")) return std::nullopt;
    const Value second = sum();
    return second && take(")") ? Value(std::atan2(*first, *second) / deg) : std::nullopt;
  }

  Value number() {
    const std::size_t begin = at_;
    while (is_digit(peek()) || peek() == '.') ++at_;
    return read_number(std::string_view(text_).substr(begin, at_ - begin));
  }

  const std::string text_;
  const char open_, close_;
  const ValueOf& value_of_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<double> constant_value(std::string_view expression, ExpressionSyntax syntax,
                                     const ValueOf& value_of) {
  constexpr double beyond = 1e9;
  std::string dense;
  for (const char c : expression)
    if (!is_blank(c)) dense += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const Value value = Evaluation(std::move(dense), syntax, value_of).run();
  return value && std::abs(*value) < beyond ? value : std::nullopt;
}

std::optional<double> constant_value(std::string_view expression, const std::vector<double>& parameters) {
  return constant_value(expression, ExpressionSyntax::brackets, [&](const std::string& name) -> Value {
    const Value index = read_number(std::string_view(name).substr(1));
    if (!index || *index < 1 || *index > static_cast<double>(parameters.size())) return std::nullopt;
    return parameters[static_cast<std::size_t>(*index) - 1];
  });
}

std::string shortest_text(double value) {
  std::string text = format_fixed(value, 6);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace counterflex
