#pragma once
/// The errors of an actuator's motion. EQUATIONS.md, section 2.
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// The table as cubics of the actuator's value, with the slopes of Fritsch and Butland: continuous, and
/// without extremes between the positions of the table that are not at these. The slopes of a table with
/// deviations, which a fit changes, are those of parabolas: linear in its values, as a fit needs. Source: F.
/// N. Fritsch, J. Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J.
/// Sci. Stat. Comput. 5 (1984); at the ends their three-point formula.
MotionErrors motion_errors(const ErrorTable& table, const ShownValue& shown);

/// Those of an actuator: its table, or its harmonics as functions of its own value. Empty without errors.
MotionErrors motion_errors(const Actuator& actuator);

/// The error along or about the axis (m or rad) at a value of the actuator, and its slope.
struct AxisErrorAt {
  double error = 0, slope = 0;
};
AxisErrorAt error_along(const Joint& joint, const MotionErrors& errors, double value);

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
