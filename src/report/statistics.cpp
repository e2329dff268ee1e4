#include "counterflex/report/statistics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/units.hpp"

namespace counterflex {

namespace {

constexpr double bin_ratio = 1.001;
constexpr double smallest_mm = 1e-12;  // below it everything is one bin: there is no such deviation
constexpr int lowest_bin = std::numeric_limits<int>::min();
constexpr double parallel_sine = 1e-6;

int bin_of(double d_mm) {
  if (d_mm < smallest_mm) return lowest_bin;
  return static_cast<int>(std::floor(std::log(d_mm) / std::log(bin_ratio)));
}

double upper_edge(int bin) {
  return bin == lowest_bin ? 0 : std::exp((bin + 1) * std::log(bin_ratio));
}

void keep_maxima(DeviationStatistics& kept, const DeviationStatistics& other) {
  // The first of lines that differ by rounding is named.
  if (kept.max_line == 0 || other.max_mm > kept.max_mm + smallest_mm) kept.max_line = other.max_line;
  kept.max_mm = std::max(kept.max_mm, other.max_mm);
  kept.max_axis_mm = kept.max_axis_mm.cwiseMax(other.max_axis_mm);
  kept.max_rotation_deg = std::max(kept.max_rotation_deg, other.max_rotation_deg);
  kept.max_along_mm = std::max(kept.max_along_mm, other.max_along_mm);
  kept.max_across_mm = std::max(kept.max_across_mm, other.max_across_mm);
  kept.max_tool_axis_mm = std::max(kept.max_tool_axis_mm, other.max_tool_axis_mm);
}

DeviationStatistics of_one(const DeviationSample& sample) {
  const Vector3 d_mm = sample.deviation.head<3>() / mm;
  const DeviationSplit split = split_deviation(d_mm, sample.direction, sample.tool_axis);
  DeviationStatistics one;
  one.max_mm = d_mm.norm();
  one.max_line = sample.line;
  one.max_axis_mm = d_mm.cwiseAbs();
  one.max_rotation_deg = sample.deviation.tail<3>().norm() / deg;
  one.max_along_mm = split.along;
  one.max_across_mm = split.across;
  one.max_tool_axis_mm = split.tool_axis;
  return one;
}

}  // namespace

DeviationSplit split_deviation(const Vector3& d, const Vector3& direction, const Vector3& tool_axis) {
  const double along = d.dot(direction);
  const double axial = d.dot(tool_axis);
  const Vector3 sideways = tool_axis.cross(direction);
  const double sine = sideways.norm();
  const double across =
      sine > parallel_sine ? std::abs(d.dot(sideways)) / sine : (d - axial * tool_axis).norm();
  return {std::abs(along), across, std::abs(axial)};
}

void DeviationTally::add(const DeviationSample& sample) {
  const DeviationStatistics one = of_one(sample);
  keep_maxima(maxima_, one);
  ++samples_;
  if (sample.weight <= 0) return;
  weight_ += sample.weight;
  sum_ += sample.weight * one.max_mm;
  sum_of_squares_ += sample.weight * one.max_mm * one.max_mm;
  weight_by_bin_[bin_of(one.max_mm)] += sample.weight;
}

void DeviationTally::merge(const DeviationTally& later) {
  keep_maxima(maxima_, later.maxima_);
  samples_ += later.samples_;
  weight_ += later.weight_;
  sum_ += later.sum_;
  sum_of_squares_ += later.sum_of_squares_;
  for (const auto& [bin, weight] : later.weight_by_bin_) weight_by_bin_[bin] += weight;
}

double DeviationTally::percentile(double share) const {
  // A sum of weights in another order than `weight_` may differ from it by rounding.
  const double wanted = share * weight_ * (1 - 1e-12);
  double below = 0;
  for (const auto& [bin, weight] : weight_by_bin_) {
    below += weight;
    if (below >= wanted) return std::min(upper_edge(bin), maxima_.max_mm);
  }
  return maxima_.max_mm;
}

DeviationStatistics DeviationTally::statistics() const {
  DeviationStatistics result = maxima_;
  if (weight_ <= 0) return result;
  result.mean_mm = sum_ / weight_;
  result.rms_mm = std::sqrt(sum_of_squares_ / weight_);
  result.p95_mm = percentile(0.95);
  return result;
}

}  // namespace counterflex
