#include "program/klartext/labels.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

namespace counterflex {
namespace {

constexpr int everywhere = std::numeric_limits<int>::max();

bool concerns_labels(const KlartextBlock& block) {
  return block.head == "LBL" || block.head == "CALL" || block.head == "FN" || block.head == "IF";
}

/// CYCL DEF 200 and later ones, but not CYCL DEF 247, which sets a preset. `rest`: behind CYCL, squeezed.
bool defines_cycle(std::string_view rest) {
  constexpr std::string_view define = "DEF2", preset = "DEF247";
  const std::size_t end = std::min(rest.find_first_not_of("0123456789", define.size()), rest.size());
  return rest.starts_with(define) && end == preset.size() && rest.substr(0, end) != preset;
}

/// CYCL CALL, M99 or M89.
bool may_call_cycle(std::string_view text, const KlartextBlock& block) {
  if (block.head == "CYCL") return squeezed(after_head(text, block)).starts_with("CALL");
  const std::string_view all = text.substr(block.span.begin, block.span.end - block.span.begin);
  if (all.find("99") == std::string_view::npos && all.find("89") == std::string_view::npos) return false;
  const std::string words = squeezed(all);
  for (std::size_t m = words.find('M'); m != std::string::npos; m = words.find('M', m + 1)) {
    const std::size_t code = std::min(words.find_first_not_of('0', m + 1), words.size());
    if (const std::string_view digits = std::string_view(words).substr(code, 2);
        digits == "99" || digits == "89")
      return true;
  }
  return false;
}

std::vector<TextStretch> merged(std::vector<TextStretch> stretches) {
  std::sort(stretches.begin(), stretches.end(), [](auto& a, auto& b) { return a.first < b.first; });
  std::vector<TextStretch> result;
  for (const TextStretch& stretch : stretches)
    if (!result.empty() && stretch.first <= result.back().last)
      result.back().last = std::max(result.back().last, stretch.last);
    else
      result.push_back(stretch);
  return result;
}

}  // namespace

std::string label_name(std::string_view text) {
  if (text.starts_with('"')) return std::string(text.substr(0, text.find('"', 1)));
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::size_t begin = std::min(text.find_first_not_of('0'), end);
  if (end == 0) return "Q";
  return begin < end ? std::string(text.substr(begin, end - begin)) : "0";
}

int next_place(int place, const KlartextBlock& block) {
  const int between = place + place % 2;
  return concerns_labels(block) ? between + 1 : between;
}

bool contains(const std::vector<TextStretch>& stretches, int at) {
  const auto after = std::upper_bound(stretches.begin(), stretches.end(), at,
                                      [](int wanted, const TextStretch& s) { return wanted < s.first; });
  return after != stretches.begin() && (after - 1)->last >= at;
}

void KlartextScan::add(std::string_view blocks) {
  block_.line_end = {};
  while (next_klartext_block(blocks, block_)) {
    place_ = next_place(place_, block_);
    take_label(blocks);
    take_pole(blocks);
    take_cycle(blocks);
  }
}

void KlartextScan::take_label(std::string_view text) {
  if (!concerns_labels(block_)) return;
  const std::string rest = squeezed(after_head(text, block_));
  if (block_.head == "LBL") {
    labels_[label_name(rest)].set.push_back(place_);
  } else if (block_.head == "CALL" && rest.starts_with("LBL")) {
    Label& label = labels_[label_name(std::string_view(rest).substr(3))];
    if (rest.find("REP") == std::string::npos)
      label.called = true;
    else
      label.jumped_to.push_back(place_);
  } else if (const std::size_t jump = rest.find("GOTOLBL"); jump != std::string::npos) {
    labels_[label_name(std::string_view(rest).substr(jump + 7))].jumped_to.push_back(place_);
  }
}

/// Notes a block that uses the pole. Such a block is plain if it is LP or CP without Q parameters.
void KlartextScan::take_pole(std::string_view text) {
  constexpr std::array<std::string_view, 6> unfollowed{"CTP", "FPOL", "FL", "FC", "FLT", "FCT"};
  const std::string& head = block_.head;
  if (head == "CC") pole_ = block_.line;
  const bool polar = head == "LP" || head == "CP", approach = head == "APPR" || head == "DEP";
  const bool other = std::find(unfollowed.begin(), unfollowed.end(), head) != unfollowed.end();
  if (pole_ == 0 || (!polar && !approach && !other)) return;
  const std::string rest = squeezed(after_head(text, block_));
  if (approach && !rest.starts_with('P')) return;
  const PoleUse use{pole_, place_, polar && rest.find('Q') == std::string::npos};
  if (pole_uses_.empty() || pole_uses_.back() != use) pole_uses_.push_back(use);
}

/// Notes a block that may call the cycle that was defined last.
void KlartextScan::take_cycle(std::string_view text) {
  if (block_.head == "CYCL" && defines_cycle(squeezed(after_head(text, block_)))) {
    if (cycle_is_called_ && series_.back().first == series_.back().last) series_.pop_back();
    cycle_is_called_ = false;
  }
  if (block_.parts.empty() || !may_call_cycle(text, block_)) return;
  if (!std::exchange(cycle_is_called_, true)) series_.push_back({block_.line, block_.line});
  series_.back().last = block_.line;
}

/// From a label to the LBL 0 behind it.
void KlartextScan::add_body(int first, std::vector<TextStretch>& stretches) const {
  const auto ends = labels_.find("0");
  int last = everywhere;
  if (ends != labels_.end()) {
    const auto end = std::upper_bound(ends->second.set.begin(), ends->second.set.end(), first);
    if (end != ends->second.set.end()) last = *end;
  }
  stretches.push_back({first, last});
}

std::vector<TextStretch> KlartextScan::uncertain() const {
  std::vector<TextStretch> stretches;
  for (const auto& [name, label] : labels_) {
    const std::vector<int>&set = label.set, &from = label.jumped_to;
    if (name == "Q" && (label.called || !from.empty())) return {{0, everywhere}};
    if (set.empty()) continue;
    if (label.called)
      for (const int place : set) add_body(place, stretches);
    if (!from.empty())
      stretches.push_back({std::min(set.front(), from.front()), std::max(set.back(), from.back())});
  }
  return merged(std::move(stretches));
}

KlartextOutline KlartextScan::finish() const {
  KlartextOutline outline{uncertain(), {}, series_};
  for (const PoleUse& use : pole_uses_) {
    const bool followed = use.plain && !contains(outline.uncertain, use.place);
    if (!followed && (outline.poles.empty() || outline.poles.back() != use.line))
      outline.poles.push_back(use.line);
  }
  return outline;
}

}  // namespace counterflex
