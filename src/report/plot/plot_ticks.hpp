#pragma once
/// Axes with round numbers.
#include <vector>

namespace counterflex {

/// Multiples of 1, 2 or 5 times a power of ten, one interval apart.
struct PlotTicks {
  std::vector<double> values;  ///< ascending
  int decimals = 0;            ///< of their labels
};

/// The ticks in [least, largest], with at most `most` intervals; only `least` if it is not less than
/// `largest`.
PlotTicks ticks_within(double least, double largest, int most);

/// Ticks with at most `most` (2 or more) intervals, the first not above `least` and the last not below
/// `largest`; at least two even if these are equal. Values that are not finite count as 0.
PlotTicks ticks_around(double least, double largest, int most);

}  // namespace counterflex
