#include "process/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace counterflex::cli {
namespace {

constexpr double settled = 2;  // s: earlier there is no estimate of the time left
constexpr double bar_width = 20;

}  // namespace

std::string rate_text(const Progress& progress) {
  const auto& [share, waypoints, elapsed] = progress;
  if (elapsed < settled) return "";
  std::string text = fmt::format(", {:.0f} waypoints/s", static_cast<double>(waypoints) / elapsed);
  if (share > 0 && share < 1) text += fmt::format(", {} left", duration_text(elapsed * (1 - share) / share));
  return text;
}

std::string progress_bar(const Progress& progress) {
  const double share = std::clamp(progress.share, 0.0, 1.0);
  const auto done = static_cast<std::size_t>(share * bar_width);
  const std::string bar =
      std::string(done, '#') + std::string(static_cast<std::size_t>(bar_width) - done, '-');
  return fmt::format("[{}] {:3.0f} %{}", bar, std::floor(100 * share), rate_text(progress));
}

std::string duration_text(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<long>(std::round(seconds / 60));
  if (minutes < 100) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace counterflex::cli
