#pragma once
/// Axes with round numbers.
#include <vector>

namespace counterflex {

/// Multiples of 1, 2 or 5 times a power of ten, one interval apart.
struct PlotTicks {
  std::vector<double> values;  ///< ascending
  int decimals = 0;            ///< that their labels need
};

/// The ticks in [least, largest], of at most `most` intervals; `least` alone where it is not less.
PlotTicks ticks_within(double least, double largest, int most);

/// Ticks of at most `most` (2 or more) intervals, the first of them not above `least` and the last not below
/// `largest`; they are apart even where these two are equal. What is not finite counts as 0.
PlotTicks ticks_around(double least, double largest, int most);

}  // namespace counterflex
