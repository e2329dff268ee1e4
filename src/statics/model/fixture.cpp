#include "counterflex/statics/fixture.hpp"

namespace counterflex {

Pose deflected_part(const Fixture& fixture, const Vector6& F, const Vector3& p_MC) {
  const Matrix3& R = fixture.X_MF.R;
  const Vector6 at_part = wrench_at(-F, p_MC - fixture.X_MF.p);
  Vector6 at_spring;  // axes of F
  at_spring << R.transpose() * at_part.head<3>(), R.transpose() * at_part.tail<3>();
  const Vector6 theta = fixture.C * at_spring;
  const Pose moved{exp_so3(theta.tail<3>()), theta.head<3>()};
  return fixture.X_MF * moved * inverse(fixture.X_MF);
}

Vector6 wrench_at_tip(const Mechanism& mechanism, const Vector6& F, bool at_platform, const Pose& X_MT) {
  if (!at_platform) return F;
  return wrench_at(F, X_MT.R * (inverse(mechanism.X_PT) * mechanism.p_EP));
}

}  // namespace counterflex
