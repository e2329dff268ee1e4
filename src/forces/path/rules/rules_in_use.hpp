#pragma once
/// Finds rules that cover no feed move, window by window.
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/path/rules/rule_index.hpp"

namespace counterflex {

/// A rule without a matching feed move is an error: its moves would get another force. Profiles, rules for
/// the whole program and zero forces are not checked. Where several programs share the rules, a tool may be
/// that of another program.
class RulesInUse {
 public:
  /// Keeps a reference to the rules.
  explicit RulesInUse(const ForceSource& source);

  void add(const Program& window, const Toolpath& path);

  /// Throws `InputError` at the first rule that covers no feed move, if the program has feed moves.
  void refuse_idle() const;

 private:
  void see(const Program& window, const Move& move);

  RuleIndex index_;
  const std::vector<ForceRule>& rules_;
  std::vector<bool> idle_;  ///< for each rule: true while no feed move has matched it
  std::size_t idle_count_ = 0;
  bool cuts_ = false;
  std::optional<long> block_number_;
  std::unordered_set<std::uint64_t> kinds_;  ///< of tool and operation in this window
  std::optional<std::uint64_t> last_kind_;
  std::string operation_;  ///< its text, folded
  std::vector<const ForceRule*> found_;
};

}  // namespace counterflex
