#include "compensation/solve/corner_way.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double least_turn = 1e-3;  // rad: with a smaller one there is nothing to round
constexpr int most_newton_steps = 50;
constexpr double small_step = 1e-12;  // of the lengths of the curves
constexpr double rounding = 1e-14;    // of coordinates

constexpr double smaller = 0.95;  // size, from one trial to the next
constexpr int most_sizes = 200;

double turn_between(const Curve& before, const Curve& after) {
  const Vector3 a = direction_at(before, 1), b = direction_at(after, 0);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// About `normal`: positive where the curve turns counter-clockwise.
double curvature(const Curve& curve, const Vector3& normal) {
  if (!curve.arc) return 0;
  return std::copysign(curve.arc->sweep / length(curve), curve.arc->normal.dot(normal));
}

// Corrects the lengths `taken` of both curves until a circle of this radius touches both there:
//     p_1 + r n x d_1 = p_2 + r n x d_2
// By Newton's method: along a curve of curvature k, p + r n x d changes by (1 - r k) d.
bool solve_taken(const Curve& before, const Curve& after, double radius, const Vector3& normal,
                 Eigen::Vector2d& taken) {
  const double L1 = length(before), L2 = length(after);
  const double small = small_step * (L1 + L2) + rounding * before.end.norm();
  for (int i = 0; i < most_newton_steps; ++i) {
    const double u1 = 1 - taken[0] / L1, u2 = taken[1] / L2;
    const Vector3 d1 = direction_at(before, u1), d2 = direction_at(after, u2);
    Vector3 off = point_at(before, u1) - point_at(after, u2) + radius * normal.cross(d1 - d2);
    off -= off.dot(normal) * normal;
    Eigen::Matrix<double, 3, 2> J;
    J.col(0) = -(1 - radius * curvature(before, normal)) * d1;
    J.col(1) = -(1 - radius * curvature(after, normal)) * d2;
    const Eigen::Vector2d step = J.colPivHouseholderQr().solve(off);
    taken -= step;
    if (!taken.allFinite()) return false;
    if (std::max(step.norm(), off.norm()) < small) return true;
  }
  return false;
}

}  // namespace

std::optional<Curve> corner_way(const Curve& before, const Curve& after, CornerKind kind, double size) {
  const double turn = turn_between(before, after), L1 = length(before), L2 = length(after);
  if (turn < least_turn || turn > std::numbers::pi - least_turn) return std::nullopt;
  const Vector3 normal = direction_at(before, 1).cross(direction_at(after, 0)).normalized();
  const bool is_round = kind == CornerKind::round;
  Eigen::Vector2d taken = Eigen::Vector2d::Constant(taken_by_corner(kind, size, turn));
  if (is_round && !solve_taken(before, after, size, normal, taken)) return std::nullopt;
  if (taken.minCoeff() <= 0 || taken[0] > L1 || taken[1] > L2) return std::nullopt;
  const double u1 = 1 - taken[0] / L1, u2 = taken[1] / L2;
  Curve way{point_at(before, u1), point_at(after, u2), {}};
  if (!is_round) return way;
  const Vector3 centre = way.start + size * normal.cross(direction_at(before, u1));
  way.arc = Arc{centre, normal, sweep_between(way.start, way.end, centre, normal)};
  return way;
}

std::optional<WantedAndCommanded> corner_ways(const WantedAndCommanded& before,
                                              const WantedAndCommanded& after, const CornerSize& size) {
  const auto ways_of = [&](double trial) -> std::optional<WantedAndCommanded> {
    const auto wanted = corner_way(before.wanted, after.wanted, size.kind, trial),
               commanded = corner_way(before.commanded, after.commanded, size.kind, trial);
    if (!wanted || !commanded) return std::nullopt;
    return WantedAndCommanded{*wanted, *commanded};
  };
  if (size.mm == 0) return std::nullopt;
  if (auto ways = size.mm > 0 ? ways_of(size.mm * mm) : std::nullopt) return ways;
  double trial = std::min(length(before.wanted), length(after.wanted)) /
                 taken_by_corner(size.kind, 1, turn_between(before.wanted, after.wanted));
  for (int i = 0; i < most_sizes; ++i) {
    trial *= smaller;
    if (auto ways = ways_of(trial)) return ways;
  }
  return std::nullopt;
}

}  // namespace counterflex
