#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/identification/units.hpp"

namespace counterflex {

std::string range_words(const LeftRange& left) {
  const double unit = left.turns ? deg : mm;
  return fmt::format(
      "{} moves {} from {:.4g} to {:.4g} {}; in the other rows it moves from {:.4g} to {:.4g} {}", left.group,
      left.actuator, left.tested_min / unit, left.tested_max / unit, left.turns ? "deg" : "mm",
      left.trained_min / unit, left.trained_max / unit, left.turns ? "deg" : "mm");
}

std::string untested_words(const LadderStep& step) {
  if (step.untested.empty()) return "no held-out row tests this set; it is left out";
  return fmt::format("the rows that show these are not predicted by other rows; they stay: {}",
                     fmt::join(step.untested, ", "));
}

std::string residual_words(const Identification& found) {
  const std::string lengths =
      found.lack_of_fit ? fmt::format("{:.4g} mm rms of all lengths", *found.lack_of_fit / mm) : "";
  const std::string ratio = found.misfit ? fmt::format("{:.2g} of the stated deviations", *found.misfit) : "";
  if (lengths.empty() && ratio.empty()) return "not known: no row is a length or states its deviation";
  return lengths + (lengths.empty() || ratio.empty() ? "" : ", ") + ratio;
}

std::string noise_words(const SessionNoise& noise) {
  const ErrorUnit unit = unit_of(noise.kind, true);
  std::string text = fmt::format(
      "readings at one place scatter by {:.3g} {} ({} degrees of freedom); the fit misses the means of "
      "places by {:.3g} "
      "{}. ",
      noise.noise / unit.si, unit.name, noise.freedoms, noise.misfit / unit.si, unit.name);
  if (!noise.is_lacking) return text + "This is noise: better values need more rows or a better gauge.";
  return text + fmt::format(
                    "Noise explains {:.3g} {} of this. The other {:.3g} {} are lack of fit: the model "
                    "lacks an error of the machine, and more rows do not help.",
                    noise.noise_of_means / unit.si, unit.name, noise.lack_of_fit / unit.si, unit.name);
}

}  // namespace counterflex
