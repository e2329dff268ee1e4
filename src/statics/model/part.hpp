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

/// Its force and stiffness there.
inline JointForce<double> force_of_joint(const Part& joint, const SeriesState& state, const Stage& stage) {
  const double x = joint_deflection(joint, state, stage);
  if (joint.k_change == 0) return {joint.k * x, joint.k};
  return joint_force(joint.k, joint.k_change, joint.knee, x);
}

/// One coordinate of a part (m or rad; N or N m).
struct PartCoordinate {
  int component = -1;  ///< of a spring, 0 to 5; else -1
  bool angular = false;
  double value = 0;
  double change = 0;  ///< from the nominal configuration
  double load = 0;    ///< dE/dx; zero for an actuator
};

/// Calls visit(PartCoordinate) for every coordinate of a joint, a compliance or a spring.
template <class Visit>
void visit_coordinates(const Part& part, const SeriesState& state, const Stage& stage, const Visit& visit) {
  if (part.kind == PartKind::spring) {
    const Vector6 theta = state.x.segment<6>(part.column),
                  tau = part.K * spring_deflection(part, state, stage);
    for (int k = 0; k < 6; ++k) visit(PartCoordinate{k, k >= 3, theta[k], theta[k], tau[k]});
  } else if (part.column >= 0 && part.kind != PartKind::group) {
    const double x = state.x[part.column];
    const double load = part.kind == PartKind::actuator ? 0 : force_of_joint(part, state, stage).force;
    visit(PartCoordinate{-1, part.joint.kind == JointKind::revolute, x, x - state.x_nominal[part.column],
                         load});
  }
}

}  // namespace counterflex
