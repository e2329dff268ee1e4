#pragma once
/// Axes with round numbers.
#include <vector>

namespace counterflex {

/// Multiples of 1, 2 or 5 times a power of ten.
struct PlotTicks {
  std::vector<double> values;  ///< ascending
  int decimals = 0;            ///< that their labels need
};

/// The ticks in [least, largest], at most `most` and at least one interval of them where least < largest.
PlotTicks round_ticks(double least, double largest, int most);

/// [least, largest] widened to ticks, so that both ends have one; wide enough to be drawn where the two are
/// equal. What is not finite counts as 0.
struct PlotRange {
  double least = 0, largest = 0;
};
PlotRange widened_to_ticks(PlotRange range, int most);

}  // namespace counterflex
