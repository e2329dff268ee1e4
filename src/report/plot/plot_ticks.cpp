#include "report/plot/plot_ticks.hpp"

#include <algorithm>
#include <cmath>

namespace counterflex {

namespace {

constexpr double tick_slack = 1e-9;  // of an interval: keeps ticks at the ends in spite of rounding

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

PlotTicks ticks_of(const TickStep& step, double first, double last) {
  PlotTicks ticks{.values = {}, .decimals = step.decimals};
  for (double i = first; i <= last; ++i) ticks.values.push_back(i * step.size);
  return ticks;
}

}  // namespace

PlotTicks ticks_within(double least, double largest, int most) {
  if (!(largest > least)) return {{least}, 0};
  const TickStep step = tick_step(largest - least, most);
  return ticks_of(step, std::ceil(least / step.size - tick_slack),
                  std::floor(largest / step.size + tick_slack));
}

PlotTicks ticks_around(double least, double largest, int most) {
  if (!std::isfinite(least)) least = 0;
  if (!std::isfinite(largest)) largest = 0;
  const double size = std::max(std::abs(least), std::abs(largest));
  const double width = std::max(largest - least, size > 0 ? 1e-6 * size : 1);
  // The widened range may have one interval more than its width needs.
  for (int intervals = most;; --intervals) {
    const TickStep step = tick_step(width, std::max(1, intervals));
    const double first = std::floor(least / step.size + tick_slack);
    const double last = std::max(first + 1, std::ceil(largest / step.size - tick_slack));
    if (last - first <= most) return ticks_of(step, first, last);
  }
}

}  // namespace counterflex
