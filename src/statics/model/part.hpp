#pragma once
/// One part of a series at one state: its transform, and what deflects it.
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// Pose of the frame after a part in the frame before it.
Pose part_pose(const Part& part, const SeriesState& state, const Stage& stage);

/// Number of its columns.
int columns_of(const Part& part);

/// How far a spring is from its rest: theta - s theta_0.
Vector6 spring_deflection(const Part& spring, const SeriesState& state, const Stage& stage);

/// How far a passive joint or a compliance is from its rest: q - q_nom - s (q_rest - q_nom). Both are zero for a compliance.
double joint_deflection(const Part& joint, const SeriesState& state, const Stage& stage);

}  // namespace counterflex
