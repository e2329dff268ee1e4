#pragma once
/// The correction along segments, sampled as closely as it needs.
#include <array>

#include "compensation/plan/corrections.hpp"

namespace counterflex {

/// A stretch of a segment without corners inside: its ends a and b, its middle m and its quarters q and r, in
/// the order a q m r b.
struct Interval {
  std::size_t segment = 0;
  std::array<double, 5> u{};
  std::array<Answer, 5> at{no_answer, no_answer, no_answer, no_answer, no_answer};
  bool by_quarters = false;  ///< its middle does not show whether it is a line
};

/// Between two fractions of a segment. Requests what is inside, and its end under the force `F`; `a`: the
/// answer at its start. Where the correction may wave, as around an arc, its quarters are needed too.
Interval open_interval(Corrections& corrections, std::size_t segment, double u0, Answer a, double u1,
                       const Vector6& F, bool may_wave);

/// Halves the intervals until the polynomials through their nodes predict further ones within `accuracy` (m).
/// Sorted by segment and fraction. Those of segments that fail, or are behind one that fails, are left out.
std::vector<Interval> refine(Corrections& corrections, std::vector<Interval> open, double accuracy);

CurveInterval nodes_of(const Corrections& corrections, const Interval& interval);

}  // namespace counterflex
