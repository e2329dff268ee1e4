#pragma once
/// Units in which matrices are compared and pivoted: lengths in l, forces in k l, moments in k l^2 with k =
/// 1e6 N/m.
#include <algorithm>

#include "counterflex/geometry/pose.hpp"

namespace counterflex {

struct Units {
  static constexpr double stiffness = 1e6;  ///< k, N/m
  double length = 1;
  double energy() const { return stiffness * length * length; }
  double of_column(bool angular) const { return angular ? 1.0 : length; }
  /// Of the rows of a closure (m m m rad rad rad); a wrench times this, divided by energy(), is without unit.
  Vector6 of_pose() const { return (Vector6() << length, length, length, 1, 1, 1).finished(); }
};

/// Largest of |translation| and |rotation| l (m).
inline double twist_size(const Vector6& twist, const Units& units) {
  return std::max(twist.head<3>().norm(), twist.tail<3>().norm() * units.length);
}

/// Largest of |force| and |moment| / l (N).
inline double wrench_size(const Vector6& F, const Units& units) {
  return std::max(F.head<3>().norm(), F.tail<3>().norm() / units.length);
}

}  // namespace counterflex
