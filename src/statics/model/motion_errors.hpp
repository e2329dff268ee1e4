#pragma once
/// The errors of an actuator's motion. EQUATIONS.md, section 2.
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// The table as cubics of the actuator's value, with the slopes of Fritsch and Butland: continuous, and
/// without extremes between the positions of the table that are not at these. Source: F. N. Fritsch, J.
/// Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci. Stat.
/// Comput. 5 (1984); at the ends their three-point formula.
MotionErrors motion_errors(const ErrorTable& table, const ShownValue& shown);

/// The frame behind an actuator in the frame before it, and how it moves with the value: velocity of its
/// origin and angular velocity, axes of the frame before.
struct JointMotion {
  Pose X;
  Vector3 v, w;
};

/// The motion of a joint at `value`, with the share `s` of the errors at `commanded`:
///
///     p = p_joint + s p_error        R = Exp(s phi_error) R_joint
JointMotion joint_motion(const Joint& joint, const MotionErrors& errors, double value, double commanded,
                         double s);

}  // namespace counterflex
