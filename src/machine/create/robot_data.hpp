#pragma once
/// The built-in robots as data.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// The text of robots.toml.
std::string_view robots_toml();

namespace made {

struct RobotJoint {
  std::string place;  ///< from the frame behind the joint before it, as the keys of a transform; may be empty
  std::string axis;   ///< "x", "y" or "z"
  std::string shown;  ///< keys of the shown value, with a comma before each
  double min = 0, max = 0, home = 0;   ///< shown values (deg)
  std::optional<double> compliance{};  ///< rad/(N m)
  std::optional<double> kg{};          ///< of the link behind it
  Vector3 at_mm = Vector3::Zero();     ///< its centre of mass, in the frame behind the link
};

struct Robot {
  std::string name, title, maker;
  double payload_kg = 0;
  std::string lengths, stiffness, masses;  ///< sources
  std::vector<RobotJoint> joints;          ///< six
  std::string flange;                      ///< behind the last joint, as `RobotJoint::place`
};

const std::vector<Robot>& robots();

}  // namespace made
}  // namespace counterflex
