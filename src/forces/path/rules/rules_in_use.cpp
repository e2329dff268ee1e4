#include "forces/path/rules/rules_in_use.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forces/path/rules/program_kinds.hpp"
#include "forces/read/selector_text.hpp"

namespace counterflex {

RulesInUse::RulesInUse(const ForceSource& source) : index_(source.rules), rules_(source.rules) {
  for (const ForceRule& rule : rules_) {
    const bool selects =
        rank(rule) != ForceRank::program && !std::holds_alternative<ForceProfile>(rule.content);
    idle_.push_back(selects && !may_be_for_another_program(rule, source) && !is_zero(rule));
  }
  idle_count_ = static_cast<std::size_t>(std::count(idle_.begin(), idle_.end(), true));
}

void RulesInUse::add(const Program& window, const Toolpath& path) {
  if (idle_count_ == 0) return;
  kinds_.clear();
  last_kind_.reset();
  std::size_t next = 0;
  for (std::size_t m = 0; m < window.moves.size(); ++m) {
    const Move& move = window.moves[m];
    if (move.block_number) block_number_ = move.block_number;
    const bool has_segment = next < path.segments.size() && path.segments[next].move == m;
    if ((has_segment && path.segments[next].cutting) || drills(move)) see(window, move);
    if (has_segment) ++next;
  }
}

void RulesInUse::see(const Program& window, const Move& move) {
  cuts_ = true;
  if (idle_count_ == 0) return;
  found_.clear();
  const std::uint64_t kind = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(move.tool)) << 32) |
                             static_cast<std::uint64_t>(move.operation);
  if (last_kind_ != kind) {
    last_kind_ = kind;
    operation_ = folded(window.operations[move.operation]);
    if (kinds_.insert(kind).second) index_.append_by_kind(move.tool, operation_, found_);
  }
  if (index_.by_range()) index_.append_by_place(move, operation_, block_number_, found_);
  for (const ForceRule* rule : found_) {
    const auto i = static_cast<std::size_t>(rule - rules_.data());
    if (idle_[i]) --idle_count_;
    idle_[i] = false;
  }
}

void RulesInUse::refuse_idle() const {
  const auto idle = std::find(idle_.begin(), idle_.end(), true);
  if (!cuts_ || idle == idle_.end()) return;
  const ForceRule& rule = rules_[static_cast<std::size_t>(idle - idle_.begin())];
  fail_rule(rule, fmt::format("{} covers no feed move of the program", shown(rule.selector)));
}

}  // namespace counterflex
