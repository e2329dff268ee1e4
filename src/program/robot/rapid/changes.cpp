#include "program/robot/rapid/changes.hpp"

#include <algorithm>
#include <array>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

bool writes_arguments(std::string_view name, const RapidRoutines& routines) {
  const auto routine = routines.find(name);
  return routine != routines.end() ? routine->second.writes_arguments : !only_reads(name);
}

/// Reads the tokens of an expression or of arguments in order.
class ChangedNames {
 public:
  /// `writes`: the names outside of brackets are arguments that may be changed.
  ChangedNames(std::string_view text, const RapidRoutines& routines, bool writes)
      : text_(text), routines_(routines), writes_{writes} {}

  void read(std::size_t at, std::size_t end) {
    for (RapidToken token; (token = rapid_token_at(text_, at, end)).kind != RapidTokenKind::none;
         at = token.span.end) {
      if (token.kind == RapidTokenKind::name) read_name(token);
      if (is_symbol(text_, token, '(')) writes_.push_back(bracket_writes());
      if (is_symbol(text_, token, ')') && writes_.size() > 1) writes_.pop_back();
      before_ = token;
    }
  }

  std::vector<Span> names{};

 private:
  void read_name(const RapidToken& token) {
    const bool has_result = before_.kind == RapidTokenKind::assign && option_has_result_;
    const bool is_option = is_symbol(text_, before_, '\\');
    option_has_result_ = is_option && is_option_with_result(rapid_word(part(text_, token.span)));
    if (is_option || is_symbol(text_, before_, '.')) return;
    if (writes_.back() || has_result) names.push_back(token.span);
  }

  /// Of "name(...)", and of a bracket in an expression.
  bool bracket_writes() const {
    if (before_.kind != RapidTokenKind::name) return writes_.back();
    const std::string name = rapid_word(part(text_, before_.span));
    return is_word_before_bracket(name) ? writes_.back() : writes_arguments(name, routines_);
  }

  std::string_view text_;
  const RapidRoutines& routines_;
  std::vector<bool> writes_;  ///< by open bracket
  RapidToken before_{};
  bool option_has_result_ = false;  ///< of the option before ":="
};

}  // namespace

bool has_reference_parameters(std::string_view text, const RapidStatement& statement) {
  constexpr auto references = std::to_array<std::string_view>({"INOUT", "VAR", "PERS"});
  bool found = false;
  visit_rapid_names(text, statement.span.begin, statement.span.end,
                    [&](Span name) { found = found || is_among(rapid_word(part(text, name)), references); });
  return found;
}

std::vector<Span> names_changed_by(std::string_view text, const RapidStatement& statement,
                                   const RapidRoutines& routines) {
  if (!has_expressions(statement.kind)) return {};
  const bool is_call = statement.kind == RapidKind::call;
  const bool writes = is_call && writes_arguments(statement.head, routines);
  const std::string_view marks = statement.head.starts_with("MOVE") ? "(" : "(\\";  // of functions, options
  if (!writes && statement.kind != RapidKind::assignment &&
      part(text, statement.span).find_first_of(marks) == std::string_view::npos)
    return {};
  ChangedNames changed(text, routines, writes);
  if (statement.kind == RapidKind::assignment)
    changed.names.push_back(rapid_token_at(text, statement.span.begin, statement.span.end).span);
  const bool is_short_if = statement.kind == RapidKind::short_if;
  changed.read(statement.rest, is_short_if ? statement_of_short_if(text, statement) : statement.span.end);
  return changed.names;
}

}  // namespace counterflex
