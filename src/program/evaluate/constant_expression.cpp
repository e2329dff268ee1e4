#include "program/evaluate/constant_expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "program/evaluate/constant_operators.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

using Value = std::optional<double>;

struct ComparisonName {
  std::string_view name;
  Relation comparison;
};
constexpr std::array word_comparisons{
    ComparisonName{"eq", Relation::equal},   ComparisonName{"ne", Relation::unequal},
    ComparisonName{"lt", Relation::less},    ComparisonName{"le", Relation::less_equal},
    ComparisonName{"gt", Relation::greater}, ComparisonName{"ge", Relation::greater_equal}};
constexpr std::array sign_comparisons{
    ComparisonName{"==", Relation::equal},      ComparisonName{"<>", Relation::unequal},
    ComparisonName{"<=", Relation::less_equal}, ComparisonName{">=", Relation::greater_equal},
    ComparisonName{"<", Relation::less},        ComparisonName{">", Relation::greater}};

/// Lower case without blanks. On a Sinumerik one blank remains between two names.
std::string dense_text(std::string_view expression, ExpressionSyntax syntax) {
  std::string dense;
  bool blank = false;
  for (const char c : expression) {
    if (is_blank(c)) {
      blank = true;
      continue;
    }
    const bool parts = blank && syntax == ExpressionSyntax::parentheses && !dense.empty();
    if (parts && is_identifier_character(dense.back()) && is_identifier_character(c)) dense += ' ';
    blank = false;
    dense += lower(c);
  }
  return dense;
}

/// Recursive descent parser of text without blanks: conditions, sums, products, powers, factors.
class Evaluation {
 public:
  Evaluation(std::string text, ExpressionSyntax syntax, const ValueOf& value_of)
      : text_(std::move(text)),
        syntax_(syntax),
        open_(syntax == ExpressionSyntax::parentheses ? '(' : '['),
        close_(syntax == ExpressionSyntax::parentheses ? ')' : ']'),
        value_of_(value_of) {}

  ConstantValue run() {
    const Value value = condition();
    return {at_ == text_.size() ? value : std::nullopt, depends_on_rounding_};
  }

 private:
  static constexpr int deepest = 100;

  bool has_brackets() const { return open_ == '['; }
  bool is_linuxcnc() const { return syntax_ == ExpressionSyntax::linuxcnc; }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(std::string_view what) {
    if (std::string_view(text_).substr(at_, what.size()) != what) return false;
    at_ += what.size();
    return true;
  }

  /// An operator that is a name. On a Sinumerik no letter or digit may follow it.
  bool take_word(std::string_view word) {
    const std::size_t begin = at_;
    take(" ");
    const bool taken = take(word) && (has_brackets() || !is_identifier_character(peek()));
    if (!taken) at_ = begin;
    if (taken) take(" ");
    return taken;
  }

  std::string_view take_one_of(std::initializer_list<std::string_view> words) {
    const auto found =
        std::find_if(words.begin(), words.end(), [&](std::string_view word) { return take_word(word); });
    return found == words.end() ? std::string_view() : *found;
  }

  /// The operators of lowest precedence.
  Value condition() {
    switch (syntax_) {
      case ExpressionSyntax::linuxcnc:
        return logic({"and", "or", "xor"}, &Evaluation::comparison);
      case ExpressionSyntax::macro:
        return comparison();
      case ExpressionSyntax::parentheses:
        return logic({"or"}, &Evaluation::exclusive);
      default:
        return sum();
    }
  }
  Value exclusive() { return logic({"xor"}, &Evaluation::conjunction); }
  Value conjunction() { return logic({"and"}, &Evaluation::negation); }

  Value logic(std::initializer_list<std::string_view> names, Value (Evaluation::*operand)()) {
    Value value = (this->*operand)();
    while (value) {
      const std::string_view name = take_one_of(names);
      if (name.empty()) break;
      value = logic_of(*value, name, (this->*operand)());
    }
    return value;
  }

  /// LinuxCNC accepts other values than 0 and 1 as truth values; Fanuc combines their bits.
  Value logic_of(double a, std::string_view name, Value b) const {
    const auto is_truth = [&](double x) { return is_linuxcnc() || x == 0 || x == 1; };
    if (!b || !is_truth(a) || !is_truth(*b)) return std::nullopt;
    return joined(a != 0, name, *b != 0);
  }

  Value negation() {
    if (!take_word("not")) return comparison();
    if (++depth_ > deepest) return std::nullopt;
    const Value value = negation();
    --depth_;
    return value ? logic_of(*value, "xor", 1) : std::nullopt;
  }

  Value comparison() {
    Value value = sum();
    while (value) {
      const auto comparison =
          has_brackets() ? take_comparison(word_comparisons) : take_comparison(sign_comparisons);
      if (!comparison) break;
      const Value other = sum();
      if (!other) return std::nullopt;
      value = compared(*value, *comparison, *other, is_linuxcnc());
      if (!value) depends_on_rounding_ = true;
    }
    return value;
  }

  template <typename Names>
  std::optional<Relation> take_comparison(const Names& names) {
    const auto found =
        std::find_if(names.begin(), names.end(), [&](auto& known) { return take(known.name); });
    return found == names.end() ? std::nullopt : std::optional(found->comparison);
  }

  Value sum() {
    Value value = product();
    while (value) {
      const bool plus = take("+"), minus = !plus && take("-");
      const bool macro = !plus && !minus && syntax_ == ExpressionSyntax::macro;
      const std::string_view name = macro ? take_one_of({"or", "xor"}) : std::string_view();
      if (!plus && !minus && name.empty()) break;
      const Value other = product();
      if (!other) return std::nullopt;
      value = plus ? *value + *other : minus ? Value(*value - *other) : logic_of(*value, name, other);
    }
    return value;
  }

  Value product() {
    Value value = power();
    while (value) {
      const bool times = peek() == '*', over = peek() == '/', divides = !has_brackets() && take_word("div");
      const bool modulo = !times && !over && !divides && take_word("mod");
      if (!times && !over && !divides && !modulo) {
        if (syntax_ != ExpressionSyntax::macro || !take_word("and")) return value;
        value = logic_of(*value, "and", power());
        continue;
      }
      if (times || over) ++at_;
      const Value other = power();
      if (!other || (!times && *other == 0)) return std::nullopt;
      value = times    ? *value * *other
              : modulo ? remainder_of(*value, *other, is_linuxcnc())
                       : Value(*value / *other);
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

  /// The condition behind an opening bracket, up to `close`.
  Value up_to(char close) {
    ++at_;
    if (++depth_ > deepest) return std::nullopt;
    const Value value = condition();
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
      return second && (*argument >= 0 || is_linuxcnc()) ? Value(std::atan2(*argument, *second) / deg)
                                                         : std::nullopt;
    }
    return value_of_function(name, *argument, is_linuxcnc());
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
  const ExpressionSyntax syntax_;
  const char open_, close_;
  const ValueOf& value_of_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool depends_on_rounding_ = false;
};

}  // namespace

ConstantValue evaluate_expression(std::string_view expression, ExpressionSyntax syntax,
                                  const ValueOf& value_of) {
  constexpr double beyond = 1e9;
  ConstantValue result = Evaluation(dense_text(expression, syntax), syntax, value_of).run();
  if (result.value && !(std::abs(*result.value) < beyond)) result.value.reset();
  return result;
}

std::optional<double> constant_value(std::string_view expression, ExpressionSyntax syntax,
                                     const ValueOf& value_of) {
  return evaluate_expression(expression, syntax, value_of).value;
}

std::string shortest_text(double value, int decimals) {
  std::string text = format_fixed(value, decimals);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace counterflex
