#pragma once
/// Collects tools and operations of a program, window by window, and checks the rules against them.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex {

/// Whether a rule may be for the tool of another program that shares it.
inline bool may_be_for_another_program(const ForceRule& rule, const ForceSource& source) {
  return source.is_shared && rank(rule) == ForceRank::tool;
}

class ProgramKinds {
 public:
  /// Keeps a reference to the rules.
  explicit ProgramKinds(const std::vector<ForceRule>& rules);

  void add(const Program& window);

  /// Throws `InputError` at a rule for a tool or an operation that the program does not have, unless it may
  /// be for another program.
  void refuse_unknown(const ForceSource& source) const;

 private:
  void see(const std::string& operation);
  std::string known_tools() const;
  std::string known_operations() const;

  std::set<long> tools_;
  std::set<std::string> operations_;  ///< the first ones, for messages
  bool more_operations_ = false;
  std::vector<std::pair<const ForceRule*, std::string>> unseen_;  ///< rules and their operations
};

}  // namespace counterflex
