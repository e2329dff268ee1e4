#pragma once
/// Actuator values as the control shows them: signs, zeros and couplings of axes differ from those of the
/// joints in the machine's chains. Travel is in shown values.
#include <Eigen/Core>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// s = A q + b. Empty if the control shows the joint values.
struct ShownActuators {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;

  bool differ() const { return b.size() > 0; }
};

ShownActuators shown_actuators(const Machine& machine);

/// The shown values of joint values `q` (m, rad).
Eigen::VectorXd shown_values(const ShownActuators& shown, const Eigen::VectorXd& q);

/// One of them. Does not allocate. `q` has a value for each actuator.
double shown_value(const ShownActuators& shown, Eigen::Index actuator, const double* q);

/// The home values of all actuators: of the joints, and as shown.
Eigen::VectorXd home_values(const Machine& machine);
Eigen::VectorXd shown_homes(const Machine& machine);

/// The joint values of shown values `s`: the inverse of `shown_values`.
Eigen::VectorXd joint_values(const ShownActuators& shown, const Eigen::VectorXd& s);

}  // namespace counterflex
