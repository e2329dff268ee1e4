#include "forces/path/rules/rule_index.hpp"

#include <algorithm>

#include "forces/read/selector_text.hpp"

namespace counterflex {
namespace {

bool is_beginning(const std::string& operation) {
  return !operation.empty() && operation.back() == '*';
}

bool holds(const std::optional<std::array<long, 2>>& range, std::optional<long> number) {
  return !range || (number && *number >= (*range)[0] && *number <= (*range)[1]);
}

template <typename Map, typename Key>
void append_found(const Map& map, const Key& key, std::vector<const ForceRule*>& found) {
  const auto at = map.find(key);
  if (at != map.end()) found.insert(found.end(), at->second.begin(), at->second.end());
}

}  // namespace

bool names_operation(const std::string& selector, const std::string& operation) {
  if (!is_beginning(selector)) return selector == operation;
  const std::size_t length = selector.size() - 1;
  return !operation.empty() && operation.compare(0, length, selector, 0, length) == 0;
}

void RangeIndex::add(const std::array<long, 2>& range, const ForceRule& rule) {
  entries_.push_back({range[0], range[1], range[1], &rule});
}

void RangeIndex::finish() {
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.first < b.first; });
  for (std::size_t i = 1; i < entries_.size(); ++i)
    entries_[i].furthest = std::max(entries_[i].last, entries_[i - 1].furthest);
}

void RangeIndex::append(long number, std::vector<const ForceRule*>& found) const {
  auto entry = std::upper_bound(entries_.begin(), entries_.end(), number,
                                [](long at, const Entry& e) { return at < e.first; });
  while (entry != entries_.begin() && (--entry)->furthest >= number)
    if (entry->last >= number) found.push_back(entry->rule);
}

RuleIndex::RuleIndex(const std::vector<ForceRule>& rules) {
  for (const ForceRule& rule : rules) {
    if (std::holds_alternative<ForceProfile>(rule.content)) continue;
    const ForceSelector& selector = rule.selector;
    if (rank(selector) == ForceRank::place && selector.operation)
      folded_operations_.emplace(&rule, folded(*selector.operation));
    if (selector.lines) {
      lines_.add(*selector.lines, rule);
    } else if (selector.blocks) {
      blocks_.add(*selector.blocks, rule);
    } else if (selector.operation) {
      std::string text = folded(*selector.operation);
      Named& named = is_beginning(text) ? beginnings_ : operations_;
      if (is_beginning(text)) text.pop_back();
      named[text].push_back(&rule);
    } else if (selector.tool) {
      tools_[*selector.tool].push_back(&rule);
    } else {
      all_.push_back(&rule);
    }
  }
  lines_.finish();
  blocks_.finish();
}

void RuleIndex::append_by_kind(long tool, const std::string& operation,
                               std::vector<const ForceRule*>& found) const {
  const std::size_t old = found.size();
  if (!operation.empty()) {
    append_found(operations_, operation, found);
    for (std::size_t length = 0; !beginnings_.empty() && length <= operation.size(); ++length)
      append_found(beginnings_, operation.substr(0, length), found);
  }
  const auto other_tool = [&](const ForceRule* rule) {
    return rule->selector.tool && *rule->selector.tool != tool;
  };
  found.erase(std::remove_if(found.begin() + static_cast<std::ptrdiff_t>(old), found.end(), other_tool),
              found.end());
  append_found(tools_, tool, found);
  found.insert(found.end(), all_.begin(), all_.end());
}

void RuleIndex::append_by_place(const Move& move, const std::string& operation, std::optional<long> n,
                                std::vector<const ForceRule*>& found) const {
  const std::size_t old = found.size();
  lines_.append(move.line, found);
  if (n) blocks_.append(*n, found);
  const auto other = [&](const ForceRule* rule) {
    const ForceSelector& selector = rule->selector;
    return !holds(selector.blocks, n) || (selector.tool && *selector.tool != move.tool) ||
           (selector.operation && !names_operation(folded_operations_.at(rule), operation));
  };
  found.erase(std::remove_if(found.begin() + static_cast<std::ptrdiff_t>(old), found.end(), other),
              found.end());
}

}  // namespace counterflex
