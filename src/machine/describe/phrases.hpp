#pragma once
/// Parts of a machine as phrases, for descriptions and notes.
#include <string>
#include <string_view>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// `3 actuators`, `1 actuator`, `no actuators`.
std::string counted(int count, std::string_view singular, std::string_view plural);

/// `xyz 1 0 0 mm, rpy 0 0 90 deg`, without zero parts; `none` for identity.
std::string phrase(const Pose& X);

/// `prismatic along x`, `revolute about (0 0.6 0.8)`.
std::string phrase(const Joint& joint);

/// A joint's value in its own unit: `12.5 mm`, `90 deg`.
std::string phrase_value(const Joint& joint, double value);

/// `-120 to 260 mm`, `below 90 deg`, `without limits`.
std::string phrase_range(const Joint& joint, double min, double max);

/// `shown = -q + 90 deg + 1 J2`, where q is the joint's value; empty if the control shows q.
std::string phrase_shown(const Actuator& actuator);

/// `errors of table x (0 to 500 mm), reversal 12 um`; empty if the actuator has none.
std::string phrase_errors(const Actuator& actuator);

/// `2.5e+06 N m/rad`.
std::string phrase_stiffness(const Joint& joint, double stiffness);

/// `x 1 0 0` millimetre triples: numbers with up to nine digits, never "-0".
std::string phrase_mm(const Vector3& p);

/// `12.5 kg`.
std::string phrase_mass(double kg);

bool is_identity(const Pose& X);

}  // namespace counterflex
