#include <cmath>
#include <limits>
#include <vector>

#include "counterflex/geometry/spectrum.hpp"
#include "counterflex/statics/tip_stiffness.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/theory/manipulator.hpp"

namespace counterflex {

std::optional<Matrix6> compliance_at_tip(const Model& model, const Configuration& configuration,
                                         const Load& load, const Stage& stage, StaticsWork& work) {
  const Units units{model.mechanism.length};
  evaluate_all(model, configuration, stage, work.impl());
  const WholeSystem system = whole_system(model, configuration, {load, stage, nullptr}, work.impl());
  if (!(condition_bound(system) < largest_condition) && !std::isfinite(condition(system, units).value))
    return std::nullopt;
  const Matrix6 T = tip_from_platform(model.mechanism, configuration.X_MP);
  // Six unit wrenches, of which each changes the platform's balance alone.
  const auto count = system.variables.size();
  const auto rows = static_cast<Eigen::Index>(count);
  HeldSteps wrenches{std::vector<bool>(count, false), Eigen::MatrixXd::Zero(rows, 6),
                     Eigen::MatrixXd::Zero(rows, 6)};
  wrenches.gradient.bottomRows<6>() = -(units.of_pose().asDiagonal() * T.transpose()) / units.energy();
  return Matrix6(T * solve_held(system, wrenches, units).bottomRows<6>());
}

double stiffness_along(const Matrix6& compliance, const Vector3& direction) {
  const double along = direction.dot(compliance.topLeftCorner<3, 3>() * direction);
  return std::abs(along) < rigid_compliance ? std::numeric_limits<double>::infinity() : 1 / along;
}

SoftestDirection softest_direction(const Matrix6& compliance) {
  const Matrix3 C = compliance.topLeftCorner<3, 3>();
  Vector3 direction = spectrum((C + C.transpose()) / 2).vectors.col(2);
  const double stiffness = stiffness_along(compliance, direction);
  if (!std::isfinite(stiffness)) return {Vector3::Zero(), stiffness};
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  if (direction[largest] < 0) direction = -direction;  // the sign of an eigenvector is free
  return {direction, stiffness};
}

std::optional<Matrix6> inverse_compliance(const Matrix6& compliance, double length) {
  return inverse_in_units(compliance, Units{length}.of_pose().cwiseInverse());
}

}  // namespace counterflex
