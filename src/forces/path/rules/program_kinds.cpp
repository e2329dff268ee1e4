#include "forces/path/rules/program_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "forces/path/rules/rule_index.hpp"
#include "forces/read/selector_text.hpp"

namespace counterflex {
namespace {

// Longest text in a message.
constexpr std::size_t named_at_most = 8;
constexpr std::size_t longest_name = 40;

/// A long text as a selector with "*".
std::string shortened(const std::string& operation) {
  return operation.size() <= longest_name ? operation : operation.substr(0, longest_name - 1) + "*";
}

}  // namespace

ProgramKinds::ProgramKinds(const std::vector<ForceRule>& rules) {
  for (const ForceRule& rule : rules)
    if (rule.selector.operation) unseen_.push_back({&rule, folded(*rule.selector.operation)});
}

void ProgramKinds::see(const std::string& operation) {
  if (operation.empty()) return;
  if (operations_.size() < named_at_most)
    operations_.insert(operation);
  else
    more_operations_ = more_operations_ || !operations_.contains(operation);
  std::erase_if(unseen_, [&](const auto& rule) { return names_operation(rule.second, operation); });
}

void ProgramKinds::add(const Program& window) {
  std::vector<bool> seen(window.operations.size());
  long last_tool = 0;
  for (const Move& move : window.moves) {
    if (move.tool != last_tool) tools_.insert(move.tool);
    last_tool = move.tool;
    if (!seen[move.operation]) see(folded(window.operations[move.operation]));
    seen[move.operation] = true;
  }
}

void ProgramKinds::refuse_unknown(const ForceSource& source) const {
  for (const ForceRule& rule : source.rules) {
    const auto& tool = rule.selector.tool;
    if (tool && !tools_.contains(*tool) && !may_be_for_another_program(rule, source))
      fail_rule(rule, fmt::format("unknown tool T{}: the program uses {}", *tool, known_tools()));
    const auto is_rule = [&](const auto& unseen) { return unseen.first == &rule; };
    if (std::any_of(unseen_.begin(), unseen_.end(), is_rule))
      fail_rule(rule, fmt::format("unknown operation '{}': the program has {}", *rule.selector.operation,
                                  known_operations()));
  }
}

std::string ProgramKinds::known_tools() const {
  std::vector<std::string> names;
  for (const long tool : tools_)
    if (tool != 0 && names.size() < named_at_most) names.push_back(fmt::format("T{}", tool));
  if (names.empty()) return "no tool with a number";
  return fmt::format("{}{}", fmt::join(names, ", "), tools_.size() > named_at_most + 1 ? ", ..." : "");
}

std::string ProgramKinds::known_operations() const {
  if (operations_.empty()) return "no comment alone in its line before a move";
  std::vector<std::string> names;
  for (const std::string& operation : operations_) names.push_back(shortened(operation));
  return fmt::format("'{}'{}", fmt::join(names, "', '"), more_operations_ ? ", ..." : "");
}

}  // namespace counterflex
