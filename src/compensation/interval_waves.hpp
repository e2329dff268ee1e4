#pragma once
/// Samples the corrections of many segments at once, each as closely as it needs.
#include <array>

#include "target_waves.hpp"

namespace counterflex {

/// A stretch of a segment without corners inside: its ends a and b, its middle m and its quarters q and r, in
/// the order a q m r b.
struct SampledInterval {
  std::size_t segment = 0;
  std::array<double, 5> u{};
  std::array<Answer, 5> at{no_answer, no_answer, no_answer, no_answer, no_answer};
  bool by_quarters = false;  ///< its middle does not tell whether it is a line
};

/// An end of an interval: where it is, and its answer.
struct IntervalEnd {
  double u = 0;
  Answer at = no_answer;  ///< none: not yet asked for
};

class IntervalWaves {
 public:
  /// `accuracy` (m): with which the polynomial through an interval's nodes predicts further ones.
  IntervalWaves(TargetWaves& waves, double accuracy) : waves_(waves), accuracy_(accuracy) {}

  void clear();

  /// Asks for an interval's middle, and where it may wave, as around an arc, for its quarters; `a` has been
  /// asked for, `b` is, too, unless it has been. Returns b's answer.
  Answer open(std::size_t segment, IntervalEnd a, IntervalEnd b, bool may_wave);

  /// When the answers have come: halves what its nodes do not predict, until they do. False where a solve
  /// was.
  bool run();

  /// The intervals by segment and fraction.
  const std::vector<SampledInterval>& done() const { return done_; }
  CurveInterval curve(const SampledInterval& interval) const;

 private:
  bool is_line(const SampledInterval& i) const;
  bool is_predicted(const SampledInterval& i) const;
  void ask_quarters();
  void halve(const SampledInterval& i);

  TargetWaves& waves_;
  double accuracy_;
  std::vector<SampledInterval> open_, next_, done_;
};

}  // namespace counterflex
