#include "statics/model/part.hpp"

#include "statics/model/motion_errors.hpp"

namespace counterflex {

Pose displacement(const Joint& joint, double value) {
  const Vector3 motion = value * joint.axis;
  return joint.kind == JointKind::prismatic ? translation(motion) : rotation(exp_so3(motion));
}

Pose part_pose(const Part& part, const SeriesState& state, const Stage& stage) {
  switch (part.kind) {
    case PartKind::fixed:
      return part.X;
    case PartKind::error:
      return {exp_so3(stage.errors * part.log_R), stage.errors * part.X.p};
    case PartKind::spring:
      return {exp_so3(state.x.segment<3>(part.column + 3)), state.x.segment<3>(part.column)};
    case PartKind::group:
      return state.groups[part.group].X;
    case PartKind::mass:
      return {};
    default:
      break;
  }
  if (!part.errors.empty()) return actuator_motion(part, state, stage).X;
  return displacement(part.joint, state.x[part.column] + stage.gravity * part.offset);
}

JointMotion actuator_motion(const Part& part, const SeriesState& state, const Stage& stage) {
  const double commanded = state.x[part.column];
  return joint_motion(part.joint, part.errors, commanded + stage.gravity * part.offset, commanded,
                      stage.errors);
}

int columns_of(const Part& part) {
  if (part.column < 0) return 0;
  return part.kind == PartKind::spring || part.kind == PartKind::group ? 6 : 1;
}

Vector6 spring_deflection(const Part& spring, const SeriesState& state, const Stage& stage) {
  return state.x.segment<6>(spring.column) - stage.preload * spring.theta_0;
}

double joint_deflection(const Part& joint, const SeriesState& state, const Stage& stage) {
  const double q_nom = joint.kind == PartKind::passive ? state.x_nominal[joint.column] : 0;
  return state.x[joint.column] - (q_nom + stage.preload * (joint.rest - q_nom));
}

}  // namespace counterflex
