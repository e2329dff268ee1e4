#pragma once
/// How coordinates are written.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace counterflex {

/// Appends `value` in the style of the number `original`: its sign style ("+1"), its leading zero or none
/// (".5"), its decimals or as many more, up to `decimals`, as the value needs; always with a point.
void append_changed_number(std::string_view original, double value, int decimals, std::string& text);

/// The same as a text of its own.
std::string changed_number(std::string_view original, double value, int decimals);

/// `value` with `decimals` digits after the point, which it always has.
std::string inserted_number(double value, int decimals);

/// 10 to the power of `digits`, from 0 to 9 at least.
inline double power_of_ten(int digits) {
  constexpr std::array<double, 10> powers{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
  const auto i = static_cast<std::size_t>(digits);
  return digits >= 0 && i < powers.size() ? powers[i] : std::pow(10.0, digits);
}

/// Whether `wanted` is within half a unit of the last of `decimals` digits of `original`, so that writing it
/// anew would be no more exact; also where they differ by no more than arithmetic does, 1e-10.
inline bool rounds_to(double original, double wanted, int decimals) {
  constexpr double least = 1e-10;  // digits beyond what a double of some metres holds are no correction
  return std::abs(wanted - original) <= std::max(0.5 / power_of_ten(decimals), least);
}

}  // namespace counterflex
