#include "plot_ticks.hpp"

#include <algorithm>
#include <cmath>

namespace counterflex {

namespace {

constexpr double tick_slack = 1e-9;  // of an interval: rounding must not cost a tick

struct TickStep {
  double size = 1;
  int decimals = 0;
};

/// The smallest round step of which `most` intervals span `width`.
TickStep tick_step(double width, int most) {
  const double least = width / most;
  const int power = static_cast<int>(std::floor(std::log10(least)));
  const double ten = std::pow(10.0, power);
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * ten >= least * (1 - tick_slack)) return {factor * ten, std::max(0, -power)};
  return {10 * ten, std::max(0, -power - 1)};
}

}  // namespace

PlotTicks round_ticks(double least, double largest, int most) {
  PlotTicks ticks;
  if (!(largest > least)) return {{least}, 0};
  const TickStep step = tick_step(largest - least, most);
  const double first = std::ceil(least / step.size - tick_slack),
               last = std::floor(largest / step.size + tick_slack);
  for (double i = first; i <= last; ++i) ticks.values.push_back(i * step.size);
  ticks.decimals = step.decimals;
  return ticks;
}

PlotRange widened_to_ticks(PlotRange range, int most) {
  if (!std::isfinite(range.least)) range.least = 0;
  if (!std::isfinite(range.largest)) range.largest = 0;
  const double size = std::max(std::abs(range.least), std::abs(range.largest));
  const double least_width = size > 0 ? 1e-6 * size : 1;
  if (range.largest - range.least < least_width) {
    range.least -= least_width / 2;
    range.largest += least_width / 2;
  }
  const double step = tick_step(range.largest - range.least, most).size;
  return {std::floor(range.least / step + tick_slack) * step,
          std::ceil(range.largest / step - tick_slack) * step};
}

}  // namespace counterflex
