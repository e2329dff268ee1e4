#include <Eigen/Geometry>

#include "statics/model/tip.hpp"

namespace counterflex {

namespace {

int count_fixed(const Mechanism& mechanism) {
  return mechanism.controlled.empty() ? 6 : static_cast<int>(mechanism.controlled.size());
}

int fixed_component(const Mechanism& mechanism, int i) {
  return mechanism.controlled.empty() ? i : static_cast<int>(mechanism.controlled[static_cast<std::size_t>(i)]);
}

}  // namespace

std::vector<int> fixed_components(const Mechanism& mechanism) {
  std::vector<int> list;
  for (int i = 0; i < count_fixed(mechanism); ++i) list.push_back(fixed_component(mechanism, i));
  return list;
}

TipEquations tip_equations(const Mechanism& mechanism, const Pose& X_MP, const Pose& X_MT) {
  const Vector6 error = difference(X_MP * mechanism.X_PT, X_MT);
  // p_T = p_P + r:  dp_T = v - [r]x w;   Log(Exp(w) R_actual R_target') = phi + J_l(phi)^-1 w
  Matrix6 all = Matrix6::Identity();
  all.topRightCorner<3, 3>() = -skew(X_MP.R * mechanism.X_PT.p);
  all.bottomRightCorner<3, 3>() = left_jacobian_inverse(error.tail<3>());
  const int count = count_fixed(mechanism);
  TipEquations tip{ControlledRows(count, 6), ControlledValues(count)};
  for (int i = 0; i < count; ++i) {
    tip.rows.row(i) = all.row(fixed_component(mechanism, i));
    tip.error[i] = error[fixed_component(mechanism, i)];
  }
  return tip;
}

Controlled to_controlled(const TipEquations& tip, const Mechanism& mechanism, const Units& units) {
  const Vector6 pose = units.of_pose();
  Controlled controlled{tip.rows, -tip.error};
  for (int i = 0; i < count_fixed(mechanism); ++i) {
    const double unit = pose[fixed_component(mechanism, i)];
    controlled.rows.row(i) = ((1 / unit) * tip.rows.row(i)).cwiseProduct(pose.transpose());
    controlled.rhs[i] /= unit;
  }
  return controlled;
}

Vector6 deviation(const Pose& actual, const Pose& wanted) { return difference(actual, wanted); }

}  // namespace counterflex
