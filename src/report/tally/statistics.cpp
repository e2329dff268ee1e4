#include "counterflex/report/statistics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/tip_uncertainty.hpp"

namespace counterflex {

namespace {

constexpr double bin_ratio = 1.001;
constexpr double smallest_mm = 1e-12;  // smaller deviations are rounding
constexpr int spare_bins = 256;
constexpr double parallel_sine = 1e-6;

int bin_of(double d_mm) {
  return static_cast<int>(std::floor(std::log(d_mm) / std::log(bin_ratio)));
}

double upper_edge(int bin) {
  return std::exp((bin + 1) * std::log(bin_ratio));
}

void keep_bands(std::optional<BandStatistics>& kept, const BandStatistics& other, bool is_larger) {
  if (!kept) kept.emplace();
  if (is_larger) kept->at_max_mm = other.at_max_mm;
  if (other.largest_mm > kept->largest_mm + indistinct_mm) kept->largest_line = other.largest_line;
  kept->largest_mm = std::max(kept->largest_mm, other.largest_mm);
}

void keep_maxima(DeviationStatistics& kept, const DeviationStatistics& other) {
  // Reports the first of lines that differ by rounding.
  const bool is_larger = kept.max_line == 0 || other.max_mm > kept.max_mm + indistinct_mm;
  if (is_larger) kept.max_line = other.max_line;
  if (other.bands) keep_bands(kept.bands, *other.bands, is_larger);
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
  if (sample.covariance != nullptr) {
    const double band_mm = band(sample.deviation.head<3>(), sample.covariance->topLeftCorner<3, 3>()) / mm;
    one.bands = BandStatistics{band_mm, band_mm, sample.line};
  }
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

void Histogram::add(int bin, double weight) {
  if (weights_.empty()) first_ = bin;
  if (bin < first_) {
    const int more = first_ - bin + spare_bins;
    weights_.insert(weights_.begin(), static_cast<std::size_t>(more), 0.0);
    first_ -= more;
  }
  const auto i = static_cast<std::size_t>(bin - first_);
  if (i >= weights_.size()) weights_.resize(i + 1 + spare_bins);
  weights_[i] += weight;
}

void DeviationTally::add(const DeviationSample& sample) {
  const DeviationStatistics one = of_one(sample);
  keep_maxima(maxima_, one);
  ++samples_;
  if (sample.weight <= 0) return;
  weight_ += sample.weight;
  sum_ += sample.weight * one.max_mm;
  sum_of_squares_ += sample.weight * one.max_mm * one.max_mm;
  if (one.bands) {
    band_weight_ += sample.weight;
    sum_of_squared_bands_ += sample.weight * one.bands->at_max_mm * one.bands->at_max_mm;
    if (one.max_mm <= one.bands->at_max_mm) below_ += sample.weight;
  }
  if (one.max_mm < smallest_mm)
    weight_of_none_ += sample.weight;
  else
    weight_by_bin_.add(bin_of(one.max_mm), sample.weight);
}

void DeviationTally::merge(const DeviationTally& later) {
  keep_maxima(maxima_, later.maxima_);
  samples_ += later.samples_;
  weight_ += later.weight_;
  sum_ += later.sum_;
  sum_of_squares_ += later.sum_of_squares_;
  weight_of_none_ += later.weight_of_none_;
  band_weight_ += later.band_weight_;
  below_ += later.below_;
  sum_of_squared_bands_ += later.sum_of_squared_bands_;
  later.weight_by_bin_.each([this](int bin, double weight) { weight_by_bin_.add(bin, weight); });
}

double DeviationTally::percentile(double share) const {
  // A sum of weights in another order than `weight_` may differ from it by rounding.
  const double wanted = share * weight_ * (1 - 1e-12);
  double below = weight_of_none_;
  if (below >= wanted) return 0;
  std::optional<double> found;
  weight_by_bin_.each([&](int bin, double weight) {
    below += weight;
    if (!found && below >= wanted) found = std::min(upper_edge(bin), maxima_.max_mm);
  });
  return found.value_or(maxima_.max_mm);
}

DeviationStatistics DeviationTally::statistics() const {
  DeviationStatistics result = maxima_;
  if (weight_ <= 0) return result;
  result.mean_mm = sum_ / weight_;
  result.rms_mm = std::sqrt(sum_of_squares_ / weight_);
  result.p95_mm = percentile(0.95);
  if (band_weight_ > 0) {
    result.bands->rms_mm = std::sqrt(sum_of_squared_bands_ / band_weight_);
    result.bands->below_percent = 100 * below_ / band_weight_;
  }
  return result;
}

}  // namespace counterflex
