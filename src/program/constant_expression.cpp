#include "program/constant_expression.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "counterflex/files/numbers.hpp"
#include "program/scanner.hpp"

namespace counterflex {
namespace {

using Value = std::optional<double>;

/// Reads sums of products of factors, as LinuxCNC does.
class Evaluation {
 public:
  Evaluation(std::string text, const std::vector<double>& parameters)
      : text_(std::move(text)), parameters_(parameters) {}

  Value run() {
    const Value value = sum();
    return at_ == text_.size() ? value : std::nullopt;
  }

 private:
  static constexpr int deepest = 100;

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
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
    Value value = factor();
    while (value && (peek() == '*' || peek() == '/')) {
      const bool times = text_[at_++] == '*';
      const Value other = factor();
      if (!other || (!times && *other == 0)) return std::nullopt;
      value = times ? *value * *other : *value / *other;
    }
    return value;
  }

  Value factor() {
    if (take('-')) {
      const Value value = primary();
      return value ? Value(-*value) : std::nullopt;
    }
    take('+');
    return primary();
  }

  Value primary() {
    if (take('#')) return parameter();
    if (!take('[')) return number();
    if (++depth_ > deepest) return std::nullopt;
    const Value value = sum();
    --depth_;
    return take(']') ? value : std::nullopt;
  }

  Value parameter() {
    const Value index = is_digit(peek()) ? number() : std::nullopt;
    if (!index || *index < 1 || *index > static_cast<double>(parameters_.size()) ||
        *index != std::floor(*index))
      return std::nullopt;
    return parameters_[static_cast<std::size_t>(*index) - 1];
  }

  Value number() {
    const std::size_t begin = at_;
    while (is_digit(peek()) || peek() == '.') ++at_;
    return read_number(std::string_view(text_).substr(begin, at_ - begin));
  }

  const std::string text_;
  const std::vector<double>& parameters_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<double> constant_value(std::string_view expression, const std::vector<double>& parameters) {
  constexpr double beyond = 1e9;
  std::string dense;
  std::copy_if(expression.begin(), expression.end(), std::back_inserter(dense),
               [](char c) { return !is_blank(c); });
  const Value value = Evaluation(std::move(dense), parameters).run();
  return value && std::abs(*value) < beyond ? value : std::nullopt;
}

std::string shortest_text(double value) {
  std::string text = format_fixed(value, 6);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace counterflex
