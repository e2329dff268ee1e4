#pragma once
/// When a control turns the tool about one fixed axis along an arc that is given by three points.
#include <limits>

#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// Limits within which the control of a robot turns the tool about one fixed axis along an arc. They apply to
/// each piece of a divided arc, too: a piece keeps the orientation of the auxiliary point. Angles in rad.
struct ArcTurnLimits {
  static constexpr double no_limit = std::numeric_limits<double>::infinity();
  Matrix3 R_point = Matrix3::Identity();  ///< at the auxiliary point, as written
  double point_room = no_limit;    ///< largest angle between `R_point` and the orientation of the tool there
  double largest_turn = no_limit;  ///< from start to end
  /// Of a control that turns the tool relative to the path: the largest angle between the orientations that
  /// this gives and those of one fixed axis.
  double path_room = no_limit;
  double least_share = 0;  ///< of the sweep, between the auxiliary point and each end
};

/// How the tool turns along an arc.
struct ArcTurn {
  Vector3 normal = Vector3::UnitZ();  ///< unit vector about which the arc goes counter-clockwise
  double sweep = 0;                   ///< rad
  double point_share = 0.5;           ///< of the sweep, from the start to the auxiliary point
  Turn turn{};
};

/// Whether the arc keeps the limits by `margin`: rad, of a share 1.
bool keeps_limits(const ArcTurnLimits& limits, const ArcTurn& arc, double margin = 0);

/// The largest angle (rad), at eighths of the arc, between two ways of turning the tool: relative to the
/// path, about an axis that is fixed in the frame of tangent and normal, and about an axis that is fixed in
/// space. It is 0 for a turn about the normal of the arc.
double deviation_by_path(const ArcTurn& arc);

}  // namespace counterflex
