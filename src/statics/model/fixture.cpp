#include "counterflex/statics/fixture.hpp"

namespace counterflex {

Pose deflected_part(const Fixture& fixture, const Vector6& F, const Vector3& p_MC) {
  const Matrix3& R = fixture.X_MF.R;
  const Vector3 f = -F.head<3>(), arm = p_MC - fixture.X_MF.p;
  Vector6 at_spring;  // axes of F
  at_spring << R.transpose() * f, R.transpose() * (-F.tail<3>() + arm.cross(f));
  const Vector6 theta = fixture.C * at_spring;
  const Pose moved{exp_so3(theta.tail<3>()), theta.head<3>()};
  return fixture.X_MF * moved * inverse(fixture.X_MF);
}

Vector6 wrench_at_tip(const Mechanism& mechanism, const Vector6& F, bool at_platform, const Pose& X_MT) {
  Vector6 at_tip = F;
  if (!at_platform) return at_tip;
  const Vector3 arm = X_MT.R * (inverse(mechanism.X_PT) * mechanism.p_EP);
  at_tip.tail<3>() += arm.cross(Vector3(F.head<3>()));
  return at_tip;
}

}  // namespace counterflex
