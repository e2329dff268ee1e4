#include "counterflex/statics/tip_uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "counterflex/statics/fixture.hpp"
#include "statics/model/tolerances.hpp"

namespace counterflex {
namespace {

/// The twist of the tip relative to the part by what the part deflects.
Vector6 part_twist(const Mechanism& mechanism, const Load& load, const Pose& X_MT) {
  const Vector6 F = wrench_at_tip(mechanism, load.F, load.at_platform, X_MT);
  return difference(inverse(deflected_part(*mechanism.fixture, F, X_MT.p)) * X_MT, X_MT);
}

}  // namespace

TipUncertainty::TipUncertainty(const Machine& machine, const Model& model, const Tool* tool)
    : mechanism_(model.mechanism),
      uncertainty_(*machine.uncertainty),
      known_(uncertain_parameters(machine)),
      tangents_(machine, model, parameter_indices(machine, known_.names), true, tool) {
  if (uncertainty_.temperature == 0) return;
  const ThermalTable& table = *machine.thermal;
  constexpr double step = 1e-3;  // K: shift and growth are linear between the temperatures of the table
  const double low = std::max(*machine.temperature - step, table.temperatures.front()),
               high = std::min(*machine.temperature + step, table.temperatures.back());
  const ThermalShift from = thermal_shift(table, low), to = thermal_shift(table, high);
  shift_ = (to.shift - from.shift) / (high - low);
  growth_ = (to.growth - from.growth) / (high - low);
}

TipCovariance TipUncertainty::of_tip(const Configuration& configuration, const Load& load, StaticsWork& work,
                                     const DatumTangents& datum) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic> J = tangents_.of_tip(configuration, load, work);
  const Pose X_MT = tip(mechanism_, configuration);
  const Eigen::Index n = known_.covariance.rows();
  Vector6 by_force = J.col(n);
  if (mechanism_.fixture) by_force += part_twist(mechanism_, load, X_MT);
  if (datum.by_parameter.cols() > 0) J.topLeftCorner(3, n) -= datum.by_parameter;
  TipCovariance result;
  if (n > 0) result.parameters = J.leftCols(n) * known_.covariance * J.leftCols(n).transpose();
  result.force = uncertainty_.force * uncertainty_.force * by_force * by_force.transpose();
  const auto squared = [](double x) { return x * x; };
  const Vector3 axis = X_MT.R.col(2), by_temperature = shift_ - growth_ * axis;
  result.others.topLeftCorner<3, 3>() =
      squared(uncertainty_.repeatability) * Matrix3((Vector3::Ones() + datum.axes).asDiagonal()) +
      squared(uncertainty_.tool_length) * axis * axis.transpose() +
      squared(uncertainty_.temperature) * by_temperature * by_temperature.transpose();
  return result;
}

DatumTangents TipUncertainty::of_datum(const Configuration& configuration, const Vector3& axes,
                                       StaticsWork& work) const {
  DatumTangents datum{.axes = axes};
  const Eigen::Index n = known_.covariance.rows();
  if (n > 0)
    datum.by_parameter =
        axes.asDiagonal() * tangents_.of_tip(configuration, Load{}, work).topLeftCorner(3, n);
  return datum;
}

double band(const Vector3& d, const Matrix3& C) {
  const Vector3 u = band_direction(d, C);
  return 2 * std::sqrt(std::max(u.dot(C * u), 0.0));
}

Vector3 band_direction(const Vector3& d, const Matrix3& C) {
  const double size = d.norm();
  // A smaller deviation is the rounding error of solutions.
  if (size > step_tolerance && size * size > 2 * std::sqrt(std::max(d.dot(C * d), 0.0))) return d / size;
  return Eigen::SelfAdjointEigenSolver<Matrix3>(C).eigenvectors().col(2);
}

}  // namespace counterflex
