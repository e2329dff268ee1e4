#pragma once
/// Where actuators stand in their travel, and how messages say it.
#include <optional>
#include <string>

#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// An actuator that has a limit: its value, how far the nearer limit is (m or rad; negative: outside), and
/// that as a share of the travel (of 1 m or 1 rad where there is one limit only).
struct AxisPlace {
  std::size_t actuator = 0;
  double value = 0, margin = 0, share = 0;
};

/// The actuator nearest to an end of its travel, or farthest outside it, for actuator values `rho`. Linear
/// and rotary axes are compared in shares of their travel. None where no actuator has a limit.
std::optional<AxisPlace> tightest_axis(const Mechanism& mechanism, const Eigen::VectorXd& rho);

/// "138.0 mm", "-12.5 deg": the value of an actuator.
std::string axis_value(const Travel& travel, double value);

/// "-300 to 0 mm", "from -10 deg": the travel of an actuator.
std::string travel_range(const Travel& travel);

/// "axis Z: 138.0 mm is outside its travel (-300 to 0 mm)".
std::string outside_travel_words(const Travel& travel, double value);

}  // namespace counterflex
