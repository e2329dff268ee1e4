#pragma once
/// The directions in which actuators move. Behind a reversal a joint lags by half of its lost motion.
#include <cstdint>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// The direction in which each actuator moves or moved last. Part of a request: an answer depends on it.
struct Directions {
  /// A bit for each of `most_actuators`; neither: its direction is not known.
  std::uint64_t forward = 0, backward = 0;

  /// 1, -1, or 0 where it is not known.
  int of(std::size_t actuator) const {
    return static_cast<int>(forward >> actuator & 1U) - static_cast<int>(backward >> actuator & 1U);
  }
  void set(std::size_t actuator, int sign) {
    const std::uint64_t bit = std::uint64_t{1} << actuator;
    forward = sign > 0 ? forward | bit : forward & ~bit;
    backward = sign < 0 ? backward | bit : backward & ~bit;
  }
  bool operator==(const Directions&) const = default;
};

/// Whether joints have lost motion: only then do directions change anything.
inline bool has_reversals(const Model& model) {
  return !model.mechanism.reversal.empty();
}

/// Joint value less commanded value of each actuator (m, rad): minus its sign times half of its reversal.
/// Empty for a machine without reversals.
inline Eigen::VectorXd lag_of(const Mechanism& mechanism, const Directions& directions) {
  Eigen::VectorXd lag(static_cast<Eigen::Index>(mechanism.reversal.size()));
  for (std::size_t a = 0; a < mechanism.reversal.size(); ++a)
    lag[static_cast<Eigen::Index>(a)] = -0.5 * directions.of(a) * mechanism.reversal[a];
  return lag;
}

}  // namespace counterflex
