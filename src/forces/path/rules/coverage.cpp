#include "forces/path/rules/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "forces/read/selector_text.hpp"

namespace counterflex {
namespace {

// Shorter stretches are ignored (m).
constexpr double shortest_stretch = 1e-9;

/// N of every move, or that of the moves before it.
std::vector<std::optional<long>> numbers_of(const Program& window, std::optional<long>& n) {
  std::vector<std::optional<long>> numbers;
  numbers.reserve(window.moves.size());
  for (const Move& move : window.moves) {
    if (move.block_number) n = move.block_number;
    numbers.push_back(n);
  }
  return numbers;
}

/// The place in the input that gives the force: the rule, or the row of a profile.
Location where_of(const ForceRule& rule, std::size_t row) {
  const auto* profile = std::get_if<ForceProfile>(&rule.content);
  return profile != nullptr ? place_of_row(*profile, row) : rule.where;
}

/// Advice on how to end the overlap of two rules of equal rank.
std::string_view mended(const ForceRule& a, const ForceRule& b) {
  if (rank(a) != ForceRank::place) return "one of them must be more specific";
  if (is_section(a) && is_section(b)) return "narrow lines or blocks of one of them";
  if (is_section(a) || is_section(b))
    return "narrow lines or blocks of the section, or end the rows with one that has its key only";
  return "end the one that begins first with a row that has its key only";
}

/// Rules appear in the message in the order in which they were given. The error is at a place in a file, if
/// there is one.
[[noreturn]] void refuse_both(const ForceRule& a, std::size_t row_a, const ForceRule& b, std::size_t row_b,
                              int line) {
  const bool swap = &a > &b;
  const ForceRule &first = swap ? b : a, &second = swap ? a : b;
  const Location at_first = where_of(first, swap ? row_b : row_a),
                 at_second = where_of(second, swap ? row_a : row_b);
  const bool at_first_one = at_second.file.empty();
  fail_rule(at_first_one ? first : second, at_first_one ? at_first : at_second,
            fmt::format("covers line {} of the program, which {} covers too; both are given for {}: {}", line,
                        at_first_one ? place_of(second, at_second) : place_of(first, at_first),
                        shown(rank(first)), mended(first, second)));
}

/// Throws where two are of equal rank.
const ForceRule* most_specific(const std::vector<const ForceRule*>& rules, int line) {
  std::array<const ForceRule*, 4> of_rank{};
  for (const ForceRule* rule : rules) {
    const ForceRule*& other = of_rank[static_cast<std::size_t>(rank(*rule))];
    if (other != nullptr) refuse_both(*other, 0, *rule, 0, line);
    other = rule;
  }
  const auto acts = std::find_if(of_rank.begin(), of_rank.end(), [](auto* rule) { return rule != nullptr; });
  return acts == of_rank.end() ? nullptr : *acts;
}

}  // namespace

Coverage::Coverage(const ForceSource& source, const Program& window, const Toolpath& path,
                   std::optional<long>& block_number)
    : source_(source), window_(window), path_(path), index_(source.rules) {
  std::optional<long> number = block_number;
  for (const ForceRule& rule : source.rules) {
    const auto* profile = std::get_if<ForceProfile>(&rule.content);
    if (profile == nullptr) continue;
    profiles_.push_back(&rule);
    assert(profile->key != ForceKey::point);  // ForceCover has replaced it
    std::optional<long> n = block_number;
    keys_.push_back(align(*profile, window, path, n));
    if (profile->key == ForceKey::block_number) number = n;
  }
  if (index_.by_block()) {
    number = block_number;
    numbers_ = numbers_of(window, number);
  }
  block_number = number;
}

const std::vector<ForceStretch>& Coverage::stretches(std::size_t i) {
  const Segment& segment = path_.segments[i];
  const Move& move = window_.moves[segment.move];
  const ForceRule* rest = by_kind(move);
  claim(segment.move);
  for (const ForceRule* rule : profiles_) claim_rows(*rule, i);
  stretches_.clear();
  if (claims_.size() == 1 && claims_[0].least <= 0 && claims_[0].most >= 1) {  // nearly always
    stretches_.push_back({0, 1, claims_[0].rule, claims_[0].rule == nullptr});
    return stretches_;
  }
  settle(segment.line);
  const double shortest = std::min(0.5, shortest_stretch / (segment.s_end - segment.s_start));
  double done = 0;
  const auto fill = [&](double to) {
    if (to - done > shortest) stretches_.push_back({done, to, rest, false});
  };
  for (const Claim& claim : claims_) {
    if (claim.most - claim.least <= shortest) continue;
    fill(claim.least);
    stretches_.push_back({claim.least, claim.most, claim.rule, claim.rule == nullptr});
    done = claim.most;
  }
  fill(1);
  // A stretch that is too short is added to its neighbour.
  for (std::size_t k = 0; k < stretches_.size(); ++k) stretches_[k].from = k == 0 ? 0 : stretches_[k - 1].to;
  stretches_.back().to = 1;
  return stretches_;
}

ForceStretch Coverage::hole(std::size_t m) {
  const Move& move = window_.moves[m];
  const ForceRule* rest = by_kind(move);
  claim(m);
  settle(move.line);
  if (claims_.empty()) return {0, 1, rest, false};
  return {0, 1, claims_.front().rule, claims_.front().rule == nullptr};
}

const KeySpan& Coverage::keys(const ForceRule& profile, std::size_t i) const {
  const auto at = std::find(profiles_.begin(), profiles_.end(), &profile);
  return keys_[static_cast<std::size_t>(at - profiles_.begin())][i];
}

// Moves of one tool and operation are usually consecutive.
const ForceRule* Coverage::by_kind(const Move& move) {
  const std::uint64_t kind = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(move.tool)) << 32) |
                             static_cast<std::uint64_t>(move.operation);
  if (last_kind_ == kind) return last_acts_;
  const auto [at, is_new] = kinds_.try_emplace(kind, nullptr);
  if (is_new) {
    found_.clear();
    index_.append_by_kind(move.tool, operation_of(move), found_);
    at->second = most_specific(found_, move.line);
  }
  last_kind_ = kind;
  return last_acts_ = at->second;
}

const std::string& Coverage::operation_of(const Move& move) {
  if (last_operation_ != move.operation) folded_operation_ = folded(window_.operations[move.operation]);
  last_operation_ = move.operation;
  return folded_operation_;
}

// By what is not a profile.
void Coverage::claim(std::size_t m) {
  const Move& move = window_.moves[m];
  claims_.clear();
  if (move.force) claims_.push_back({});
  if (index_.by_range()) {
    found_.clear();
    const std::optional<long> n = numbers_.empty() ? std::nullopt : numbers_[m];
    index_.append_by_place(move, operation_of(move), n, found_);
    for (const ForceRule* rule : found_) {
      claims_.emplace_back();
      claims_.back().rule = rule;
    }
  }
}

void Coverage::claim_rows(const ForceRule& rule, std::size_t i) {
  const auto& profile = std::get<ForceProfile>(rule.content);
  const KeySpan& span = keys(rule, i);
  const double range = span.end - span.start;
  const bool alone = source_.rules.size() == 1 && !window_.moves[path_.segments[i].move].force;
  covers_.clear();
  append_covers(profile, span, alone, covers_);
  for (const KeyCover& cover : covers_) {
    Claim claim;
    claim.rule = &rule;
    claim.row = cover.row;
    if (range > 0) {
      const auto fraction = [&](double key) { return std::clamp((key - span.start) / range, 0.0, 1.0); };
      claim.from = fraction(cover.start);
      claim.to = fraction(cover.end);
      claim.least = fraction(cover.least);
      claim.most = fraction(cover.most);
      claim.rounding = key_margin(profile, span.end) / range;
      // Keys are rounded at ends of segments only; within a segment the rows define the end of the cover.
      if (!profile.within && claim.least > 0) claim.least = claim.from;
      if (!profile.within && claim.most < 1) claim.most = claim.to;
    }
    claims_.push_back(claim);
  }
}

// Consecutive claims meet where the later one begins. An overlap larger than rounding is an error.
void Coverage::settle(int line) {
  if (claims_.size() < 2) return;  // nearly all moves; avoids the allocation of a stable sort
  std::stable_sort(claims_.begin(), claims_.end(), [](const Claim& a, const Claim& b) {
    return a.from < b.from || (a.from == b.from && a.to < b.to);
  });
  std::size_t kept = 0;
  for (std::size_t k = 1; k < claims_.size(); ++k) {
    Claim& a = claims_[kept];
    Claim b = claims_[k];
    const double rounding = a.rounding + b.rounding;
    if (std::min(a.to, b.to) - b.from > rounding) refuse(a, b, line);
    if (b.to <= a.to && a.from < a.to) continue;  // rounding inside of a
    a.most = std::max(a.least, b.from - a.to <= rounding ? b.from : std::min(a.most, b.from));
    b.least = std::max(b.least, a.most);
    b.most = std::max(b.most, b.least);
    claims_[++kept] = b;
  }
  claims_.resize(kept + 1);
}

void Coverage::refuse(const Claim& a, const Claim& b, int line) const {
  if (a.rule != nullptr && b.rule != nullptr) refuse_both(*a.rule, a.row, *b.rule, b.row, line);
  const Claim& given = a.rule != nullptr ? a : b;
  throw InputError(ErrorKind::machine_or_force, where_of(*given.rule, given.row),
                   fmt::format("covers line {} of the program, which a FORCE comment covers too; both are "
                               "given for places: one of them must not cover it",
                               line));
}

bool in_air(const ForceSource& source, const Move& move) {
  if (!source.air_above_mm) return false;
  if (!drills(move)) return extent_of(move).least.z() > *source.air_above_mm;
  // How deep a called cycle drills is not always known.
  return move.cycle && std::min(move.cycle->bottom_mm, move.cycle->retract_mm) > *source.air_above_mm;
}

}  // namespace counterflex
