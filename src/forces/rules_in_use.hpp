#pragma once
/// Which rules cover a feed move at all, gathered window by window.
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/rule_index.hpp"

namespace counterflex {

/// A rule whose conditions no feed move meets is a mistake: what it was written for gets another force.
/// Profiles are not looked at, nor are rules for the whole program, nor zeros, which change nothing.
class RulesInUse {
 public:
  /// Borrows the rules.
  explicit RulesInUse(const std::vector<ForceRule>& rules);

  void add(const Program& window, const Toolpath& path);

  /// Throws `InputError` at the first rule that covers no feed move of a program that has some.
  void refuse_idle() const;

 private:
  void see(const Program& window, const Move& move);

  RuleIndex index_;
  const std::vector<ForceRule>& rules_;
  std::vector<bool> idle_;  ///< of each rule: it has to cover a feed move, and has not yet
  std::size_t idle_count_ = 0;
  bool cuts_ = false;
  std::optional<long> block_number_;
  std::unordered_set<std::uint64_t> kinds_;  ///< of tool and operation, that this window has had
  std::optional<std::uint64_t> last_kind_;
  std::string operation_;  ///< its text, folded
  std::vector<const ForceRule*> found_;
};

}  // namespace counterflex
