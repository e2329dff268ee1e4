#include "counterflex/program/arc_turn.hpp"

#include <algorithm>
#include <cmath>

namespace counterflex {

// With n the normal, s the sweep, and Exp(phi) the turn from start to end:
//
//     R_space(u) = Exp(u phi) R_start
//     R_path(u) = Exp(u s n) Exp(u psi) R_start      with Exp(s n) Exp(psi) = Exp(phi)
//
// Of the rotation vectors psi it is the one near to phi - s n, also beyond half a turn.
double deviation_by_path(const ArcTurn& arc) {
  constexpr int parts = 8;
  const Vector3 phi = rotation_between(arc.turn.end, arc.turn.start);
  Vector3 psi = log_so3(exp_so3(-arc.sweep * arc.normal) * exp_so3(phi));
  const double other = psi.norm() - 2 * pi, about_normal = phi.dot(arc.normal) - arc.sweep;
  const Vector3 other_way = psi.norm() > 0 ? Vector3(other * psi.normalized()) : psi;
  if (std::abs(other_way.dot(arc.normal) - about_normal) < std::abs(psi.dot(arc.normal) - about_normal))
    psi = other_way;
  double largest = 0;
  for (int k = 1; k < parts; ++k) {
    const double u = static_cast<double>(k) / parts;
    const Matrix3 in_path = exp_so3(u * arc.sweep * arc.normal) * exp_so3(u * psi);
    largest = std::max(largest, rotation_between(in_path, exp_so3(u * phi)).norm());
  }
  return largest;
}

bool keeps_limits(const ArcTurnLimits& limits, const ArcTurn& arc, double margin) {
  const double share = arc.point_share, least = limits.least_share + margin;
  if (limits.least_share > 0 && !(share >= least && share <= 1 - least)) return false;
  if (rotation_between(arc.turn.end, arc.turn.start).norm() > limits.largest_turn - margin) return false;
  const Matrix3 R_there = orientation_at(arc.turn, share);
  if (rotation_between(limits.R_point, R_there).norm() > limits.point_room - margin) return false;
  return limits.path_room == ArcTurnLimits::no_limit || deviation_by_path(arc) <= limits.path_room - margin;
}

}  // namespace counterflex
