#include <Eigen/Geometry>

#include "tip.hpp"

namespace counterflex {

std::vector<int> fixed_components(const Mechanism& mechanism) {
  std::vector<int> list;
  for (Component c : mechanism.controlled) list.push_back(static_cast<int>(c));
  if (list.empty()) list = {0, 1, 2, 3, 4, 5};
  return list;
}

TipEquations tip_equations(const Mechanism& mechanism, const Pose& X_MP, const Pose& X_MT) {
  const Vector6 error = difference(X_MP * mechanism.X_PT, X_MT);
  // p_T = p_P + r:  dp_T = v - [r]x w;   Log(Exp(w) R_actual R_target') = phi + J_l(phi)^-1 w
  Matrix6 all = Matrix6::Identity();
  all.topRightCorner<3, 3>() = -skew(X_MP.R * mechanism.X_PT.p);
  all.bottomRightCorner<3, 3>() = left_jacobian_inverse(error.tail<3>());
  const auto components = fixed_components(mechanism);
  return {all(components, Eigen::all), error(components)};
}

Controlled to_controlled(const TipEquations& tip, const Mechanism& mechanism, const Units& units) {
  const auto components = fixed_components(mechanism);
  const Eigen::VectorXd row_units = units.of_pose()(components);
  return {row_units.cwiseInverse().asDiagonal() * tip.rows * units.of_pose().asDiagonal(),
          -tip.error.cwiseQuotient(row_units)};
}

Vector6 deviation(const Pose& actual, const Pose& wanted) { return difference(actual, wanted); }

}  // namespace counterflex
