#pragma once
/// How far the tip is off along a path, in a few numbers. Lengths in mm and angles in degrees, as reports
/// show them.
#include <cstddef>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// Deviations that differ by less than this are equally large where the largest is named: solvers for
/// different processors agree to a hundredth of it.
inline constexpr double indistinct_mm = 1e-7;

struct DeviationStatistics {
  double max_mm = 0;  ///< largest norm of the position deviation
  double rms_mm =
      0;  ///< rms, mean and p95 of that norm weigh every sample by its share of the cutting length
  double mean_mm = 0;
  double p95_mm = 0;  ///< on 95 % of the length the norm is not larger; at most 0.1 % above the exact value
  int max_line = 0;   ///< where the norm is largest; the first such line; 0 where there was no sample
  Vector3 max_axis_mm = Vector3::Zero();  ///< largest absolute value by axis of the machine
  double max_rotation_deg = 0;            ///< largest rotation angle
  double max_along_mm = 0;                ///< along the path
  double max_across_mm = 0;     ///< across the path, square to the tool axis too: the error of a wall
  double max_tool_axis_mm = 0;  ///< along the tool axis: the error of a floor
};

/// One place where the deviation is known.
struct DeviationSample {
  Vector6 deviation =
      Vector6::Zero();  ///< actual minus wanted: position (m), rotation vector (rad), axes of M
  Vector3 direction = Vector3::Zero();   ///< unit vector of the path in M, zero where it has none
  Vector3 tool_axis = Vector3::UnitZ();  ///< unit, axes of M
  double weight = 0;                     ///< share of the cutting length (m); 0 counts in the maxima alone
  int line = 0;
};

/// Parts of a position deviation, not negative, in its unit. `across` is square to path and tool axis; where
/// these are parallel (a plunge) or the path has no direction, it is all that is square to the tool axis. The
/// three are components of an orthogonal frame wherever the tool axis stands square on the path.
struct DeviationSplit {
  double along = 0;
  double across = 0;
  double tool_axis = 0;
};
DeviationSplit split_deviation(const Vector3& d, const Vector3& direction, const Vector3& tool_axis);

/// Weights by bin number, in memory that grows with the span of numbers alone.
class Histogram {
 public:
  void add(int bin, double weight);

  /// Calls `take(bin, weight)` for each bin with a weight, in their order.
  template <typename Take>
  void each(const Take& take) const {
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0) take(first_ + static_cast<int>(i), weights_[i]);
  }

 private:
  int first_ = 0;
  std::vector<double> weights_;  ///< of bin `first_` and those behind it
};

/// Collects samples one by one, in memory that does not grow with their number. `p95` comes from a
/// logarithmic histogram with bins of 0.1 %.
class DeviationTally {
 public:
  void add(const DeviationSample& sample);

  /// As if the samples of `later` had been added after those of this one.
  void merge(const DeviationTally& later);

  /// All zero before the first sample. rms, mean and p95 are zero where no sample has a weight.
  DeviationStatistics statistics() const;

  std::size_t samples() const { return samples_; }

 private:
  double percentile(double share) const;

  DeviationStatistics maxima_;
  double weight_ = 0, sum_ = 0, sum_of_squares_ = 0;  ///< m, m mm, m mm2
  double weight_of_none_ = 0;                         ///< of samples without a deviation
  Histogram weight_by_bin_;
  std::size_t samples_ = 0;
};

}  // namespace counterflex
