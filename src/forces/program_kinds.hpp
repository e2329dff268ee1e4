#pragma once
/// Tools and operations of a program, gathered window by window, and whether rules name others.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex {

class ProgramKinds {
 public:
  /// Borrows the rules.
  explicit ProgramKinds(const std::vector<ForceRule>& rules);

  void add(const Program& window);

  /// Throws `InputError` at a rule for a tool or an operation that the program has not.
  void refuse_unknown(const std::vector<ForceRule>& rules) const;

 private:
  void see(const std::string& operation);
  std::string known_tools() const;
  std::string known_operations() const;

  std::set<long> tools_;
  std::set<std::string> operations_;  ///< the first ones, for messages
  bool more_operations_ = false;
  std::vector<std::pair<const ForceRule*, std::string>> unseen_;  ///< rules and the operations they ask for
};

}  // namespace counterflex
