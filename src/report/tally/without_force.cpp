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
  return reasons.emplace_back(WithoutForceReason{move.why, 0, 0, move.line});
}

}  // namespace

void add_unforced(WithoutForce& without, const Unforced& move) {
  const double length_mm = move.length / mm;
  if (without.moves == 0 || std::isnan(without.length_mm))
    without.length_mm = length_mm;
  else if (!std::isnan(length_mm))
    without.length_mm += length_mm;
  ++without.moves;
  WithoutForceReason& reason = reason_of(move, without.reasons);
  ++reason.moves;
  reason.length_mm += length_mm;
  reason.first_line = std::min(reason.first_line, move.line);
  list(without.rows, WithoutForceRow{move.line, length_mm, move.why});
}

}  // namespace counterflex
