#pragma once
/// How far a six-axis arm is from the poses at which its configuration changes.
#include <array>
#include <optional>
#include <string>

#include "counterflex/geometry/types.hpp"
#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// An angle (rad, 0 to pi/2) to the pose in which two configurations of an arm meet.
struct ArmMargin {
  double angle = 0;
  const char* what = "";  ///< "wrist: axes A4 and A6 are in line"
};

/// A run whose program turns the tool is refused where a margin is smaller (rad): a corrected target might be
/// reached in another configuration.
inline constexpr double least_arm_margin = 1 * deg;

/// Three margins of a chain of six rotary actuators: the wrist (axes 4 and 6 in line), the elbow (the arm
/// stretched or folded) and the shoulder. The last three axes meet in a point, the centre of the wrist, whose
/// shoulder changes on axis 1; or axes 2, 3 and 4 are parallel, and the shoulder changes where axes 5 and 6
/// meet in the plane of axes 1 and 2. None for another machine. Zero where the configurations meet: it is
/// `singular` there. `nominal`: a nominal configuration.
std::optional<std::array<ArmMargin, 3>> arm_margins(const Model& model, const Configuration& nominal);

/// The least of them.
std::optional<ArmMargin> arm_margin(const Model& model, const Configuration& nominal);

}  // namespace counterflex
