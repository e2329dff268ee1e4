#pragma once
/// One part of a series at one state: its transform, and what deflects it.
#include "statics/model/joint_law.hpp"
#include "statics/model/motion_errors.hpp"

namespace counterflex {

/// The transform of a joint at `value`.
Pose displacement(const Joint& joint, double value);

/// Pose of the frame after a part in the frame before it.
Pose part_pose(const Part& part, const SeriesState& state, const Stage& stage);

/// How an actuator moves that has errors of motion.
JointMotion actuator_motion(const Part& part, const SeriesState& state, const Stage& stage);

/// Number of its columns.
int columns_of(const Part& part);

/// How far a spring is from its rest: theta - s theta_0.
Vector6 spring_deflection(const Part& spring, const SeriesState& state, const Stage& stage);

/// How far a passive joint or a compliance is from its rest: q - q_nom - s (q_rest - q_nom). Both are zero
/// for a compliance.
double joint_deflection(const Part& joint, const SeriesState& state, const Stage& stage);

/// Its force and stiffness at a deflection.
inline JointForce<double> force_of_joint(const Part& joint, double x) {
  if (joint.k_change == 0) return {joint.k * x, joint.k};
  return joint_force(joint.k, joint.k_change, joint.knee, x);
}
inline JointForce<double> force_of_joint(const Part& joint, const SeriesState& state, const Stage& stage) {
  return force_of_joint(joint, joint_deflection(joint, state, stage));
}

}  // namespace counterflex
