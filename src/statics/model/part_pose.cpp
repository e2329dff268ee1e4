#include "statics/model/part_pose.hpp"

namespace counterflex {

Pose part_pose(const Part& part, const SeriesState& state, const Stage& stage) {
  switch (part.kind) {
    case PartKind::fixed: return part.X;
    case PartKind::error: return {exp_so3(stage.errors * part.log_R), stage.errors * part.X.p};
    case PartKind::spring:
      return {exp_so3(state.x.segment<3>(part.column + 3)), state.x.segment<3>(part.column)};
    case PartKind::group: return state.groups[part.group].X;
    case PartKind::mass: return {};
    default: break;
  }
  const Vector3 motion = (state.x[part.column] + stage.gravity * part.offset) * part.joint.axis;
  return part.joint.kind == JointKind::prismatic ? translation(motion) : rotation(exp_so3(motion));
}

}  // namespace counterflex
