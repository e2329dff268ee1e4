#pragma once
/// An index of rules by their selectors.
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex {

/// Rules by ranges of lines or of block numbers.
class RangeIndex {
 public:
  void add(const std::array<long, 2>& range, const ForceRule& rule);
  void finish();  ///< call before the first `append`
  bool empty() const { return entries_.empty(); }

  /// Appends the rules whose ranges include `number`.
  void append(long number, std::vector<const ForceRule*>& found) const;

 private:
  struct Entry {
    long first = 0, last = 0;
    long furthest = 0;  ///< the largest `last` up to this entry
    const ForceRule* rule = nullptr;
  };
  std::vector<Entry> entries_;  ///< by `first`
};

/// All rules except profiles. Keeps references to them.
class RuleIndex {
 public:
  explicit RuleIndex(const std::vector<ForceRule>& rules);

  bool by_block() const { return !blocks_.empty(); }
  bool by_range() const { return !lines_.empty() || !blocks_.empty(); }

  /// Appends the rules for moves of a tool and an operation (folded, or empty) at any place.
  void append_by_kind(long tool, const std::string& operation, std::vector<const ForceRule*>& found) const;

  /// Appends the rules for ranges of places that cover a move of an operation (folded); `n` is its block
  /// number, or the last one before it.
  void append_by_place(const Move& move, const std::string& operation, std::optional<long> n,
                       std::vector<const ForceRule*>& found) const;

 private:
  using Named = std::unordered_map<std::string, std::vector<const ForceRule*>>;

  RangeIndex lines_, blocks_;
  Named operations_, beginnings_;
  std::unordered_map<long, std::vector<const ForceRule*>> tools_;
  std::vector<const ForceRule*> all_;
  /// Operations of rules for places, folded.
  std::unordered_map<const ForceRule*, std::string> folded_operations_;
};

/// Whether an operation's text matches a selector, both folded.
bool names_operation(const std::string& selector, const std::string& operation);

}  // namespace counterflex
