#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/statistics.hpp"

namespace counterflex {
namespace {

/// The index of the reason; if there are too many, the last one collects the others.
WithoutForceReason& reason_of(const Unforced& move, std::vector<WithoutForceReason>& reasons) {
  const auto known = std::find_if(reasons.begin(), reasons.end(),
                                  [&](const WithoutForceReason& reason) { return reason.why == move.why; });
  if (known != reasons.end()) return *known;
  if (reasons.size() == listed_at_most) {
    reasons.back().why = "other reasons";
    return reasons.back();
  }
  return reasons.emplace_back(WithoutForceReason{.why = move.why, .first_line = move.line});
}

}  // namespace

void add_unforced(WithoutForce& without, const Unforced& move) {
  const double length_mm = move.length / mm;
  WithoutForceReason& reason = reason_of(move, without.reasons);
  const auto add_to = [&](auto& sum) {
    ++sum.moves;
    if (std::isnan(length_mm))
      ++sum.unknown_length;
    else
      sum.length_mm += length_mm;
  };
  add_to(without);
  add_to(reason);
  reason.first_line = std::min(reason.first_line, move.line);
  list(without.rows, WithoutForceRow{move.line, length_mm, move.why});
}

}  // namespace counterflex
