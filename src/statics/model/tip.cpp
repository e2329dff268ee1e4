#include "statics/model/tip.hpp"

#include <Eigen/Geometry>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {
namespace {

int count_fixed(const Mechanism& mechanism) {
  return mechanism.controlled.empty() ? 6 : static_cast<int>(mechanism.controlled.size());
}

int fixed_component(const Mechanism& mechanism, int i) {
  return mechanism.controlled.empty() ? i
                                      : static_cast<int>(mechanism.controlled[static_cast<std::size_t>(i)]);
}

}  // namespace

std::vector<int> fixed_components(const Mechanism& mechanism) {
  std::vector<int> list;
  for (int i = 0; i < count_fixed(mechanism); ++i) list.push_back(fixed_component(mechanism, i));
  return list;
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
  const int count = count_fixed(mechanism);
  Controlled tip{decltype(Controlled::rows)(count, 6), decltype(Controlled::rhs)(count)};
  for (int i = 0; i < count; ++i) {
    const int c = fixed_component(mechanism, i);
    tip.rows.row(i) = ((1 / pose[c]) * all.row(c)).cwiseProduct(pose.transpose());
    tip.rhs[i] = -error[c] / pose[c];
  }
  return tip;
}

Pose tip(const Mechanism& mechanism, const Configuration& configuration) {
  return configuration.X_MP * mechanism.X_PT;
}

Vector6 deviation(const Pose& actual, const Pose& wanted) {
  return difference(actual, wanted);
}

}  // namespace counterflex
