#pragma once
/// The transform of one part of a series at one state.
#include "counterflex/statics/mechanism.hpp"

namespace counterflex {

/// Pose of the frame after a part in the frame before it.
Pose part_pose(const Part& part, const SeriesState& state, const Stage& stage);

}  // namespace counterflex
