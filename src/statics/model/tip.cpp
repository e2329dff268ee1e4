#include "statics/model/tip.hpp"

#include <Eigen/Geometry>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {

std::vector<int> fixed_components(const Mechanism& mechanism) {
  if (mechanism.controlled.empty()) return {0, 1, 2, 3, 4, 5};
  std::vector<int> list;
  for (const Component c : mechanism.controlled) list.push_back(static_cast<int>(c));
  return list;
}

Vector6 fixed_part(const Mechanism& mechanism, const Vector6& deviation) {
  Vector6 part = Vector6::Zero();
  for (const int c : fixed_components(mechanism)) part[c] = deviation[c];
  return part;
}

Matrix6 tip_from_platform(const Mechanism& mechanism, const Pose& X_MP) {
  Matrix6 T = Matrix6::Identity();
  T.topRightCorner<3, 3>() = -skew(X_MP.R * mechanism.X_PT.p);
  return T;
}

Controlled tip_equations(const Mechanism& mechanism, const Pose& X_MP, const Pose& X_MT, const Units& units) {
  const Vector6 error = difference(X_MP * mechanism.X_PT, X_MT), pose = units.of_pose();
  // p_T = p_P + r:  dp_T = v - [r]x w;   Log(Exp(w) R_actual R_target') = phi + J_l(phi)^-1 w
  Matrix6 all = tip_from_platform(mechanism, X_MP);
  all.bottomRightCorner<3, 3>() = left_jacobian_inverse(error.tail<3>());
  const std::vector<int> fixed = fixed_components(mechanism);
  Controlled tip;
  tip.rows = pose.cwiseInverse()(fixed).asDiagonal() * all(fixed, Eigen::all) * pose.asDiagonal();
  tip.rhs = -error(fixed).cwiseQuotient(pose(fixed));
  return tip;
}

Pose tip(const Mechanism& mechanism, const Configuration& configuration) {
  return configuration.X_MP * mechanism.X_PT;
}

Vector6 deviation(const Pose& actual, const Pose& wanted) {
  return difference(actual, wanted);
}

}  // namespace counterflex
