#pragma once
/// The force of an elastic joint by its deflection. EQUATIONS.md, section 13.
#include "statics/kernel/equations/numbers.hpp"

namespace counterflex {

/// Half of the width in which the stiffness changes at a knee, as a share of the knee's deflection.
inline constexpr double knee_width = 0.1;

/// N, N m, and their derivative.
template <class T>
struct JointForce {
  T force, stiffness;
};

/// With w = `knee_width` knee, u = |x| - knee + w in [0, 2 w], v = |x| - knee - w >= 0:
///
///     F = k x + sign(x) k_change (u^2 / 4w + v)        dF/dx = k + k_change u / 2w
///
/// T: double, or lanes.
template <class T>
COUNTERFLEX_INLINE JointForce<T> joint_force(double k, double k_change, double knee, T x) {
  using namespace kernel;
  const double w = knee_width * knee;
  const T size = magnitude(x), zero{};
  const T u = smaller(larger(T(size - (knee - w)), zero), all<T>(2 * w)),
          v = larger(T(size - (knee + w)), zero);
  const T more = (u * u * (0.25 / w) + v) * k_change;
  return {k * x + select<T>(x < 0.0, -more, more), all<T>(k) + u * (0.5 * k_change / w)};
}

/// The integral of the force (N m).
inline double joint_energy(double k, double k_change, double knee, double x) {
  if (k_change == 0) return 0.5 * k * x * x;
  const double w = knee_width * knee, size = kernel::magnitude(x);
  const double u = kernel::smaller(kernel::larger(size - (knee - w), 0.0), 2 * w),
               v = kernel::larger(size - (knee + w), 0.0);
  return 0.5 * k * x * x + k_change * (u * u * u / (12 * w) + w * v + 0.5 * v * v);
}

}  // namespace counterflex
