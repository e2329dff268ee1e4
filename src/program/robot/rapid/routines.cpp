#include "program/robot/rapid/routines.hpp"

#include <algorithm>
#include <array>

#include "program/robot/rapid/module.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// Whether an instruction moves the robot in each program.
bool is_moving_instruction(std::string_view head) {
  return head == "MOVEL" || head == "MOVEC" || head == "MOVEJ" || is_linear_instruction(head) ||
         is_joint_instruction(head);
}

}  // namespace

bool is_word_before_bracket(std::string_view name) {
  return is_among(
      name, std::to_array<std::string_view>({"AND", "OR", "XOR", "NOT", "DIV", "MOD", "FROM", "TO", "STEP"}));
}

std::string name_of_routine(std::string_view text, const RapidStatement& statement) {
  if (statement.head == "TRAP") return {};
  RapidToken name = rapid_token_at(text, statement.rest - statement.head.size(), statement.span.end);
  std::string word;  // the type of a function precedes the name
  for (; name.kind == RapidTokenKind::name; name = rapid_token_at(text, name.span.end, statement.span.end))
    word = rapid_word(part(text, name.span));
  return word;
}

std::vector<Span> rapid_functions(std::string_view text, const RapidStatement& statement) {
  std::vector<Span> functions;
  if (part(text, statement.span).find('(') == std::string_view::npos || !has_expressions(statement.kind))
    return functions;
  const bool is_short_if = statement.kind == RapidKind::short_if;
  const std::size_t end = is_short_if ? statement_of_short_if(text, statement) : statement.span.end;
  visit_rapid_names(text, statement.rest, end, [&](Span name) {
    const bool has_bracket = is_symbol(text, rapid_token_at(text, name.end, end), '(');
    if (has_bracket && !is_word_before_bracket(rapid_word(part(text, name)))) functions.push_back(name);
  });
  return functions;
}

void StillRoutines::add(std::string_view text, const RapidStatement& statement) {
  if (ended_) return;
  ended_ = statement.kind == RapidKind::module_end;
  if (statement.kind == RapidKind::routine_begin) {
    const std::string name = name_of_routine(text, statement);
    body_ = name.empty() ? nullptr : &bodies_[name];
    return;
  }
  if (statement.kind == RapidKind::routine_end) body_ = nullptr;
  if (body_ == nullptr || body_->moves) return;
  const auto add_functions = [&](const RapidStatement& s) {
    for (const Span name : rapid_functions(text, s)) body_->functions.insert(rapid_word(part(text, name)));
  };
  RapidStatement last = statement;
  add_functions(last);
  while (last.kind == RapidKind::short_if) {
    last = rapid_statement_at(text, statement_of_short_if(text, last), last.behind);
    add_functions(last);
  }
  if (last.kind == RapidKind::call) {
    body_->moves = is_moving_instruction(last.head);
    body_->instructions.insert(last.head);
  }
  visit_rapid_names(text, statement.span.begin, statement.span.end,
                    [&](Span name) { body_->names.insert(rapid_word(part(text, name))); });
}

/// Whether it is still if the routines of the module that it calls are.
bool StillRoutines::may_be_still(const Body& body) const {
  const auto is_read = [&](const std::string& name) {
    return bodies_.contains(name) || harmless_.contains(name);
  };
  return !body.moves && std::ranges::all_of(body.instructions, [&](const std::string& head) {
    return is_read(head) || (is_motionless_instruction(head) && !is_mode_instruction(head));
  }) && std::ranges::all_of(body.functions, [&](const std::string& name) {
    return is_read(name) || is_motionless_function(name);
  });
}

RapidNames StillRoutines::all() const {
  RapidNames names;
  for (const auto& entry : bodies_) names.insert(entry.first);
  return names;
}

RapidNames StillRoutines::finish() const {
  RapidNames still;
  for (const auto& [name, body] : bodies_)
    if (may_be_still(body)) still.insert(name);
  const auto calls_motion = [&](const std::string& name) {
    return std::ranges::any_of(bodies_.find(name)->second.names, [&](const std::string& called) {
      return bodies_.contains(called) && !still.contains(called);
    });
  };
  while (std::erase_if(still, calls_motion) > 0) {
  }
  return still;
}

}  // namespace counterflex
