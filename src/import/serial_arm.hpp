#pragma once
/// A serial arm as the sources describe it: joints with fixed transforms between them.
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex::import {

/// T = [R(rpy), xyz]; numbers as the source has them, so that they can be recognised.
struct FixedTransform {
  Vector3 xyz = Vector3::Zero();  ///< m
  Vector3 rpy = Vector3::Zero();  ///< rad, as `from_rpy`
  std::string comment{};

  Pose pose() const { return {from_rpy(rpy), xyz}; }
  bool is_identity() const { return xyz.isZero(0) && rpy.isZero(0); }
};

/// Of a link; in the frame behind the joint's last element.
struct LinkMass {
  double kg = 0;
  Vector3 at = Vector3::Zero();  ///< m
  std::string name;              ///< of the parameter
  std::string note;
  std::string doubt{};  ///< why the mass is a placeholder; empty: it is a catalogue value
};

struct ArmJoint {
  std::string name;  ///< in the source, for comments
  std::vector<FixedTransform> before{};
  Joint joint{JointKind::revolute, Vector3::UnitZ()};
  std::optional<double> min{}, max{}, home{};                ///< m or rad, of the shown value
  std::vector<std::pair<std::size_t, double>> shown_with{};  ///< index of an earlier joint, factor
  std::vector<FixedTransform> after{};
  std::optional<LinkMass> mass{};
};

struct SerialArm {
  std::string name;
  std::string chain = "arm";
  std::vector<std::string> head;  ///< lines of comment at the beginning, the first with `import_mark`
  std::vector<ArmJoint> joints;
  std::vector<FixedTransform> end{};  ///< behind the last joint
  std::string kinematics = "catalogue";
  std::string kinematics_comment;
  std::string travel_comment{};  ///< for joints whose travel is a placeholder
  std::string mass_comment{};    ///< if the source states no masses
  std::string dialect{};
  std::string units{};  ///< of programs; empty: not stated
  std::string spindle_axis = "-z";
  double sigma_mm = 0.5, sigma_deg = 0.05;  ///< of the components of the error slots
};

/// The actuator value of joint i where the control shows `shown`.
std::vector<double> joint_values(const std::vector<ArmJoint>& joints, const std::vector<double>& shown);

/// Where inverse kinematics can start, and what the arm can control there.
struct ArmHome {
  std::vector<double> shown;          ///< m or rad
  std::vector<Component> controlled;  ///< as many as there are joints; none if there is no such set
};

/// A regular pose near the zero of the joints (near the middle of their travel, if that does not contain
/// zero). Joints are tried at 0, 45, -45, 90 and -90 degrees, and at the quarters of a linear travel. Poses
/// with at least half of the best manipulability (smallest singular value of the Jacobian, lengths in units
/// of half of the reach) are good. Of them those count whose tool points down, within 60 degrees of -z of M,
/// if there are any. Values that the source gives stay.
ArmHome choose_home(const SerialArm& arm);

/// Sum of the lengths of the fixed transforms behind joint `from` (m).
double reach(const SerialArm& arm, std::size_t from);

/// The machine file.
std::string machine_text(const SerialArm& arm);

}  // namespace counterflex::import
